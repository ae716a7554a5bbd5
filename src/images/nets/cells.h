#pragma once

#include "images/nets/net.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// How much room a vertex has: a box around its corner, up to the middles of the voxels there, flat on the image's box
/// and that of a cell.
/// Less at labels of few voxels, which smoothing would pull together to points, and toward voxels that are a layer by
/// themselves, whose two sides would come together.
class VertexCells {
 public:
  /// Of labels: without the corners of the boxes, which are middles of voxels. `voxels`: of each label.
  VertexCells(const Lattice& lattice, const Net& net, std::span<const std::uint64_t> voxels);
  /// Of grey values, which say where between middles the surface is.
  VertexCells(const Lattice& lattice, const Net& net);
  /// Of surfaces that are known: all room that there is, also toward layers, whose sides lie apart as they are.
  static VertexCells without_layers(const Lattice& lattice, const Net& net);

  Vec3 clamped(VertexIndex v, Vec3 p) const;

  /// Ways from a corner. Many vertices have the same room: there are few of them.
  struct Room {
    Vec3 lo, hi;
    Vec3 half_over_below, half_over_above;  ///< a half over the signed ways to the middles of the voxels
    friend bool operator==(const Room&, const Room&) = default;
  };
  const std::vector<Room>& rooms() const { return rooms_; }
  std::uint32_t room_number(VertexIndex v) const { return room_of_[v]; }
  Vec3 corner(VertexIndex v) const {
    const Corner& c = net_.corner[v];
    return {wall_[0][c[0]], wall_[1][c[1]], wall_[2][c[2]]};
  }
  /// From the corner, in voxels.
  double farthest() const { return farthest_; }

 private:
  /// Per vertex, axis and side, lower ones first: part of the way to the middles of the voxels there.
  using Shares = std::vector<std::array<std::array<float, 2>, 3>>;
  VertexCells(const Lattice& lattice, const Net& net, const Shares& shares);
  static Shares shares_between_layers(const Lattice& lattice, const Net& net);
  void number_rooms(const Lattice& lattice, const Shares& shares);

  double farthest_;
  const Net& net_;
  std::array<std::vector<double>, 3> wall_;  ///< per axis
  std::vector<Room> rooms_;
  std::vector<std::uint32_t> room_of_;  ///< per vertex
};

}  // namespace octafront::nets
