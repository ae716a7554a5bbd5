#include <octafront/error.h>
#include <octafront/image.h>
#include <octafront/image_surface.h>
#include <octafront/io.h>

#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "doors/intake/cell.h"
#include "doors/intake/intake.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace octafront::intake {

namespace {

VoxelBox box_of(const std::array<VoxelRange, 3>& crop, const ImageGrid& grid) {
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = crop[axis].first.value_or(0);
    box.hi[axis] = crop[axis].last ? *crop[axis].last + 1 : grid.size[axis];
  }
  return box;
}

bool crops(const ImageIntake& asked) {
  return std::ranges::any_of(asked.crop, [](const VoxelRange& r) { return r.first || r.last; });
}

Vec3 spacing_of(const std::vector<double>& resample) {
  if (resample.size() == 1) return Vec3{1, 1, 1} * resample[0];
  if (resample.size() == 3) return {resample[0], resample[1], resample[2]};
  throw OptionError(fmt::format("`resample` has {} sizes: give one, or three along i, j and k", resample.size()));
}

/// Cropped and resampled as asked; nullopt if neither was.
std::optional<Image> taken(Domain& domain, const IntakeOptions& options, const Image& image,
                           const ImageRegions& regions, const RunContext& context) {
  const ImageIntake& asked = options.image;
  std::optional<Image> part;
  if (crops(asked)) part = cropped(image, box_of(asked.crop, image.grid));
  if (!asked.resample.empty()) {
    const Image& from = part ? *part : image;
    const bool labels = kind_of(from, regions) == ImageRegions::Kind::kLabels;
    Image made = resampled(from, spacing_of(asked.resample), labels, context);
    made.notes.erase(made.notes.begin(), made.notes.begin() + static_cast<std::ptrdiff_t>(from.notes.size()));
    note_all(domain, options, "resampling", made.notes);
    part = std::move(made);
  } else if (std::optional<Image> coarser = coarsened_for_budget(part ? *part : image, asked, regions, context)) {
    note_all(domain, options, "resampling", {coarser->notes.back()});
    part = std::move(coarser);
  }
  if (part) note(domain, options, "", fmt::format("  taken: {}", in_words(part->grid)));
  return part;
}

ImageRegions regions_of(const ImageIntake& asked, const RunContext& context) {
  ImageRegions regions = asked.regions;
  if (asked.names_file.empty()) return regions;
  std::vector<LabelName>& names = regions.labels.names;
  std::vector<LabelName> all = read_label_names(asked.names_file, context);
  all.insert(all.end(), names.begin(), names.end());
  names = std::move(all);
  return regions;
}

/// Adds the surfaces of labels that are in files.
void read_surfaces(Domain& domain, const IntakeOptions& options, ImageRegions& regions, const RunContext& context) {
  for (const FileOfLabel& of : options.image.surface_files) {
    SurfaceFile read = read_surface(of.file, context);
    const std::string triangles = counted(read.surface.triangles.size(), "triangle");
    note(domain, options, "", fmt::format("{}: {}, {}, of \"{}\"", of.file, read.format, triangles, of.label));
    note_all(domain, options, "reading", read.notes);
    regions.surfaces.push_back({of.label, std::move(read.surface), of.file});
  }
}

/// The first and the last face of the box of voxels along an axis, in index space.
std::array<double, 2> ends_of_box(const ImageGrid& grid, int axis) {
  const std::uint32_t n = grid.size[static_cast<std::size_t>(axis)];
  const auto middle = [&](std::uint32_t i) { return axis == 2 ? grid.slice(i) : i; };
  const double first = n > 1 ? middle(1) - middle(0) : 1, last = n > 1 ? middle(n - 1) - middle(n - 2) : 1;
  return {middle(0) - first / 2, middle(n - 1) + last / 2};
}

/// Where a region was cut flat by the edge of the image is a patch of its own: box_i0 and box_i1 at the ends of i, ...
void name_faces_of_box(SurfaceMesh& surface, const ImageGrid& grid) {
  constexpr double kRounding = 1e-6;  // of a voxel: vertices of these faces lie in them but for rounding
  constexpr std::array kNames{"box_i0", "box_i1", "box_j0", "box_j1", "box_k0", "box_k1"};
  std::vector<std::uint8_t> on(surface.points.size(), 0);  // a bit for each face of the box
  for (int axis = 0; axis < 3; ++axis) {
    const std::array<double, 2> ends = ends_of_box(grid, axis);
    for (std::size_t v = 0; v < on.size(); ++v)
      for (int end = 0; end < 2; ++end)
        if (std::abs(grid.to_index(surface.points[v])[axis] - ends[static_cast<std::size_t>(end)]) < kRounding)
          on[v] |= static_cast<std::uint8_t>(1 << (2 * axis + end));
  }
  std::vector<std::uint32_t> patch(surface.triangles.size(), 0);
  std::array<std::uint32_t, 6> number{};
  std::vector<std::string> names{surface.region_names.size() == 1 ? surface.region_names[0] : ""};
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const unsigned shared = on[a] & on[b] & on[c];
    if (shared == 0 || surface.sides[t][0] != kNone) continue;
    const auto face = static_cast<std::size_t>(std::countr_zero(shared));
    if (number[face] == 0) {
      number[face] = static_cast<std::uint32_t>(names.size());
      names.emplace_back(kNames[face]);
    }
    patch[t] = number[face];
  }
  if (names.size() == 1) return;
  surface.patch = std::move(patch);
  surface.patch_names = std::move(names);
}

