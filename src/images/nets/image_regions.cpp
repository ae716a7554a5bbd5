#include <octafront/error.h>
#include <octafront/image_surface.h>

#include "base/core/utf8.h"
#include "images/nets/given_surfaces.h"
#include "images/nets/net_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace octafront {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float below(double limit) {
  return std::nextafter(static_cast<float>(limit), -kInfinity);
}

float at_least(double limit) {
  const auto v = static_cast<float>(limit);
  return static_cast<double>(v) < limit ? std::nextafter(v, kInfinity) : v;
}

bool is_in(const GreyBand& band, float v) {
  return band.lo <= static_cast<double>(v) && static_cast<double>(v) < band.hi;
}

float into(const GreyBand& band, float v) {
  return static_cast<double>(v) < band.lo ? at_least(band.lo) : below(band.hi);
}

/// The value nearest to `v` that is in no band.
float out_of(const std::vector<GreyBand>& bands, float v) {
  float best = v;
  double nearest = std::numeric_limits<double>::infinity();
  const auto consider = [&](double limit, float value) {
    const bool is_free = std::none_of(bands.begin(), bands.end(), [&](const GreyBand& b) { return is_in(b, value); });
    const double away = std::abs(limit - static_cast<double>(v));
    if (!is_free || !std::isfinite(limit) || away >= nearest) return;
    nearest = away;
    best = value;
  };
  for (const GreyBand& b : bands) {
    consider(b.lo, below(b.lo));
    consider(b.hi, at_least(b.hi));
  }
  return best;
}

/// The image with bands cleaned as labels are, and values that say the same, so that its surface still lies between
/// voxels: those that changed lie in their new band, as near to their old value as that allows. Its notes are those of
/// cleaning.
Image cleaned_bands(const Image& image, const std::vector<GreyBand>& bands, const CleanOptions& clean,
                    const RunContext& context) {
  const LabelImage before = labels_of_bands(image, bands);
  LabelImage after = cleaned(before, clean, context);
  std::vector<float> values =
      std::visit([](const auto& all) { return std::vector<float>(all.begin(), all.end()); }, image.values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (before.regions[i] == after.regions[i]) continue;
    const bool leaves = after.regions[i] == LabelImage::kNoRegion;
    values[i] = leaves ? out_of(bands, values[i])
                       : into(bands[static_cast<std::size_t>(after.labels[after.regions[i]].value)], values[i]);
  }
  return {image.grid, std::move(values), std::move(after.notes), image.format, image.unit, image.frame, {}};
}

using RegionKind = ImageRegions::Kind;

bool speaks_of_labels(const LabelOptions& labels) {
  return !labels.names.empty() || labels.ignore || !labels.merge.empty();
}

void check_options_of(RegionKind kind, const ImageRegions& regions) {
  if (kind == RegionKind::kGrey && speaks_of_labels(regions.labels))
    throw OptionError(
        "`labels`, `ignore` and `merge` are for images of labels, `iso` and `band` for grey ones; give one kind");
  if (kind == RegionKind::kGrey && !regions.electrodes.empty())
    throw OptionError("`electrode` is for images of labels, and this one is taken as grey");
  if (kind == RegionKind::kGrey && !regions.surfaces.empty())
    throw OptionError("`surface_of` is for images of labels, and this one is taken as grey");
  if (kind == RegionKind::kLabels && !regions.bands.empty())
    throw OptionError(
        "`iso` and `band` are for grey images, and this one is taken as labels; say that it is a grey image, or leave "
        "them out");
}

std::vector<GreyBand> named(std::vector<GreyBand> bands, std::vector<std::string>& notes) {
  NameCleaning names;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    if (bands[b].name.empty()) bands[b].name = bands.size() == 1 ? "body" : fmt::format("band {}", b + 1);
    names.clean(bands[b].name);
  }
  names.tell(notes);
  return bands;
}

std::pair<double, double> value_range_of(const Image& image) {
  return std::visit(
      [](const auto& values) -> std::pair<double, double> {
        const auto [least, largest] = std::minmax_element(values.begin(), values.end());
        return {static_cast<double>(*least), static_cast<double>(*largest)};
      },
      image.values);
}

[[noreturn]] void fail_without_bands(const Image& image) {
  const auto [least, largest] = value_range_of(image);
  throw InputError(
      fmt::format("is a grey image (values {:.6g} to {:.6g}): say which values are meant, `iso` V for what is V and "
                  "more, or `band` LO:HI; or that its values are labels. octafront info shows how often they occur",
                  least, largest));
}

