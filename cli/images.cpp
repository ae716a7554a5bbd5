#include "images.h"

#include <octafront/error.h>
#include <octafront/image_surface.h>

#include "domain.h"
#include "text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

using Kind = ImageArguments::Kind;

std::string grid_in_words(const ImageGrid& grid) {
  return fmt::format("{} x {} x {} voxels of {:.6g} x {:.6g} x {:.6g}", grid.size[0], grid.size[1], grid.size[2],
                     length(grid.axes[0]), length(grid.axes[1]), length(grid.axes[2]));
}

VoxelBox box_of(const std::array<VoxelRange, 3>& crop, const ImageGrid& grid) {
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = crop[axis].first.value_or(0);
    box.hi[axis] = crop[axis].second ? *crop[axis].second + 1 : grid.size[axis];
  }
  return box;
}

/// The chosen kind, or the one that the options or the values speak for.
Kind kind_of(const ImageArguments& a, const Image& image) {
  if (a.kind != Kind::kAuto) return a.kind;
  if (!a.bands.empty()) return Kind::kGrey;
  if (!a.names.empty() || a.labels.ignore || !a.labels.merge.empty()) return Kind::kLabels;
  return looks_like_labels(image) ? Kind::kLabels : Kind::kGrey;
}

void check_options_of(Kind kind, const ImageArguments& a) {
  const bool of_labels = !a.names.empty() || a.labels.ignore || !a.labels.merge.empty();
  if (kind == Kind::kGrey && of_labels)
    throw OptionError(
        "--labels, --ignore and --merge are for images of labels, --iso and --band for grey ones; give one kind");
  if (kind == Kind::kLabels && !a.bands.empty())
    throw OptionError(
        "--iso and --band are for grey images, and this one is taken as labels; give --image grey, or leave them out");
}

/// "body" alone, "band 1" and so on of several without a name.
std::vector<GreyBand> named(std::vector<GreyBand> bands) {
  for (std::size_t b = 0; b < bands.size(); ++b)
    if (bands[b].name.empty()) bands[b].name = bands.size() == 1 ? "body" : fmt::format("band {}", b + 1);
  return bands;
}

template <class T>
std::pair<double, double> range_of(const std::vector<T>& values) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return {static_cast<double>(*least), static_cast<double>(*largest)};
}

std::pair<double, double> range_of(const Image& image) {
  return std::visit([](const auto& values) { return range_of(values); }, image.values);
}

[[noreturn]] void fail_without_bands(const Image& image) {
  const auto [least, largest] = range_of(image);
  throw InputError(fmt::format(
      "is a grey image (values {:.6g} to {:.6g}): say which values are meant, --iso V for what is V and more, or "
      "--band LO:HI; if its values are labels, --image labels. octafront info shows how often they occur",
      least, largest));
}

/// The labels of bands, cleaned; and the image with values that say the same, so that its surface still lies between
/// voxels: those that changed lie in their new band, as near to their old value as that allows.
Image cleaned_bands(const Image& image, const std::vector<GreyBand>& bands, const CleanOptions& clean,
                    Session& session) {
  const LabelImage before = labels_of_bands(image, bands);
  const LabelImage after = cleaned(before, clean, session.context());
  session.say_notes("cleaning", after.notes);
  std::vector<float> values =
      std::visit([](const auto& all) { return std::vector<float>(all.begin(), all.end()); }, image.values);
  const auto below = [](double limit) {
    return std::nextafter(static_cast<float>(limit), -std::numeric_limits<float>::infinity());
  };
  const auto at_least = [](double limit) {
    const auto v = static_cast<float>(limit);
    return static_cast<double>(v) < limit ? std::nextafter(v, std::numeric_limits<float>::infinity()) : v;
  };
  const auto outside = [&](float v) {
    // The nearest end of a band that no other band continues.
    float best = v;
    double nearest = std::numeric_limits<double>::infinity();
    const auto consider = [&](double limit, float value) {
      const bool is_free =
          std::none_of(bands.begin(), bands.end(), [&](const GreyBand& b) { return b.lo <= value && value < b.hi; });
      if (!is_free || !std::isfinite(limit) || std::abs(limit - v) >= nearest) return;
      nearest = std::abs(limit - v);
      best = value;
    };
    for (const GreyBand& b : bands) {
      consider(b.lo, below(b.lo));
      consider(b.hi, at_least(b.hi));
    }
    return best;
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (before.regions[i] == after.regions[i]) continue;
    if (after.regions[i] == LabelImage::kNoRegion) {
      values[i] = outside(values[i]);
    } else {
      const GreyBand& b = bands[static_cast<std::size_t>(after.labels[after.regions[i]].value)];
      values[i] = static_cast<double>(values[i]) < b.lo ? at_least(b.lo) : below(b.hi);
    }
  }
  Image out{image.grid, std::move(values), {}, image.format, image.unit, image.frame, {}};
  return out;
}

