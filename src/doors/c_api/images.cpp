// Images: from arrays and files.

#include <octafront/error.h>
#include <octafront/image.h>

#include "doors/c_api/c_api.h"
#include "doors/c_api/job.h"

#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront::c_api {

namespace {

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

void require_finite_values(const Image& image) {
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
  require_finite_values(image);
  return image;
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
