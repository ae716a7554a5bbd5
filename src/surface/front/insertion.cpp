#include "base/geometry/predicates.h"
#include "surface/edits/local_guards.h"
#include "surface/front/front_steps.h"

#include <algorithm>

namespace octafront::surface {

namespace {

/// A point this close to the border of its input face, in element sizes, is put on the border.
constexpr double kSnapToEdge = 1e-3;
/// A point this close to a vertex, in element sizes, is that vertex.
constexpr double kSnapInSizes = 1e-2;

/// Bounds against walks and flips that rounding might keep from ending; a point in the wrong part of its face is put on
/// the nearest edge or left out.
constexpr std::size_t kMostSteps = 100000;
constexpr int kMostFlips = 1000;

/// Projection of a face along its longest normal component, keeping its orientation.
struct Plane2d {
  int u = 0, v = 1;

  explicit Plane2d(Vec3 n) {
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    u = (axis + 1) % 3;
    v = (axis + 2) % 3;
    if (n[axis] < 0) std::swap(u, v);
  }
  int side(Vec3 a, Vec3 b, Vec3 x) const { return orient2d(a[u], a[v], b[u], b[v], x[u], x[v]); }
  /// Distance of x from the line through a and b in the projection; negative to the right.
  double height(Vec3 a, Vec3 b, Vec3 x) const {
    const double du = b[u] - a[u], dv = b[v] - a[v], l = std::sqrt(du * du + dv * dv);
    return l > 0 ? (du * (x[v] - a[v]) - dv * (x[u] - a[u])) / l : 0;
  }
};

class Inserter {
 public:
  Inserter(const InputSurface& input, const FrontPoints& front, InsertionCounts& counts)
      : input_(input),
        front_(front),
        counts_(counts),
        mesh_(input),
        last_(mesh_.origin),
        vertex_of_point_(front.points.size(), kNone) {
    mesh_.reserve(mesh_.points.size() + front.points.size(), mesh_.triangle_count() + 2 * front.points.size());
  }

  WorkingMesh run(const std::vector<Curve>& curves, const RunContext& context) {
    for (std::uint32_t c = 0; c < curves.size(); ++c) insert_curve(c, curves[c]);
    for (std::uint32_t i = 0; i < front_.points.size(); ++i) {
      if (i % 1024 == 0) context.check();
      if (!front_.points[i].on_feature) insert_point(i);
    }
    return std::move(mesh_);
  }

 private:
  /// Division points in the order of the curve: each splits what is left of its half-edge.
  void insert_curve(std::uint32_t number, const Curve& curve) {
    const std::vector<std::uint32_t>& ids = front_.curve_points[number];
    VertexIndex previous = kNone;
    HalfEdge on = kNone;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const FrontPoint& point = front_.points[ids[i]];
      const bool is_end = (i == 0 || i + 1 == ids.size()) && !curve.closed;
      if (point.vertex != kNone) {
        adopt(ids[i], point.vertex, is_end ? VertexKind::kCorner : VertexKind::kCurve);
        mesh_.place[point.vertex] = {number, curve.samples[i].along};
        continue;
      }
      if (vertex_of_point_[ids[i]] != kNone) continue;
      const HalfEdge along = curve.samples[i].half_edge;
      const VertexIndex from = along == on ? previous : input_.mesh.start[along];
      const HalfEdge h = rest_of(along, from);
      const VertexIndex x = mesh_.add_vertex(point.p, VertexKind::kCurve, {}, point.h, point.face);
      mesh_.split_edge(h, x);
      mesh_.place[x] = {number, curve.samples[i].along};
      vertex_of_point_[ids[i]] = x;
      previous = x;
      on = along;
      ++counts_.inserted;
    }
  }

  /// What is left of a half-edge of the input from a vertex on it to its end. Beside a slit another edge has the same
  /// ends: that of the same face is meant.
  HalfEdge rest_of(HalfEdge along, VertexIndex from) const {
    HalfEdge rest = kNone;
    mesh_.for_each_outgoing(from, [&](HalfEdge h) {
      if (mesh_.end(h) == input_.mesh.end(along) && mesh_.origin[h / 3] == along / 3) rest = h;
    });
    return rest;
  }

  void adopt(std::uint32_t id, VertexIndex v, VertexKind kind) {
    vertex_of_point_[id] = v;
    if (mesh_.kind[v] != VertexKind::kCorner) mesh_.kind[v] = kind;
    mesh_.size[v] = front_.points[id].h;
    ++counts_.adopted;
  }

  void insert_point(std::uint32_t id) {
    const FrontPoint& point = front_.points[id];
    const Plane2d plane(input_.face_normal[point.face]);
    const std::uint32_t t = locate(point, plane);
    if (snap_to_vertex(id, t)) return;
    int on_edge = -1;
    for (int i = 0; i < 3; ++i) {
      const HalfEdge h = 3 * t + i;
      const Vec3 a = mesh_.points[mesh_.start[h]], b = mesh_.points[mesh_.end(h)];
      const bool is_border = mesh_.origin[mesh_.twin[h] / 3] != point.face;
      if (plane.height(a, b, point.p) < kSnapToEdge * point.h && is_border) on_edge = i;
      if (on_edge < 0 && plane.side(a, b, point.p) <= 0) on_edge = i;
    }
    if (on_edge < 0) {
      const VertexIndex x = mesh_.add_vertex(point.p, VertexKind::kFree, point.normal, point.h, point.face);
      mesh_.split_triangle(t, x);
      finish(id, x);
      return;
    }
    put_on_edge(id, 3 * t + on_edge);
  }

