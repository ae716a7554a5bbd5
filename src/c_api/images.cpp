// Images: from arrays and files, and their complexes.

#include <octafront/error.h>
#include <octafront/image_surface.h>

#include "c_api/c_api.h"
#include "c_api/job.h"
#include "c_api/json_keys.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront::c_api {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
Image::Values copied(const void* values, std::size_t n) {
  const auto* first = static_cast<const T*>(values);
  return std::vector<T>(first, first + n);
}

Image::Values values_of(int type, const void* values, std::size_t n) {
  switch (type) {
    case OCTAFRONT_U8:
      return copied<std::uint8_t>(values, n);
    case OCTAFRONT_I16:
      return copied<std::int16_t>(values, n);
    case OCTAFRONT_U16:
      return copied<std::uint16_t>(values, n);
    case OCTAFRONT_I32:
      return copied<std::int32_t>(values, n);
    case OCTAFRONT_F32:
      return copied<float>(values, n);
    default:
      throw OptionError(fmt::format("there is no type {} of voxels", type));
  }
}

void require_finite(const Image& image) {
  const auto* values = std::get_if<std::vector<float>>(&image.values);
  if (values == nullptr) return;
  for (std::size_t v = 0; v < values->size(); ++v)
    if (!std::isfinite((*values)[v])) {
      const auto& n = image.grid.size;
      throw InputError(fmt::format("voxel ({}, {}, {}) has the value {}, which is not finite", v % n[0],
                                   v / n[0] % n[1], v / n[0] / n[1], (*values)[v]));
    }
}

Image image_of(int type, const std::uint32_t* size, const void* values, const double* map) {
  Image image;
  image.format = "an array";
  image.grid.size = {size[0], size[1], size[2]};
  for (const std::uint32_t n : image.grid.size)
    if (n == 0) throw InputError("an image needs voxels along three axes");
  for (std::size_t axis = 0; axis < 3; ++axis) image.grid.axes[axis] = {map[axis], map[4 + axis], map[8 + axis]};
  image.grid.origin = {map[3], map[7], map[11]};
  image.values = values_of(type, values, image.grid.voxels());
  require_finite(image);
  return image;
}

double at_least_zero(const Json& value, const char* key) {
  const auto v = value.get<double>();
  if (!(v >= 0)) throw OptionError(fmt::format("`{}` is {}: it must not be below 0", key, v));
  return v;
}

GreyBand band_of(const Json& row) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {row.at(1).is_null() ? -kInfinity : row.at(1).get<double>(),
          row.at(2).is_null() ? kInfinity : row.at(2).get<double>(), row.at(0).get<std::string>()};
}

std::uint32_t closing_of(const Json& value) {
  const auto n = value.get<std::int64_t>();
  constexpr int kMost = 64;
  if (n < 0 || n > kMost) throw OptionError(fmt::format("`close_voxels` is {}: it is from 0 to {}", n, kMost));
  return static_cast<std::uint32_t>(n);
}

ImageRegions::Kind kind_named(const std::string& name) {
  using Kind = ImageRegions::Kind;
  return one_of<Kind>({{"auto", Kind::kAuto}, {"labels", Kind::kLabels}, {"grey", Kind::kGrey}}, name, "kind");
}

LabelOptions labels_from(const Json& json, const RunContext& context) {
  LabelOptions labels;
  with(json, "names_file", [&](const Json& v) { labels.names = read_label_names(v.get<std::string>(), context); });
  with(json, "names", [&](const Json& v) {
    for (const Json& row : v) labels.names.push_back({row.at(0).get<std::int64_t>(), row.at(1).get<std::string>()});
  });
  with(json, "ignore", [&](const Json& v) { labels.ignore = v.get<std::vector<std::int64_t>>(); });
  with(json, "merge", [&](const Json& v) {
    for (const Json& row : v)
      labels.merge.push_back({row.at(0).get<std::string>(), row.at(1).get<std::vector<std::int64_t>>()});
  });
  return labels;
}

