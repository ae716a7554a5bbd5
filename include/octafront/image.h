#pragma once

#include <octafront/no_context.h>
#include <octafront/surface_mesh.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace octafront {

// Images of voxels (CT, MRI, segmentations), and the complexes that their labels or grey values bound.

/// Where the voxels of an image lie. Voxel (i, j, k) is number i + ni (j + nj k); its middle is, in index space,
/// (i, j, slice(k)), and in the world axes[0] i + axes[1] j + axes[2] slice(k) + origin. Indices to the world may be
/// any invertible affine map: flips, rotations, the shear of a tilted gantry.
struct ImageGrid {
  std::array<std::uint32_t, 3> size = {0, 0, 0};                   ///< voxels along i, j and k
  std::array<Vec3, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< steps of one voxel, in the unit of the file
  Vec3 origin;                                                     ///< of the middle of voxel (0, 0, 0)
  std::vector<double> slices;  ///< where each k lies, in steps of axes[2], ascending; empty: 0, 1, 2, ...

  std::size_t voxels() const { return std::size_t{size[0]} * size[1] * size[2]; }
  double slice(std::uint32_t k) const { return slices.empty() ? k : slices[k]; }
  Vec3 to_world(Vec3 index) const { return origin + axes[0] * index.x + axes[1] * index.y + axes[2] * index.z; }
  friend bool operator==(const ImageGrid&, const ImageGrid&) = default;
};

/// An image as a file has it.
struct Image {
  /// One value per voxel, slope and intercept of the file applied where it has any.
  using Values = std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>,
                              std::vector<std::int32_t>, std::vector<float>>;
  ImageGrid grid;
  Values values;
  std::vector<std::string> notes;  ///< what a reader decided or changed, a sentence each
};

/// A segmentation: per voxel the number of its region, or kNoRegion.
struct LabelImage {
  static constexpr std::uint16_t kNoRegion = 0xffff;
  struct Label {
    std::int64_t value = 0;  ///< in the image
    std::string name;        ///< of the region
  };
  ImageGrid grid;
  std::vector<std::uint16_t> regions;  ///< per voxel, an index into labels
  std::vector<Label> labels;
};

}  // namespace octafront