  void put_on_edge(std::uint32_t id, HalfEdge h) {
    const FrontPoint& point = front_.points[id];
    const Vec3 a = mesh_.points[mesh_.start[h]], b = mesh_.points[mesh_.end(h)];
    const double s = dot(point.p - a, b - a) / squared_length(b - a);
    if (mesh_.is_feature[h] || !(s > 0 && s < 1)) {
      ++counts_.skipped;
      return;
    }
    const VertexIndex x = mesh_.add_vertex(a + (b - a) * s, VertexKind::kFree, point.normal, point.h, point.face);
    mesh_.split_edge(h, x);
    finish(id, x);
  }

  bool snap_to_vertex(std::uint32_t id, std::uint32_t t) {
    const FrontPoint& point = front_.points[id];
    for (int i = 0; i < 3; ++i) {
      const VertexIndex v = mesh_.start[3 * t + i];
      if (distance(mesh_.points[v], point.p) > kSnapInSizes * point.h) continue;
      if (mesh_.kind[v] == VertexKind::kRemovable) {
        adopt(id, v, VertexKind::kFree);
      } else {
        ++counts_.skipped;
      }
      return true;
    }
    return false;
  }

  void finish(std::uint32_t id, VertexIndex x) {
    vertex_of_point_[id] = x;
    last_[mesh_.origin[mesh_.outgoing[x] / 3]] = mesh_.outgoing[x] / 3;
    ++counts_.inserted;
    legalize(x);
  }

  /// A triangle to begin the search from: beside the point's parent if that lies in the same face.
  std::uint32_t hint(const FrontPoint& point) const {
    std::uint32_t t = last_[point.face];
    const VertexIndex parent = point.parent == kNone ? kNone : vertex_of_point_[point.parent];
    if (parent == kNone) return t;
    mesh_.for_each_outgoing(parent, [&](HalfEdge h) {
      if (mesh_.origin[h / 3] == point.face) t = h / 3;
    });
    return t;
  }

  /// The part of the point's input face that holds it.
  std::uint32_t locate(const FrontPoint& point, const Plane2d& plane) const {
    std::uint32_t t = hint(point);
    // The parts of a face are a Delaunay triangulation but for rounding: the walk ends.
    for (std::size_t step = 0; step < kMostSteps; ++step) {
      bool moved = false;
      for (int i = 0; i < 3 && !moved; ++i) {
        const HalfEdge h = 3 * t + (i + step) % 3;
        const std::uint32_t across = mesh_.twin[h] / 3;
        if (mesh_.origin[across] != point.face) continue;
        if (plane.side(mesh_.points[mesh_.start[h]], mesh_.points[mesh_.end(h)], point.p) >= 0) continue;
        t = across;
        moved = true;
      }
      if (!moved) break;
    }
    return t;
  }

  /// Lawson flips around x among the parts of one input face: in its plane, decided exactly.
  void legalize(VertexIndex x) {
    stack_.clear();
    mesh_.for_each_outgoing(x, [&](HalfEdge h) { stack_.push_back(next_of(h)); });
    for (int flips = 0; !stack_.empty() && flips < kMostFlips;) {
      const HalfEdge h = stack_.back(), g = mesh_.twin[h];
      stack_.pop_back();
      const std::uint32_t face = mesh_.origin[h / 3];
      if (mesh_.origin[g / 3] != face || mesh_.is_feature[h] || is_delaunay(mesh_, h)) continue;
      const Vec3 a = mesh_.points[mesh_.start[h]], b = mesh_.points[mesh_.start[g]];
      const Vec3 c = mesh_.points[mesh_.apex(h)], d = mesh_.points[mesh_.apex(g)];
      const Plane2d plane(input_.face_normal[face]);
      if (plane.side(a, d, c) <= 0 || plane.side(b, c, d) <= 0 || !mesh_.may_flip(h)) continue;
      ++flips;
      const HalfEdge turned = mesh_.flip(h), other = mesh_.twin[turned];
      stack_.insert(stack_.end(), {next_of(turned), previous_of(turned), next_of(other), previous_of(other)});
    }
  }

  const InputSurface& input_;
  const FrontPoints& front_;
  InsertionCounts& counts_;
  WorkingMesh mesh_;
  std::vector<std::uint32_t> last_;           ///< per input face: a part of it
  std::vector<VertexIndex> vertex_of_point_;  ///< per point of the front
  std::vector<HalfEdge> stack_;
};

}  // namespace

WorkingMesh insert_points(const InputSurface& input, const std::vector<Curve>& curves, const FrontPoints& front,
                          const RunContext& context, InsertionCounts& counts) {
  return Inserter(input, front, counts).run(curves, context);
}

}  // namespace octafront::surface
