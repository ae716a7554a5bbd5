#include "adapt/cut/cutter.h"
#include "base/core/flat_map.h"
#include "base/geometry/predicates.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace octafront::adapt {
namespace {

/// A convex polygon of a face on one side: its corners, counter-clockwise seen from outside; at most four.
struct SidePolygon {
  std::array<VertexIndex, 4> corners{};
  std::size_t size = 0;

  void add(VertexIndex v) { corners[size++] = v; }
  bool has(VertexIndex v) const {
    return std::find(corners.begin(), corners.begin() + size, v) != corners.begin() + size;
  }
  /// visit(triangle) for the triangles at its lowest corner: whoever divides it, from both sides, divides it alike.
  template <class Visit>
  void for_each_triangle(const Visit& visit) const {
    const auto lowest =
        static_cast<std::size_t>(std::min_element(corners.begin(), corners.begin() + size) - corners.begin());
    for (std::size_t i = 1; i + 1 < size; ++i)
      visit(Triangle{corners[lowest], corners[(lowest + i) % size], corners[(lowest + i + 1) % size]});
  }
};

class MeshDivider {
 public:
  MeshDivider(CutState& state, std::size_t level_set)
      : state_(state), mesh_(state.mesh), level_set_(level_set), values_(state.values[level_set]) {}

  void divide(LevelSetReport& report) {
    find_crossings();
    while (!divide_tets()) find_crossings();
    report.divided = edges_.size(), report.on += on_;
    add_points();
    divide_faces(mesh_.boundary, 0), divide_faces(mesh_.interfaces, old_boundary_);
    divide_curves();
    state_.old_face = std::move(old_face_);
    mesh_.tets = std::move(tets_), state_.old_tet = std::move(old_tet_), state_.inside = std::move(inside_);
  }

 private:
  struct Crossing {
    Edge edge;  ///< lower point first
    Vec3 place;
    double part;  ///< of the edge, from its lower point
  };

  int side(VertexIndex v) const {
    if (v >= mesh_.points.size()) return 0;
    return (values_[v] > 0) - (values_[v] < 0);
  }
  Vec3 place(VertexIndex v) const {
    return v < mesh_.points.size() ? mesh_.points[v] : edges_[v - mesh_.points.size()].place;
  }
  bool is_crossed(VertexIndex a, VertexIndex b) const { return side(a) * side(b) < 0; }
  VertexIndex point_on(VertexIndex a, VertexIndex b) const {
    return *number_.find(Edge{std::min(a, b), std::max(a, b)});
  }

  void find_crossings() {
    edges_.clear(), number_.reset(0);
    for (const Tet& t : mesh_.tets)
      for (const auto& e : kTetEdges) {
        const VertexIndex a = std::min(t[static_cast<std::size_t>(e[0])], t[static_cast<std::size_t>(e[1])]),
                          b = std::max(t[static_cast<std::size_t>(e[0])], t[static_cast<std::size_t>(e[1])]);
        if (!is_crossed(a, b) || number_.find(Edge{a, b}) != nullptr) continue;
        const double part = values_[a] / (values_[a] - values_[b]);
        number_.find_or_add(Edge{a, b}) = static_cast<VertexIndex>(mesh_.points.size() + edges_.size());
        edges_.push_back({{a, b}, mesh_.points[a] + part * (mesh_.points[b] - mesh_.points[a]), part});
      }
  }

  SidePolygon part_of_face(const Triangle& face, int wanted) const {
    SidePolygon polygon;
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexIndex v = face[i], next = face[(i + 1) % 3];
      if (side(v) * wanted >= 0) polygon.add(v);
      if (is_crossed(v, next)) polygon.add(point_on(v, next));
    }
    return polygon;
  }

  /// What closes a part of a tet: from the edges of its other polygons that lie on the surface, turned around.
  SidePolygon cap_of(const std::array<SidePolygon, 4>& polygons) const {
    std::array<Edge, 8> edges;
    std::size_t count = 0;
    for (const SidePolygon& p : polygons)
      for (std::size_t i = 0; p.size > 2 && i < p.size; ++i)
        if (const VertexIndex a = p.corners[i], b = p.corners[(i + 1) % p.size]; side(a) == 0 && side(b) == 0)
          edges[count++] = {b, a};
    SidePolygon cap;
    if (count < 3) return cap;
    VertexIndex at = edges[0][0];
    for (std::size_t i = 0; i < count && i < 4; ++i) {
      cap.add(at);
      const auto next = std::find_if(edges.begin(), edges.begin() + count, [&](const Edge& e) { return e[0] == at; });
      at = next == edges.begin() + count ? at : (*next)[1];
    }
    return cap;
  }

