#include <octafront/error.h>

#include "base/geometry/exact_point.h"
#include "soup/periods/matched.h"
#include "soup/periods/periods.h"
#include "soup/periods/rebuilt.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using periods::CommonDivision;
using periods::FaceKind;
using periods::FaceParts;
using periods::Rebuilt;

/// A new vertex on the edge between two faces comes to the others with the next round.
constexpr int kMostRounds = 4;

class PeriodMaker {
 public:
  PeriodMaker(SurfaceMesh& surface, const std::array<bool, 3>& along, const RunContext& context)
      : surface_(surface), context_(context), tolerance_(kSamePlace * bounding_box(surface.points).diagonal()) {
    made_.cell = cell_of(bounding_box(surface.points), along);
    made_.origin.resize(surface.triangles.size());
    for (std::uint32_t t = 0; t < made_.origin.size(); ++t) made_.origin[t] = t;
    periods::fill_in(surface);
  }

  MadePeriodic run() {
    put_on_faces();
    for (int round = 0; round < kMostRounds; ++round) {
      bool changed = false;
      for (int axis = 0; axis < 3; ++axis)
        if (made_.cell.along[axis]) changed = match(axis) || changed;
      if (!changed) break;
    }
    periods::name_faces(surface_, cell());
    return std::move(made_);
  }

 private:
  const PeriodicCell& cell() const { return made_.cell; }

  void move(Vec3& p, Vec3 to) {
    if (p == to) return;
    ++made_.moved;
    made_.largest_move = std::max(made_.largest_move, distance(p, to));
    p = to;
  }

  /// What nearly lies on a periodic face lies on it.
  void put_on_faces() {
    for (Vec3& p : surface_.points) {
      Vec3 to = p;
      for (int axis = 0; axis < 3; ++axis) {
        if (!cell().along[axis]) continue;
        if (std::abs(p[axis] - cell().box.lo[axis]) <= tolerance_) to[axis] = cell().box.lo[axis];
        if (std::abs(p[axis] - cell().box.hi[axis]) <= tolerance_) to[axis] = cell().box.hi[axis];
      }
      move(p, to);
    }
  }

  /// Makes the two faces of the axis the same. Returns whether something changed.
  bool match(int axis) {
    context_.check();
    const CellFace low = 2 * static_cast<CellFace>(axis);
    std::array faces{periods::parts_of_face(surface_, cell(), low), periods::parts_of_face(surface_, cell(), low + 1)};
    for (CellFace k = 0; k < 2; ++k)
      if (faces[k].triangles.empty())
        throw InputError(fmt::format(
            "the body has no flat face at {} = {:.9g}, the {} end of its bounding box, so it is no cell that is "
            "periodic along {}. Give bodies that cross the faces of the cell as bodies of their own, with `box`",
            kAxisNames[axis], (k == 0 ? cell().box.lo : cell().box.hi)[axis], k == 0 ? "low" : "high",
            kAxisNames[axis]));
    bring_to_copies(axis, faces);
    if (are_same(axis, faces)) return false;
    const CommonDivision common = periods::divide_alike(surface_, cell(), axis, faces, tolerance_);
    put_in(axis, faces, common);
    return true;
  }

