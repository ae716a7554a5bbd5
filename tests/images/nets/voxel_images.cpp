#include "voxel_images.h"

#include "support/random.h"

#include <cmath>
#include <numbers>

namespace octafront::testing {

namespace {

template <class Visit>
void for_each_voxel(const ImageGrid& grid, const Visit& visit) {
  std::size_t n = 0;
  for (std::uint32_t k = 0; k < grid.size[2]; ++k)
    for (std::uint32_t j = 0; j < grid.size[1]; ++j)
      for (std::uint32_t i = 0; i < grid.size[0]; ++i)
        visit(n++, grid.to_world({static_cast<double>(i), static_cast<double>(j), grid.slice(k)}));
}

std::vector<LabelImage::Label> names(int labels) {
  std::vector<LabelImage::Label> all;
  for (int l = 0; l < labels; ++l) all.push_back({l + 1, std::string(1, static_cast<char>('a' + l))});
  return all;
}

}  // namespace

LabelImage label_image(const ImageGrid& grid, int labels, const std::function<int(Vec3)>& label_at) {
  LabelImage image;
  image.grid = grid;
  image.labels = names(labels);
  image.regions.resize(grid.voxels());
  for_each_voxel(grid, [&](std::size_t n, Vec3 p) {
    const int label = label_at(p);
    image.regions[n] = label < 0 ? LabelImage::kNoRegion : static_cast<std::uint16_t>(label);
  });
  return image;
}

Image grey_image(const ImageGrid& grid, const std::function<double(Vec3)>& value_at) {
  std::vector<float> values(grid.voxels());
  for_each_voxel(grid, [&](std::size_t n, Vec3 p) { values[n] = static_cast<float>(value_at(p)); });
  Image image;
  image.grid = grid;
  image.values = std::move(values);
  return image;
}

ImageGrid grid_around_origin(std::array<std::uint32_t, 3> size, Vec3 spacing) {
  ImageGrid grid;
  grid.size = size;
  grid.axes = {{{spacing.x, 0, 0}, {0, spacing.y, 0}, {0, 0, spacing.z}}};
  for (int a = 0; a < 3; ++a) grid.origin -= grid.axes[a] * (0.5 * (size[a] - 1.0));
  return grid;
}

ImageGrid turned(ImageGrid grid, double degrees) {
  const Vec3 n = normalized({1, 2, 3});
  const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
  const auto turn = [&](Vec3 v) { return v * c + cross(n, v) * s + n * (dot(n, v) * (1 - c)); };
  for (Vec3& axis : grid.axes) axis = turn(axis);
  grid.origin = turn(grid.origin);
  return grid;
}

LabelImage noise(std::array<std::uint32_t, 3> size, int labels, double density, std::uint64_t seed) {
  Random random(seed);
  return label_image(grid_around_origin(size, {1, 1, 1}), labels,
                     [&](Vec3) { return random.unit() < density ? random.integer(0, labels - 1) : -1; });
}

}  // namespace octafront::testing
