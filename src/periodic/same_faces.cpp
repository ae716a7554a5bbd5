#include <octafront/error.h>

#include "base/geometry/exact_point.h"
#include "periodic/face_maker.h"
#include "periodic/make_periodic.h"
#include "periodic/matched.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using periods::CommonDivision;
using periods::FaceMaker;
using periods::FaceParts;
using periods::Rebuilt;
using periods::VerticesAlong;

/// A new vertex on the edge between two faces comes to the others with the next round.
constexpr int kMostRounds = 4;

class PeriodMaker : FaceMaker {
 public:
  PeriodMaker(SurfaceMesh& surface, const std::array<bool, 3>& along, const RunContext& context)
      : FaceMaker(surface, context) {
    made_.cell = cell_of(bounding_box(surface.points), along);
  }

  MadePeriodic run() {
    const Vec3 within{tolerance_, tolerance_, tolerance_};
    for (Vec3& p : surface_.points) move(p, put_on_faces(p, cell().box, cell().along, within));
    for (int round = 0; round < kMostRounds; ++round) {
      bool changed = false;
      for (const int axis : cell().periods_there()) changed = match(axis) || changed;
      if (!changed) break;
    }
    return made();
  }

 private:
  FaceParts parts_of(int axis, int end) const {
    const auto is_on = [&](VertexIndex v) {
      return end == 0 ? cell().is_low(surface_.points[v], axis) : cell().is_high(surface_.points[v], axis);
    };
    return periods::parts_of_face(
        surface_, [&](std::uint32_t t) { return std::ranges::all_of(surface_.triangles[t], is_on); }, is_on);
  }

  /// Makes the two faces of the axis the same. Returns whether something changed.
  bool match(int axis) {
    context_.check();
    const std::array faces{parts_of(axis, 0), parts_of(axis, 1)};
    for (CellFace k = 0; k < 2; ++k)
      if (faces[k].triangles.empty())
        throw InputError(fmt::format(
            "the body has no flat face at {} = {:.9g}, the {} end of its bounding box, so it is no cell that is "
            "periodic along {}. Give bodies that cross the faces of the cell as bodies of their own, with `box`",
            kAxisNames[axis], (k == 0 ? cell().box.lo : cell().box.hi)[axis], k == 0 ? "low" : "high",
            kAxisNames[axis]));
    bring_to_copies(axis, faces);
    if (are_same(axis, faces[0].triangles, faces[1].triangles)) return false;
    const CommonDivision common = periods::divide_alike(surface_, cell(), axis, faces, tolerance_);
    put_in(axis, faces, common);
    return true;
  }

  /// Vertices of lines on the high face that nearly have a copy on the low one get its coordinates.
  void bring_to_copies(int axis, const std::array<FaceParts, 2>& faces) {
    const auto ends_of = [](const FaceParts& face) {
      std::vector<VertexIndex> ends = face.touched;
      for (const auto& [edge, part] : face.lines) ends.insert(ends.end(), edge.begin(), edge.end());
      return ends;
    };
    const VerticesAlong low(surface_.points, ends_of(faces[0]), (axis + 1) % 3);
    for (const VertexIndex b : ends_of(faces[1])) {
      Vec3& p = surface_.points[b];
      if (const VertexIndex near = low.nearest(cell().to_low(p, axis), tolerance_); near != kNone)
        move(p, cell().to_high(surface_.points[near], axis));
    }
  }

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
};

}  // namespace

MadePeriodic make_periodic(SurfaceMesh& surface, const std::array<bool, 3>& along, const RunContext& context) {
  return PeriodMaker(surface, along, context).run();
}

}  // namespace octafront
