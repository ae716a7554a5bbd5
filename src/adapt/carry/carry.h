#pragma once

// adapt/carry: what was known on a mesh, on another: values at nodes by linear interpolation, values of elements such
// that their integrals stay. Takes two meshes and what they have in common; looks only at what differs.

#include <octafront/carry.h>
#include <octafront/metric.h>
#include <octafront/tet_mesh.h>

#include "adapt/carry/regions.h"
#include "base/geometry/box_tree.h"
#include "base/geometry/measures.h"
#include "base/geometry/tet_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace octafront::adapt {

/// The meshes, and what they have in common.
struct MeshPair {
  const TetMesh &before, &now;  ///< both valid; of second order they are taken as linear ones
  const MatchedRegions& regions;
  KnownItems same;
};

/// `components` numbers for each node or element of the old mesh.
struct OldValues {
  std::span<const double> values;
  std::size_t components;
};

inline TetCorners corners_in(const TetMesh& mesh, TetIndex t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return {mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]};
}
inline double volume_in(const TetMesh& mesh, TetIndex t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
}
/// The place of a tetrahedron that is nearest to p, which lies outside.
Vec3 nearest_on(const TetCorners& corners, Vec3 p);

/// The tets of the old mesh that the new one has not, by their boxes.
class GoneTets {
 public:
  explicit GoneTets(const MeshPair& meshes);

  bool is_gone(TetIndex t) const { return !is_kept_[t]; }

  /// visit(tet) for all whose boxes meet the box, in an order that depends on the tree only.
  template <class Visit>
  void for_each_near(const Box3& box, const Visit& visit) const {
    boxes_.for_each([&](const Box3& b) { return b.overlaps(box); }, [&](const auto& item) { visit(item.number); });
  }

  /// The tet nearest to p, of those wanted; kNone: there is none.
  template <class Wanted>
  TetIndex nearest(Vec3 p, const Wanted& wanted) const {
    TetIndex best = kNone;
    double distance = HUGE_VAL;
    boxes_.for_each([&](const Box3& box) { return squared_distance(p, nearest_in(box, p)) < distance; },
                    [&](const auto& item) {
                      if (!wanted(item.number)) return;
                      const double d = squared_distance(p, nearest_on(corners_in(mesh_, item.number), p));
                      if (d < distance) distance = d, best = item.number;
                    },
                    [&](const Box3& left, const Box3& right) {
                      return squared_distance(p, nearest_in(left, p)) <= squared_distance(p, nearest_in(right, p));
                    });
    return best;
  }

 private:
  using Boxes = BoxTree<Box3>;
  static Vec3 nearest_in(const Box3& box, Vec3 p) { return max(box.lo, min(box.hi, p)); }
  static std::vector<std::uint8_t> kept_of(const MeshPair& meshes);
  static std::vector<Boxes::Item> items_of(const TetMesh& mesh, const std::vector<std::uint8_t>& is_kept);

  const TetMesh& mesh_;
  std::vector<std::uint8_t> is_kept_;
  Boxes boxes_;
};

/// Up to four old nodes, and the part that each has in a value.
struct Mixture {
  std::array<VertexIndex, 4> nodes{};
  std::array<double, 4> parts{};
  /// The nodes in the middle of edges between them, in the order of kTetEdges; kNone: there are none.
  std::array<VertexIndex, 6> mids = {kNone, kNone, kNone, kNone, kNone, kNone};
};

/// What quadratic fields have in the middle of an edge beyond the mean of its ends: at mid-side nodes, or without them
/// by second derivatives.
class EdgeBends {
 public:
  EdgeBends(const TetMesh& mesh, const OldValues& old, const RunContext& context);

  /// Of a mixture, and a component of the field.
  double bend(const Mixture& mixture, std::size_t k) const;
  /// No value is beyond those of the nodes.
  double in_range(double value, std::size_t k) const { return std::clamp(value, least_[k], greatest_[k]); }

 private:
  double of_edge(const Mixture& mixture, std::size_t edge, std::size_t k) const;

  const TetMesh& mesh_;
  OldValues old_;
  std::vector<double> least_, greatest_;
  std::vector<std::vector<Metric>> hessians_;  ///< by component; empty: there are mid-side nodes
};

/// Values at the nodes of the new mesh. A node that is where it was has its own bits; another the linear function of
/// the tet that holds it, or the quadratic one. Enters into the report what is copied and what lies outside.
std::vector<double> carried_at_nodes(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                     OutsideNodes outside, const CarryOptions& options, const RunContext& context,
                                     CarryReport& report);

/// Values of the tets of the new mesh: those of a tet that is unchanged are its own; another has the mean over what it
/// shares with old ones of its region. Enters into the report what is not covered.
std::vector<double> carried_of_elements(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                        const CarryOptions& options, const RunContext& context, CarryReport& report);

/// Values at the four integration points of the tets of the new mesh, `old.components` a multiple of four. Inside of an
/// old tet they are linear. A tet that is unchanged has its own; of another each point has the value there of the old
/// tet of its region that holds it, all shifted by the same to the mean over what is shared, differences made smaller
/// until none is beyond the range of the region.
std::vector<double> carried_at_points(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                      const CarryOptions& options, const RunContext& context, CarryReport& report);

/// The old tet of the region that holds p: of several the one with the lowest number; kNone: none does.
template <class OfRegion>
TetIndex holder_of(const TetMesh& mesh, const GoneTets& gone, Vec3 p, const OfRegion& is_of_region) {
  TetIndex holder = kNone;
  gone.for_each_near({p, p}, [&](TetIndex t) {
    if (t < holder && is_of_region(t) && TetPlanes(corners_in(mesh, t)).holds(p)) holder = t;
  });
  return holder;
}

/// Spreads what the integral over each region lacks over its elements that changed, evenly among those that stay within
/// the range of the region so. Where no values in that range have the integral, all are shifted by the same. Returns
/// for each component how far that goes beyond. `at_points`: values at points, several of each component in an element,
/// which the range is of then; or null.
std::vector<double> spread_rest(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                std::vector<double>& made, const OldValues* at_points = nullptr);

}  // namespace octafront::adapt