/// Which regions end at the edge of the image, as a note; or refuses them.
std::vector<std::string> ends_at_edge(const LabelImage& labels, bool closed_at_box) {
  const std::vector<std::uint8_t> reached = faces_reached(labels);
  constexpr std::array kFaces{"first i", "last i", "first j", "last j", "first k", "last k"};
  std::string words;
  std::size_t count = 0;
  constexpr std::size_t kMostNamed = 5;
  for (std::size_t r = 0; r < reached.size(); ++r) {
    if (reached[r] == 0 || ++count > kMostNamed) continue;
    std::string faces;
    for (std::size_t f = 0; f < kFaces.size(); ++f)
      if ((reached[r] >> f & 1) != 0) faces += (faces.empty() ? "" : ", ") + std::string(kFaces[f]);
    words += fmt::format("{}\"{}\" ({})", words.empty() ? "" : ", ", labels.labels[r].name, faces);
  }
  if (count == 0) return {};
  if (count > kMostNamed) words += fmt::format(" and {} more", count - kMostNamed);
  if (!closed_at_box)
    throw InputError(
        fmt::format("regions reach the edge of the image: {}; with `closed_at_box` they end flat there, with `ignore` "
                    "or `crop` they can be left out",
                    words));
  return {fmt::format("closed flat at the edge of the image: {}", words)};
}

/// Whether the image ends nowhere.
bool goes_on(const PeriodicMargin& margin) {
  return margin[0] > 0 && margin[1] > 0 && margin[2] > 0;
}

void add(std::vector<std::string>& all, std::vector<std::string> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

Complex with_notes(Complex complex, std::vector<std::string> notes) {
  add(notes, std::move(complex.notes));
  complex.notes = std::move(notes);
  return complex;
}

Complex complex_of_grey(const Image& image, const ImageRegions& regions, const RunContext& context) {
  if (regions.bands.empty()) fail_without_bands(image);
  std::vector<std::string> notes;
  const std::vector<GreyBand> bands = named(regions.bands, notes);
  Image cleaned;
  if (regions.clean.any()) cleaned = cleaned_bands(image, bands, regions.clean, context);
  const Image& used = regions.clean.any() ? cleaned : image;
  add(notes, cleaned.notes);
  if (!goes_on(regions.margin)) add(notes, ends_at_edge(labels_of_bands(used, bands), regions.closed_at_box));
  context.report("surfaces", -1);
  return with_notes(complex_of_bands(used, bands, regions.margin, context), std::move(notes));
}

std::vector<nets::GivenSurface> given_surfaces_of(const LabelImage& labels, const ImageRegions& regions) {
  if (regions.surfaces.empty()) return {};
  if (regions.margin != PeriodicMargin{})
    throw OptionError("`surface_of` is for images that end, and this one is taken as periodic");
  return nets::given_surfaces(labels, regions.surfaces);
}

Complex complex_of_segmentation(const Image& image, const ImageRegions& regions, const RunContext& context) {
  LabelImage labels = labels_of(image, regions.labels);
  std::vector<std::string> notes = std::exchange(labels.notes, {});
  if (regions.clean.any()) {
    labels = cleaned(labels, regions.clean, context);
    add(notes, labels.notes);
  }
  labels.notes.clear();
  std::vector<nets::GivenSurface> surfaces = given_surfaces_of(labels, regions);
  nets::follow_surfaces(labels, surfaces, context);
  add(notes, labels.notes);
  if (!regions.electrodes.empty()) {
    labels.notes.clear();
    labels = with_electrodes(std::move(labels), regions.electrodes);
    add(notes, labels.notes);
  }
  if (!goes_on(regions.margin)) add(notes, ends_at_edge(labels, regions.closed_at_box));
  context.report("surfaces", -1);
  return with_notes(nets::complex_on_surfaces(labels, {.margin = regions.margin}, surfaces, context), std::move(notes));
}

}  // namespace

RegionKind kind_of(const Image& image, const ImageRegions& regions) {
  if (regions.kind != RegionKind::kAuto) return regions.kind;
  if (!regions.bands.empty()) return RegionKind::kGrey;
  return speaks_of_labels(regions.labels) || !regions.surfaces.empty() || looks_like_labels(image) ? RegionKind::kLabels
                                                                                                   : RegionKind::kGrey;
}

Complex complex_of_image(const Image& image, const ImageRegions& regions, const RunContext& context) {
  const RegionKind kind = kind_of(image, regions);
  check_options_of(kind, regions);
  return kind == RegionKind::kGrey ? complex_of_grey(image, regions, context)
                                   : complex_of_segmentation(image, regions, context);
}

double smallest_spacing(const ImageGrid& grid) {
  return std::min({length(grid.axes[0]), length(grid.axes[1]), length(grid.axes[2])});
}

}  // namespace octafront