ImageRegions regions_from(const Json& json, const RunContext& context) {
  ImageRegions regions;
  regions.labels = labels_from(json, context);
  with(json, "kind", [&](const Json& v) { regions.kind = kind_named(v.get<std::string>()); });
  with(json, "bands", [&](const Json& v) {
    for (const Json& row : v) regions.bands.push_back(band_of(row));
  });
  with(json, "islands", [&](const Json& v) { regions.clean.islands = at_least_zero(v, "islands"); });
  with(json, "holes", [&](const Json& v) { regions.clean.holes = at_least_zero(v, "holes"); });
  with(json, "close_voxels", [&](const Json& v) { regions.clean.closing = closing_of(v); });
  with(json, "closed_at_box", [&](const Json& v) { regions.closed_at_box = v.get<bool>(); });
  return regions;
}

std::uint32_t voxel_number(const Json& value) {
  const auto n = value.get<std::int64_t>();
  if (n < 0 || n >= std::numeric_limits<std::uint32_t>::max())
    throw OptionError(fmt::format("`crop` has the voxel {}, which no image has", n));
  return static_cast<std::uint32_t>(n);
}

VoxelBox box_from(const Json& crop, const ImageGrid& grid) {
  VoxelBox box{{0, 0, 0}, grid.size};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Json& range = crop.at(axis);
    if (!range.at(0).is_null()) box.lo[axis] = voxel_number(range.at(0));
    if (!range.at(1).is_null()) box.hi[axis] = voxel_number(range.at(1)) + 1;
  }
  return box;
}

Vec3 spacing_from(const Json& json) {
  if (json.is_number()) return Vec3{1, 1, 1} * json.get<double>();
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

/// Cropped and resampled as asked; nullopt if neither was.
std::optional<Image> taken(const Image& image, const Json& json, const ImageRegions& regions,
                           const RunContext& context) {
  std::optional<Image> part;
  with(json, "crop", [&](const Json& v) { part = cropped(image, box_from(v, image.grid)); });
  with(json, "resample", [&](const Json& v) {
    const Image& from = part ? *part : image;
    part = resampled(from, spacing_from(v), kind_of(from, regions) == ImageRegions::Kind::kLabels, context);
  });
  return part;
}

void make_surface(octafront_job& job, const Image& image, const Json& json) {
  const ImageRegions regions = regions_from(json, job.context());
  const std::optional<Image> part = taken(image, json, regions, job.context());
  const Image& used = part ? *part : image;
  Complex complex = complex_of_image(used, regions, job.context());
  job.report = {{"format", used.format},
                {"size", used.grid.size},
                {"voxel", smallest_spacing(used.grid)},
                {"regions", json_of_regions(complex)}};
  Json notes = used.notes;
  for (std::string& note : complex.notes) notes.push_back(std::move(note));
  job.report["notes"] = std::move(notes);
  give(job, std::move(complex.surface));
}

}  // namespace

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

octafront_image* octafront_image_new(int type, const uint32_t* size, const void* values, const double* map) {
  octafront_image* made = nullptr;
  guarded([&] { made = new octafront_image{image_of(type, size, values, map)}; });
  return made;
}

void octafront_image_free(octafront_image* image) {
  delete image;
}

octafront_job* octafront_read_image(const char* const* files, size_t count, uint32_t series) {
  return started([names = std::vector<std::string>(files, files + count), series](octafront_job& job) {
    Image image = read_image(names, {series}, job.context());
    job.report = {{"format", image.format}, {"unit", image.unit}, {"frame", image.frame}, {"notes", image.notes}};
    job.image = std::make_unique<octafront_image>(octafront_image{std::move(image)});
  });
}

octafront_job* octafront_image_surface(const octafront_image* image, const char* json, int threads) {
  return started([image, text = std::string(json)](
                     octafront_job& job) { make_surface(job, image->image, nlohmann::ordered_json::parse(text)); },
                 threads);
}
