#pragma once

#include <octafront/image.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// A corner of voxels: (x, y, z) is the least corner of voxel (x, y, z); 0 ... size along each axis.
using Corner = std::array<std::int32_t, 3>;

/// A voxel's label; outside of the image there is none.
using Label = std::uint16_t;

/// The voxels of a grid and their walls. Lengths are of *straight* space: along each axis the true lengths, at right
/// angles to each other whatever the image's axes are.
class Lattice {
 public:
  /// `margin`: see PeriodicMargin.
  Lattice(const ImageGrid& grid, std::span<const Label> labels, const std::array<std::uint32_t, 3>& margin = {0, 0, 0});

  const ImageGrid& grid() const { return grid_; }
  std::int32_t size(int axis) const { return size_[axis]; }
  Label label(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const bool inside = i >= 0 && j >= 0 && k >= 0 && i < size_[0] && j < size_[1] && k < size_[2];
    return inside ? labels_[number(i, j, k)] : LabelImage::kNoRegion;
  }
  Label label(const Corner& voxel) const { return label(voxel[0], voxel[1], voxel[2]); }
  /// A row of voxels along i; null outside.
  const Label* row(std::int32_t j, std::int32_t k) const {
    return j < 0 || k < 0 || j >= size_[1] || k >= size_[2] ? nullptr : labels_.data() + number(0, j, k);
  }
  std::size_t number(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size_[0]) * (static_cast<std::size_t>(j) + static_cast<std::size_t>(size_[1]) * k);
  }

  /// Where a wall between voxels lies, and the middle of a voxel; beyond the image's ends too, by one voxel.
  double wall(int axis, std::int32_t c) const { return wall_[axis][c]; }
  double middle(int axis, std::int32_t voxel) const { return middle_[axis][voxel + 1]; }
  Vec3 at(const Corner& c) const { return {wall(0, c[0]), wall(1, c[1]), wall(2, c[2])}; }
  Vec3 middle_of(const Corner& voxel) const { return {middle(0, voxel[0]), middle(1, voxel[1]), middle(2, voxel[2])}; }
  double volume(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return (wall(0, i + 1) - wall(0, i)) * (wall(1, j + 1) - wall(1, j)) * (wall(2, k + 1) - wall(2, k));
  }
  /// On the image's box, or on that of a cell.
  bool on_box(const Corner& c, int axis) const {
    return c[axis] == 0 || c[axis] == size_[axis] || is_low(c, axis) || is_high(c, axis);
  }
  /// Of a cell of an image that goes on periodically, which is this one without its margin.
  bool is_periodic() const { return margin_ != std::array<std::int32_t, 3>{}; }
  bool is_low(const Corner& c, int axis) const { return margin_[axis] > 0 && c[axis] == margin_[axis]; }
  bool is_high(const Corner& c, int axis) const { return margin_[axis] > 0 && c[axis] == size_[axis] - margin_[axis]; }
  bool is_in_cell(const Corner& voxel) const {
    for (int a = 0; a < 3; ++a)
      if (voxel[a] < margin_[a] || voxel[a] >= size_[a] - margin_[a]) return false;
    return true;
  }

  Vec3 to_world(Vec3 straight) const;
  Vec3 to_straight(Vec3 world) const;
  /// Whether the way to the world turns right into left.
  bool is_mirrored() const;
  /// World volume of a unit of straight volume.
  double volume_scale() const;

 private:
  void place_halves(int axis);

  const ImageGrid& grid_;
  std::span<const Label> labels_;
  std::array<std::int32_t, 3> size_, margin_;
  Vec3 step_;  ///< lengths of the axes
  std::array<std::vector<double>, 3> wall_, middle_;
};

/// The labels of the eight voxels around a corner: bit a of the index is set for those on the upper side along axis a.
using Octants = std::array<Label, 8>;
Octants octants_at(const Lattice& lattice, const Corner& c);

/// The twelve faces of voxels at a corner: the one that lies across `axis`, on the upper side (1) or the lower one
/// along the next axis and the one after.
constexpr int slot_of(int axis, int next_side, int last_side) {
  return 4 * axis + next_side + 2 * last_side;
}

/// The faces between different labels at a corner, grouped by what hangs together: a vertex of the net for each group.
///
/// Faces hang together over the lattice's edges. Where voxels a, b, a, c lie around an edge, the two a hang together
/// across it, and two surfaces pass it: one around b, one around c. Of a, b, a, b those join that are fewer around the
/// edge, or else have the lower label.
struct Fans {
  static constexpr std::uint8_t kNoFace = 0xff;
  std::array<std::uint8_t, 12> of_slot;  ///< the group of each face
  int count = 0;

  Fans(const Lattice& lattice, const Corner& c, const Octants& octants);
  /// From the corner to the mean of the middles of a group's faces.
  Vec3 way_out(const Lattice& lattice, const Corner& c, int group) const;
};

}  // namespace octafront::nets