  /// The tets on one side of a tet that is crossed: from the lowest corner to all that does not touch it.
  template <class Visit>
  void for_each_part(const Tet& tet, int wanted, const Visit& visit) const {
    std::array<SidePolygon, 4> polygons;
    for (int i = 0; i < 4; ++i) {
      polygons[static_cast<std::size_t>(i)] = part_of_face(face_of(tet, i), wanted);
      if (polygons[static_cast<std::size_t>(i)].size < 3) polygons[static_cast<std::size_t>(i)].size = 0;
    }
    const SidePolygon cap = cap_of(polygons);
    VertexIndex lowest = kNone;
    for (const SidePolygon& p : polygons)
      for (std::size_t i = 0; i < p.size; ++i) lowest = std::min(lowest, p.corners[i]);
    const auto join = [&](const SidePolygon& p) {
      if (p.size > 2 && !p.has(lowest))
        p.for_each_triangle([&](const Triangle& f) { visit(Tet{f[0], f[2], f[1], lowest}); });
    };
    for (const SidePolygon& p : polygons) join(p);
    join(cap);
  }

  void add_tet(const Tet& tet, TetIndex from, int its_side) {
    tets_.push_back(tet);
    old_tet_.push_back(state_.old_tet[from]);
    const std::uint32_t before = state_.inside[from];
    inside_.push_back(before == kNone && its_side < 0 ? static_cast<std::uint32_t>(level_set_) : before);
  }

  /// False: an element would not be positive, and a point was taken for one on the surface.
  bool divide_tets() {
    tets_.clear(), old_tet_.clear(), inside_.clear();
    bool is_sound = true;
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      const Tet& tet = mesh_.tets[t];
      const auto [least, greatest] = std::minmax({side(tet[0]), side(tet[1]), side(tet[2]), side(tet[3])});
      if (least >= 0 || greatest <= 0) {
        add_tet(tet, t, least < 0 ? -1 : 1);
        continue;
      }
      bool is_positive = true;
      for (const int wanted : {-1, 1})
        for_each_part(tet, wanted, [&](const Tet& part) {
          const auto& [a, b, c, d] = part;
          is_positive = is_positive && orient3d(place(a), place(b), place(c), place(d)) > 0;
          add_tet(part, t, wanted);
        });
      if (!is_positive) is_sound = false, take_nearest_for_on(tet);
    }
    return is_sound;
  }

  void take_nearest_for_on(const Tet& tet) {
    double least = std::numeric_limits<double>::infinity();
    VertexIndex nearest = kNone;
    for (const auto& e : kTetEdges)
      for (const int from : {0, 1}) {
        const VertexIndex v = tet[static_cast<std::size_t>(e[static_cast<std::size_t>(from)])],
                          w = tet[static_cast<std::size_t>(e[static_cast<std::size_t>(1 - from)])];
        if (!is_crossed(v, w)) continue;
        const double part = values_[v] / (values_[v] - values_[w]);
        if (part < least || (part == least && v < nearest)) least = part, nearest = v;
      }
    // Another element beside may have taken it.
    if (nearest != kNone) values_[nearest] = 0, ++on_;
  }

  void add_points() {
    for (const Crossing& crossing : edges_) {
      const auto& [a, b] = crossing.edge;
      mesh_.points.push_back(crossing.place);
      state_.old_node.push_back(kNone);
      for (std::vector<double>& values : state_.values)
        values.push_back(values[a] + crossing.part * (values[b] - values[a]));
      values_.back() = 0;
    }
  }

  /// As before the points were added.
  bool was_crossed(VertexIndex a, VertexIndex b) const { return values_[a] * values_[b] < 0; }

  void divide_faces(std::vector<Triangle>& faces, std::size_t first) {
    if (first == 0) old_boundary_ = faces.size();
    std::vector<Triangle> divided;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const Triangle& face = faces[f];
      const auto add = [&](const Triangle& part) {
        divided.push_back(part), old_face_.push_back(state_.old_face[first + f]);
      };
      if (!was_crossed(face[0], face[1]) && !was_crossed(face[1], face[2]) && !was_crossed(face[2], face[0])) {
        add(face);
        continue;
      }
      for (const int wanted : {-1, 1})
        if (const SidePolygon polygon = part_of_face(face, wanted); polygon.size > 2) polygon.for_each_triangle(add);
    }
    faces = std::move(divided);
  }

  void divide_curves() {
    std::vector<Edge> divided;
    std::vector<std::uint32_t> old;
    for (std::size_t e = 0; e < mesh_.curve_edges.size(); ++e) {
      const auto& [a, b] = mesh_.curve_edges[e];
      const auto add = [&](VertexIndex from, VertexIndex to) {
        divided.push_back({from, to}), old.push_back(state_.old_edge[e]);
      };
      if (!was_crossed(a, b)) {
        add(a, b);
        continue;
      }
      add(a, point_on(a, b)), add(point_on(a, b), b);
    }
    mesh_.curve_edges = std::move(divided), state_.old_edge = std::move(old);
  }

  CutState& state_;
  TetMesh& mesh_;
  std::size_t level_set_;
  std::vector<double>& values_;
  std::vector<Crossing> edges_;
  FlatMap<Edge, VertexIndex> number_;
  std::uint64_t on_ = 0;
  std::vector<Tet> tets_;
  std::vector<std::uint32_t> old_tet_, inside_, old_face_;
  std::size_t old_boundary_ = 0;
};

}  // namespace

void divide_along(CutState& state, std::size_t level_set, LevelSetReport& report) {
  MeshDivider(state, level_set).divide(report);
}

}  // namespace octafront::adapt
