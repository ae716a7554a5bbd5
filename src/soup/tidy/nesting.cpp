#include "base/geometry/predicates.h"
#include "base/geometry/triangle_tree.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <array>

namespace octafront::tidy {
namespace {

/// Side of p, moved by an infinitesimal (e, e^2) in the yz-plane, to the line from a to b there; 0 only if a and b
/// coincide in that plane.
int side_in_yz(Vec3 a, Vec3 b, Vec3 p) {
  const int s = orient2d(a.y, a.z, b.y, b.z, p.y, p.z);
  if (s != 0) return s;
  if (a.z != b.z) return a.z > b.z ? 1 : -1;
  return detail::sign(b.y - a.y);
}

enum class Crossing { kNone, kYes, kOnTriangle };

/// Whether the ray from p along +x crosses the triangle. Moved by the infinitesimal it meets no edge, so that a ray
/// through an edge or a vertex crosses as often as one beside it.
Crossing cross_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const int ab = side_in_yz(a, b, p), bc = side_in_yz(b, c, p), ca = side_in_yz(c, a, p);
  if (ab == 0 || ab != bc || bc != ca) return Crossing::kNone;
  const int side = orient3d(a, b, c, p);
  if (side == 0) return Crossing::kOnTriangle;
  // A triangle that runs counter-clockwise in the yz-plane has its normal toward +x: p is before it on its back.
  return side == -ab ? Crossing::kYes : Crossing::kNone;
}

/// Least and greatest vertex of a piece in x, y and z.
struct Extremes {
  std::array<VertexIndex, 6> vertex;
  bool empty = true;

  void add(const std::vector<Vec3>& points, VertexIndex v) {
    if (empty) vertex.fill(v);
    empty = false;
    for (int axis = 0; axis < 3; ++axis) {
      if (points[v][axis] < points[vertex[2 * axis]][axis]) vertex[2 * axis] = v;
      if (points[v][axis] > points[vertex[2 * axis + 1]][axis]) vertex[2 * axis + 1] = v;
    }
  }
};

/// Finds the closed pieces around a piece, all in one search of the tree for each of its extreme vertices. (One vertex
/// would do for pieces that do not intersect; those that do should not be taken for cavities.)
class NestingSearch {
 public:
  NestingSearch(const SurfaceMesh& mesh, const Pieces& pieces, const std::vector<char>& closed)
      : mesh_(mesh),
        pieces_(pieces),
        closed_triangles_(keep_closed(mesh, pieces, closed)),
        tree_(mesh.points, closed_mesh_),
        tally_(pieces.count()) {}

  std::vector<std::uint32_t> pieces_around(std::uint32_t inner, const Extremes& extremes) {
    touched_.clear();
    for (const VertexIndex v : extremes.vertex) {
      probe(inner, mesh_.points[v]);
      if (touched_.empty()) return {};  // what is not around the first vertex is not around the piece
    }
    std::vector<std::uint32_t> around;
    for (const std::uint32_t piece : touched_) {
      const Tally& tally = tally_[piece];
      if (tally.inside > 0 && tally.inside + tally.on == extremes.vertex.size()) around.push_back(piece);
      tally_[piece] = {};
    }
    std::sort(around.begin(), around.end());
    return around;
  }

 private:
  struct Tally {
    std::uint32_t inside = 0, on = 0;
    bool odd = false, on_now = false, seen_now = false, touched = false;
  };

  std::vector<std::uint32_t> keep_closed(const SurfaceMesh& mesh, const Pieces& pieces,
                                         const std::vector<char>& closed) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!closed[pieces.piece_of_triangle[t]]) continue;
      kept.push_back(t);
      closed_mesh_.push_back(mesh.triangles[t]);
    }
    return kept;
  }

  void probe(std::uint32_t inner, Vec3 p) {
    seen_.clear();
    Box3 ray;
    ray.add(p);
    ray.add(Vec3{std::max(p.x, tree_.box().hi.x), p.y, p.z});
    tree_.for_each_overlapping(ray, [&](std::uint32_t k) {
      const std::uint32_t piece = pieces_.piece_of_triangle[closed_triangles_[k]];
      if (piece == inner) return;
      const auto [a, b, c] = closed_mesh_[k];
      const Crossing crossing = cross_triangle(p, mesh_.points[a], mesh_.points[b], mesh_.points[c]);
      if (crossing == Crossing::kNone) return;
      Tally& tally = tally_[piece];
      if (!tally.seen_now) seen_.push_back(piece);
      tally.seen_now = true;
      tally.on_now |= crossing == Crossing::kOnTriangle;
      tally.odd ^= crossing == Crossing::kYes;
    });
    for (const std::uint32_t piece : seen_) {
      Tally& tally = tally_[piece];
      if (!tally.touched) touched_.push_back(piece);
      tally.touched = true;
      if (tally.on_now)
        ++tally.on;
      else if (tally.odd)
        ++tally.inside;
      tally.odd = tally.on_now = tally.seen_now = false;
    }
  }

  const SurfaceMesh& mesh_;
  const Pieces& pieces_;
  std::vector<Triangle> closed_mesh_;
  std::vector<std::uint32_t> closed_triangles_;  // per triangle of closed_mesh_: the triangle of the mesh
  TriangleTree tree_;
  std::vector<Tally> tally_;  // per piece
  std::vector<std::uint32_t> touched_, seen_;
};

std::vector<Extremes> find_extremes(const SurfaceMesh& mesh, const Pieces& pieces, const std::vector<char>& closed) {
  std::vector<Extremes> extremes(pieces.count());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t piece = pieces.piece_of_triangle[t];
    if (!closed[piece]) continue;
    for (const VertexIndex v : mesh.triangles[t]) extremes[piece].add(mesh.points, v);
  }
  return extremes;
}

}  // namespace

Nesting find_nesting(const SurfaceMesh& mesh, const Pieces& pieces, const std::vector<char>& closed,
                     const RunContext& context) {
  Nesting nesting;
  nesting.depth.assign(pieces.count(), 0);
  nesting.parent.assign(pieces.count(), kNone);
  if (std::count(closed.begin(), closed.end(), 1) < 2) return nesting;

  const std::vector<Extremes> extremes = find_extremes(mesh, pieces, closed);
  NestingSearch search(mesh, pieces, closed);
  std::vector<std::vector<std::uint32_t>> around(pieces.count());
  for (std::uint32_t inner = 0; inner < pieces.count(); ++inner) {
    context.check();
    if (!closed[inner]) continue;
    around[inner] = search.pieces_around(inner, extremes[inner]);
    nesting.depth[inner] = static_cast<std::uint32_t>(around[inner].size());
  }
  for (std::uint32_t inner = 0; inner < pieces.count(); ++inner)
    for (const std::uint32_t outer : around[inner])
      if (nesting.parent[inner] == kNone || nesting.depth[outer] > nesting.depth[nesting.parent[inner]])
        nesting.parent[inner] = outer;
  return nesting;
}

}  // namespace octafront::tidy