/// Says which regions end at the edge of the image, or refuses them.
void tell_edge(const Session& session, const LabelImage& labels) {
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
  if (count == 0) return;
  if (count > kMostNamed) words += fmt::format(" and {} more", count - kMostNamed);
  if (!session.arguments().image.closed_at_box)
    throw InputError(
        fmt::format("regions reach the edge of the image: {}; without --closed-at-box=no they end flat there, "
                    "with --ignore or --crop they can be left out",
                    words));
  session.say_notes("regions", {fmt::format("closed flat at the edge of the image: {}", words)});
}

Complex complex_of_grey(Session& session, const Image& image) {
  const ImageArguments& a = session.arguments().image;
  if (a.bands.empty()) fail_without_bands(image);
  const std::vector<GreyBand> bands = named(a.bands);
  const Image cleaned = a.clean.any() ? cleaned_bands(image, bands, a.clean, session) : Image{};
  const Image& used = a.clean.any() ? cleaned : image;
  tell_edge(session, labels_of_bands(used, bands));
  session.context().report("surfaces", -1);
  return complex_of_bands(used, bands, session.context());
}

Complex complex_of_segmentation(Session& session, const Image& image) {
  const ImageArguments& a = session.arguments().image;
  LabelOptions options = a.labels;
  if (!a.names.empty()) options.names = read_label_names(a.names, session.context());
  LabelImage labels = labels_of(image, options);
  session.say_notes("labels", labels.notes);
  if (a.clean.any()) {
    labels.notes.clear();
    labels = cleaned(labels, a.clean, session.context());
    session.say_notes("cleaning", labels.notes);
  }
  tell_edge(session, labels);
  session.context().report("surfaces", -1);
  return complex_of_labels(labels, {}, session.context());
}

}  // namespace

bool is_image_input(const Arguments& a) {
  if (!a.input.empty() && is_image(a.input)) return true;
  if (!a.image.given.empty())
    throw OptionError(
        fmt::format("{} is for images, and {} is none that is known here", a.image.given.front(), a.input.string()));
  return false;
}

Image read_image_input(Session& session) {
  const Arguments& a = session.arguments();
  const std::vector<std::string> files(a.bodies.begin(), a.bodies.end());
  Image image = read_image(files, a.image.choice, session.context());
  session.say(fmt::format("{}: {}, {}\n", a.input.string(), image.format, grid_in_words(image.grid)));
  session.say_notes("reading", image.notes);
  image.notes.clear();
  if (a.image.crops) image = cropped(image, box_of(a.image.crop, image.grid));
  if (!a.image.spacing.empty()) {
    const std::vector<double>& s = a.image.spacing;
    const Vec3 spacing = s.size() == 1 ? Vec3{s[0], s[0], s[0]} : Vec3{s[0], s[1], s[2]};
    image = resampled(image, spacing, kind_of(a.image, image) == Kind::kLabels, session.context());
    session.say_notes("resampling", image.notes);
  }
  if (a.image.crops || !a.image.spacing.empty()) session.say(fmt::format("  taken: {}\n", grid_in_words(image.grid)));
  session.read_voxels(std::min({length(image.grid.axes[0]), length(image.grid.axes[1]), length(image.grid.axes[2])}));
  return image;
}

SizeOptions sizes_for_image(SizeOptions sizes, double voxel) {
  if (!sizes.size && !sizes.elements) return sizes;
  if (!sizes.gap) sizes.gap = 1;
  if (!sizes.min_size) sizes.min_size = std::min(voxel, sizes.size.value_or(voxel));
  return sizes;
}

SurfaceFile read_image_domain(Session& session) {
  const Arguments& a = session.arguments();
  const Image image = read_image_input(session);
  try {
    const Kind kind = kind_of(a.image, image);
    check_options_of(kind, a.image);
    Complex complex = kind == Kind::kGrey ? complex_of_grey(session, image) : complex_of_segmentation(session, image);
    tell_regions(session, complex);
    return {std::move(complex.surface), image.format, {}};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", a.input.string(), error.what()));
  }
}

}  // namespace octafront::cli
