#include "base/geometry/measures.h"
#include "base/geometry/plane_mesh.h"
#include "soup/mend/caps.h"
#include "soup/mend/flat_rim.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace octafront::mend {
namespace {

using arrangement::PlaneMesh;

Vec3 area_vector(std::span<const Vec3> points, const Loop& loop) {
  const auto at = [&](std::size_t i) { return points[loop.vertices[i]]; };
  Vec3 twice;
  for (std::size_t i = 1; i + 1 < loop.vertices.size(); ++i) twice += double_area_normal(at(0), at(i), at(i + 1));
  return 0.5 * twice;
}

/// Rims seen across the plane of the outer one.
class LidPlane {
 public:
  LidPlane(std::span<const Vec3> points, const Loop& outer, Vec3 normal)
      : points_(points), outer_(outer), normal_(normal), frame_(frame_at({}, normal)) {
    for (const VertexIndex v : outer.vertices) height_ += dot(points[v], normal) / double(outer.vertices.size());
  }

  bool holds(const Loop& loop, double tolerance) const {
    return std::ranges::all_of(
        loop.vertices, [&](VertexIndex v) { return std::abs(dot(points_[v], normal_) - height_) <= tolerance; });
  }

  /// By its first vertex.
  bool is_around(const Loop& loop) const {
    return is_inside(
        outer_.vertices.size(), [&](std::size_t i) { return seen_along(frame_, points_[outer_.vertices[i]]); },
        seen_along(frame_, points_[loop.vertices.front()]));
  }

  /// Nothing where rims cross or meet, or run the wrong way.
  std::optional<std::vector<Triangle>> cap(const std::vector<const Loop*>& loops) const {
    Box3 box;
    for (const VertexIndex v : outer_.vertices) box.add(flat(v));
    PlaneMesh mesh(arrangement::plane_through(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}), 2, box);
    std::map<PlaneMesh::Node, VertexIndex> vertex;
    std::map<VertexIndex, PlaneMesh::Node> node;
    for (const Loop* loop : loops)
      for (const VertexIndex v : loop->vertices) {
        const PlaneMesh::Node n = mesh.add_point({flat(v)});
        node.emplace(v, n);
        if (vertex.emplace(n, v).first->second != v) return std::nullopt;
      }
    std::set<std::array<VertexIndex, 2>> rim;
    for (const Loop* loop : loops)
      for (std::size_t i = 0; i < loop->vertices.size(); ++i) {
        const VertexIndex a = loop->vertices[i], b = loop->vertices[(i + 1) % loop->vertices.size()];
        mesh.add_segment(node.at(a), node.at(b), arrangement::plane_along_axis(flat(a), flat(b), 2), 0);
        if (!mesh.crossings().empty()) return std::nullopt;
        rim.insert({a, b});
      }
    mesh.improve();
    std::vector<Triangle> triangles;
    for (const PlaneMesh::Piece& piece : mesh.pieces())
      triangles.push_back({vertex.at(piece.corners[0]), vertex.at(piece.corners[1]), vertex.at(piece.corners[2])});
    if (border_of(triangles) != rim) return std::nullopt;
    return triangles;
  }

 private:
  Vec3 flat(VertexIndex v) const {
    const Flat p = seen_along(frame_, points_[v]);
    return {p.x, p.y, 0};
  }

  static std::set<std::array<VertexIndex, 2>> border_of(const std::vector<Triangle>& triangles) {
    std::set<std::array<VertexIndex, 2>> border;
    for (const Triangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (border.erase({t[(k + 1) % 3], t[k]}) == 0) border.insert({t[k], t[(k + 1) % 3]});
    return border;
  }

  std::span<const Vec3> points_;
  const Loop& outer_;
  Vec3 normal_;
  Frame frame_;
  double height_ = 0;
};

/// The outer rim with as many of the others as can be.
SharedLid lid_over(const LidPlane& plane, const std::vector<Loop>& loops, std::uint32_t outer,
                   const std::vector<std::uint32_t>& inner) {
  SharedLid lid{{outer}, {}};
  std::vector<const Loop*> rims{&loops[outer]};
  for (const std::uint32_t i : inner) {
    rims.push_back(&loops[i]);
    auto cap = plane.cap(rims);
    if (cap) {
      lid.loops.push_back(i);
      lid.cap = std::move(*cap);
    } else {
      rims.pop_back();
    }
  }
  return lid;
}

}  // namespace

std::vector<SharedLid> shared_lids(std::span<const Vec3> points, const std::vector<Loop>& loops,
                                   const std::vector<char>& may_share, double tolerance) {
  std::vector<Vec3> area;
  for (const Loop& loop : loops) area.push_back(area_vector(points, loop));
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < loops.size(); ++i)
    if (may_share[i] && area[i] != Vec3{}) order.push_back(i);
  std::ranges::stable_sort(order, std::greater{}, [&](std::uint32_t i) { return length(area[i]); });
  std::vector<char> taken(loops.size(), 0);
  std::vector<SharedLid> lids;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t outer = order[k];
    const LidPlane plane(points, loops[outer], normalized(area[outer]));
    if (taken[outer] || !plane.holds(loops[outer], tolerance)) continue;
    std::vector<std::uint32_t> inner;
    for (const std::uint32_t i : std::span(order).subspan(k + 1))
      if (!taken[i] && plane.holds(loops[i], tolerance) && plane.is_around(loops[i])) inner.push_back(i);
    SharedLid lid = lid_over(plane, loops, outer, inner);
    if (lid.loops.size() < 2) continue;
    for (const std::uint32_t i : lid.loops) taken[i] = 1;
    lids.push_back(std::move(lid));
  }
  return lids;
}

}  // namespace octafront::mend