  /// Vertices of lines on the high face that nearly have a copy on the low one get its coordinates.
  void bring_to_copies(int axis, const std::array<FaceParts, 2>& faces) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<std::vector<VertexIndex>, 2> ends;
    for (int k = 0; k < 2; ++k) {
      for (const auto& [edge, part] : faces[k].lines) ends[k].insert(ends[k].end(), edge.begin(), edge.end());
      ends[k].insert(ends[k].end(), faces[k].touched.begin(), faces[k].touched.end());
      std::sort(ends[k].begin(), ends[k].end(), [&](VertexIndex a, VertexIndex b) {
        const Vec3 p = surface_.points[a], q = surface_.points[b];
        return std::array{p[u], p[v]} < std::array{q[u], q[v]};
      });
    }
    for (const VertexIndex b : ends[1]) {
      Vec3& p = surface_.points[b];
      auto at = std::lower_bound(ends[0].begin(), ends[0].end(), p[u] - tolerance_,
                                 [&](VertexIndex a, double x) { return surface_.points[a][u] < x; });
      double nearest = tolerance_;
      Vec3 to = p;
      for (; at != ends[0].end() && surface_.points[*at][u] <= p[u] + tolerance_; ++at) {
        Vec3 q = surface_.points[*at];
        q[axis] = p[axis];
        if (distance(p, q) < nearest) nearest = distance(p, q), to = q;
      }
      move(p, to);
    }
  }

  std::array<Vec3, 3> corners_seen_low(std::uint32_t t, int axis) const {
    std::array<Vec3, 3> p{};
    for (int i = 0; i < 3; ++i) {
      p[i] = surface_.points[surface_.triangles[t][i]];
      p[i][axis] = cell().box.lo[axis];
    }
    std::sort(p.begin(), p.end(), [](Vec3 a, Vec3 b) { return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z}; });
    return p;
  }

  bool are_same(int axis, const std::array<FaceParts, 2>& faces) const {
    std::array<std::vector<std::array<Vec3, 3>>, 2> seen;
    for (int k = 0; k < 2; ++k) {
      for (const std::uint32_t t : faces[k].triangles) seen[k].push_back(corners_seen_low(t, axis));
      std::sort(seen[k].begin(), seen[k].end(), [](const auto& s, const auto& t) {
        for (int i = 0; i < 3; ++i)
          if (s[i] != t[i]) return std::array{s[i].x, s[i].y, s[i].z} < std::array{t[i].x, t[i].y, t[i].z};
        return false;
      });
    }
    return seen[0] == seen[1];
  }

  FaceKind kind_of(std::uint32_t t) const { return {surface_.patch[t], surface_.sides[t], made_.origin[t], kNone}; }

  void put_in(int axis, const std::array<FaceParts, 2>& faces, const CommonDivision& common) {
    std::array<std::vector<VertexIndex>, 2> vertex;
    for (int k = 0; k < 2; ++k) vertex[k] = vertices_of_nodes(axis, k, faces[k], common);
    std::map<Edge, std::vector<VertexIndex>> between;
    for (int k = 0; k < 2; ++k)
      for (const auto& [edge, nodes] : common.between[k])
        for (const std::uint32_t n : nodes) between[edge].push_back(vertex[k][n]);
    Rebuilt to;
    std::vector<std::uint8_t> on_face(surface_.triangles.size(), 0);
    for (const FaceParts& face : faces)
      for (const std::uint32_t t : face.triangles) on_face[t] = 1;
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t)
      if (!on_face[t]) periods::add_divided(surface_.triangles[t], kind_of(t), between, to);
    for (int k = 0; k < 2; ++k) add_pieces(axis, k, faces[k], common, vertex[k], to);
    made_.imprinted += 2 * common.pieces.size();
    take(std::move(to));
  }

  /// Vertices of the surface where the nodes are on this face, new ones where there is none.
  std::vector<VertexIndex> vertices_of_nodes(int axis, int k, const FaceParts& face, const CommonDivision& common) {
    VerticesByPlace known;
    for (const auto& [edge, part] : face.lines)
      for (const VertexIndex v : edge) known.add(surface_.points[v], v);
    for (const VertexIndex v : face.touched) known.add(surface_.points[v], v);
    std::vector<VertexIndex> vertex;
    for (Vec3 p : common.nodes) {
      p[axis] = (k == 0 ? cell().box.lo : cell().box.hi)[axis];
      VertexIndex v = known.find(p);
      if (v == kNone) {
        v = static_cast<VertexIndex>(surface_.points.size());
        surface_.points.push_back(p);
        known.add(p, v);
      }
      vertex.push_back(v);
    }
    return vertex;
  }

  void add_pieces(int axis, int k, const FaceParts& face, const CommonDivision& common,
                  const std::vector<VertexIndex>& vertex, Rebuilt& to) const {
    for (const periods::CommonPiece& piece : common.pieces) {
      const std::uint32_t model = face.first[piece.part[k]];
      Triangle t{vertex[piece.nodes[0]], vertex[piece.nodes[1]], vertex[piece.nodes[2]]};
      if (turn(surface_.triangles[model], axis) < 0) std::swap(t[1], t[2]);
      to.add(t, kind_of(model));
    }
  }

  int turn(const Triangle& t, int axis) const {
    return arrangement::orient_along(axis, {surface_.points[t[0]]}, {surface_.points[t[1]]}, {surface_.points[t[2]]});
  }

  void take(Rebuilt rebuilt) {
    made_.origin.clear();
    for (const FaceKind& kind : rebuilt.kinds) made_.origin.push_back(kind.origin);
    periods::take(std::move(rebuilt), surface_);
  }

  SurfaceMesh& surface_;
  const RunContext& context_;
  const double tolerance_;
  MadePeriodic made_;
};

}  // namespace

MadePeriodic make_periodic(SurfaceMesh& surface, const std::array<bool, 3>& along, const RunContext& context) {
  return periods::made_of(surface, [&] { return PeriodMaker(surface, along, context).run(); });
}

}  // namespace octafront