/// Said to be labels, and not whole: programs that resample or average leave such.
std::optional<Image> with_whole_labels(const Image& image) {
  const auto* values = std::get_if<std::vector<float>>(&image.values);
  if (values == nullptr) return std::nullopt;
  Image made{image.grid, *values, {}, image.format, image.unit, image.frame, image.names};
  std::size_t changed = 0;
  for (float& v : std::get<std::vector<float>>(made.values)) {
    const float whole = std::round(v);
    changed += v != whole;
    v = whole;
  }
  if (changed == 0) return std::nullopt;
  made.notes.push_back(fmt::format("labels are whole numbers: {} rounded", counted(changed, "voxel is", "voxels are")));
  return made;
}

/// `repeats`: what is changed at one face of a cell would have to change at the opposite one.
double area_of_contacts(const IntakeOptions& options, bool repeats) {
  const std::string asked = contacts_asked(options).of_labels;
  if (asked == "keep" || (repeats && asked.empty())) return 0;
  if (repeats) throw OptionError("`contacts` are not cleared in an image that is repeated: give keep, or leave it out");
  if (!asked.empty()) return *area_in(asked);
  const double size = options.image.size.value_or(0);
  return size * size;
}

/// `repeats`: as for contacts.
double volume_of_specks(const ImageIntake& asked, bool repeats) {
  if (repeats) return 0;
  if (asked.specks) return *asked.specks;
  const double size = asked.size.value_or(0);
  return kRegularTet * size * size * size;
}

void check_cleaning(const ImageIntake& asked) {
  const CleanOptions& clean = asked.regions.clean;
  for (const auto& [option, volume] : {std::pair{"islands", clean.islands}, std::pair{"holes", clean.holes},
                                       std::pair{"specks", asked.specks.value_or(clean.specks)}})
    if (!(volume >= 0)) throw OptionError(fmt::format("`{}` is {}: it must not be below 0", option, volume));
  constexpr std::uint32_t kMost = 64;
  if (clean.closing > kMost)
    throw OptionError(fmt::format("`close_voxels` is {}: it is from 0 to {}", clean.closing, kMost));
}

}  // namespace

void refuse_image_options(const IntakeOptions& options, const std::string& name) {
  const ImageIntake& image = options.image;
  const LabelOptions& labels = image.regions.labels;
  const CleanOptions& clean = image.regions.clean;
  const bool has_surfaces = !image.surface_files.empty() || !image.regions.surfaces.empty();
  const std::pair<bool, const char*> given[] = {{image.choice.series > 0, "series"},
                                                {image.regions.kind != ImageRegions::Kind::kAuto, "image"},
                                                {!image.regions.bands.empty(), "band"},
                                                {!image.names_file.empty() || !labels.names.empty(), "labels"},
                                                {labels.ignore.has_value(), "ignore"},
                                                {!labels.merge.empty(), "merge"},
                                                {!image.regions.electrodes.empty(), "electrode"},
                                                {has_surfaces, "surface_of"},
                                                {clean.islands > 0, "islands"},
                                                {clean.holes > 0, "holes"},
                                                {image.specks || clean.specks > 0, "specks"},
                                                {clean.closing > 0, "close_voxels"},
                                                {!contacts_asked(options).of_labels.empty(), "contacts"},
                                                {!image.regions.closed_at_box, "closed_at_box"},
                                                {crops(image), "crop"},
                                                {!image.resample.empty(), "resample"}};
  for (const auto& [is_given, option] : given)
    if (is_given) throw OptionError(fmt::format("`{}` is for images, and {} is none that is known here", option, name));
}

void take_image(Domain& domain, const IntakeOptions& options, const Image& image, const std::string& name,
                const RunContext& context) {
  check_cleaning(options.image);
  note_all(domain, options, "reading", image.notes);
  ImageRegions regions = regions_of(options.image, context);
  read_surfaces(domain, options, regions, context);
  const std::optional<Image> whole =
      regions.kind == ImageRegions::Kind::kLabels ? with_whole_labels(image) : std::nullopt;
  if (whole) note_all(domain, options, "reading", whole->notes);
  const Image& given = whole ? *whole : image;
  const std::optional<Image> part = taken(domain, options, given, regions, context);
  const Image& used = part ? *part : given;
  const std::array<bool, 3> repeated = axes_named("repeat", options.repeat.value_or(""));
  const bool repeats = std::ranges::any_of(repeated, [](bool along) { return along; });
  if (regions.clean.specks == 0) regions.clean.specks = volume_of_specks(options.image, repeats);
  if (regions.clean.contacts == 0) regions.clean.contacts = area_of_contacts(options, repeats);
  domain.format = image.format;
  domain.frame = image.frame;
  domain.voxel_spacing = smallest_spacing(used.grid);
  domain.voxels = used.grid.size;
  try {
    take_complex(domain, options,
                 repeats ? complex_of_periodic_image(used, regions, repeated, context)
                         : complex_of_image(used, regions, context));
    if (repeats) return;
    name_faces_of_box(domain.surface, used.grid);
    domain.found_clean = fingerprint(domain.surface);
  } catch (const InputError& error) {
    throw InputError(name.empty() ? error.what() : fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace octafront::intake
