#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "base/shared/shares.h"
#include "fill/lattice/graded_bcc.h"
#include "fill/lattice/lattice_octree.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront {

/// Least distance of the core from the surface, over the side of the lattice's cell there. The core's elements are
/// better than those of the front that fills the shell around it, so nearer is better, down to where the shell becomes
/// too thin for good elements (docs/how/volume-front.md has the measurement).
inline constexpr double kCoreClearance = 0.4;

/// A site by number. Leaf i has 2 i for its centre and 2 i + 1 for its lower corner; the few other sites (they depend
/// on the side of a larger leaf, or lie on an upper side of the root) are numbered as `kHanging` and up by each chunk.
using SiteNumber = std::uint32_t;
inline constexpr SiteNumber kHanging = 0x80000000u;

constexpr bool is_hanging(SiteNumber s) {
  return s >= kHanging;
}
constexpr bool is_center(SiteNumber s) {
  return !is_hanging(s) && s % 2 == 0;
}

/// Which sites of a lattice keep their distance from the surface, and on which side of it they lie.
class ClearSites {
 public:
  /// Keeps references to all but `context`. REQUIRES a clean surface and the trees of its triangles, and of those
  /// between its regions and the outside (the same but for a complex).
  ClearSites(const LatticeOctree& lattice, const TriangleTree& triangles, const TriangleTree& hull,
             const RunContext& context);

  const LatticeOctree& lattice() const { return lattice_; }
  Vec3 position_of(SiteNumber s) const {
    const OctreeKey leaf = lattice_.tree.leaf(s / 2);
    return s % 2 == 0 ? lattice_.root.center_of(leaf) : lattice_.root.corner_of(leaf);
  }

  /// A lower bound of the distance to the surface; 0 where a site is not clear of it, or known to lie outside. REQUIRES
  /// a site that is not hanging.
  float distance(SiteNumber s) const { return distance_[s]; }
  /// The same for any site.
  float distance_of(LatticeSite site) const;
  /// REQUIRES that the centre of the leaf is clear.
  bool center_is_inside(std::size_t leaf) const { return inside_[leaf] != 0; }
  bool contains(Vec3 p) const { return hull_.contains(p); }
  /// No site of the leaf can be part of the core.
  bool is_far_outside(std::size_t leaf) const { return is_far(leaf) && !inside_[leaf]; }
  /// The leaf is so far from the surface that all in it is clear.
  bool is_far(std::size_t leaf) const { return space_[leaf] == Space::kFar; }
  /// It is proved that the tetrahedron does not touch the surface, from which its corners have at least this distance.
  /// True is exact; false may only mean that there is no simple proof.
  bool is_clear(const std::array<Vec3, 4>& corners, float least_distance) const;

 private:
  /// How near the surface comes to a leaf: kClear, not into its cell; kFar, not even near to it.
  enum class Space : std::uint8_t { kNear, kClear, kFar };

  void measure_center(std::size_t leaf, std::uint32_t& near_by);
  void measure_corner(std::size_t leaf, std::uint32_t& near_by);
  /// measure(leaf, near_by) of all leaves; ranks share them.
  template <class Measure>
  void for_each_leaf(const RunContext& context, const Measure& measure);
  void gather_leaves(const Comm& comm, const Shares& shares);
  double distance_within(double farthest, Vec3 p, double enough, std::uint32_t& near_by) const;
  static float kept(double distance, double side);
  float measured(Vec3 p, double side, std::uint32_t& near_by) const;
  void find_inside();

  const LatticeOctree& lattice_;
  const TriangleTree &triangles_, &hull_;
  std::vector<Space> space_;          ///< per leaf
  std::vector<float> distance_;       ///< per site that does not hang
  std::vector<std::uint8_t> inside_;  ///< per leaf, of its centre
};

}  // namespace octafront
