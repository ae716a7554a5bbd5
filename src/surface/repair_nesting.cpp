#include "geometry/predicates.h"
#include "surface/repair_steps.h"

#include <algorithm>
#include <array>
#include <optional>

namespace octafront::repair {
namespace {

/// Side of p, moved by an infinitesimal (e, e^2) in the yz-plane, to the line from a to b there; 0 only if a and b
/// coincide in that plane.
int side_in_yz(Vec3 a, Vec3 b, Vec3 p) {
  const int s = orient2d(a.y, a.z, b.y, b.z, p.y, p.z);
  if (s != 0) return s;
  if (a.z != b.z) return a.z > b.z ? 1 : -1;
  return detail::sign(b.y - a.y);
}

/// Whether the ray from p along +x meets the triangle; nullopt if p lies on it.
std::optional<bool> ray_meets(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const int ab = side_in_yz(a, b, p), bc = side_in_yz(b, c, p), ca = side_in_yz(c, a, p);
  if (ab == 0 || ab != bc || bc != ca) return false;
  const int side = orient3d(a, b, c, p);
  if (side == 0) return std::nullopt;
  // Seen along +x, a triangle that runs counter-clockwise in the yz-plane has its normal toward +x.
  return side == -ab;
}

/// The closed pieces as lists of triangles, with their boxes and outermost vertices.
struct Hull {
  Box3 box;
  std::array<VertexIndex, 6> outermost{};  // least and greatest in x, y, z
  std::vector<std::uint32_t> triangles;
};

std::vector<Hull> make_hulls(const SurfaceMesh& mesh, const Pieces& pieces, const std::vector<char>& closed) {
  std::vector<Hull> hulls(pieces.count());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t piece = pieces.piece_of_triangle[t];
    if (!closed[piece]) continue;
    Hull& hull = hulls[piece];
    for (const VertexIndex v : mesh.triangles[t]) {
      const Vec3 p = mesh.points[v];
      if (hull.box.empty()) hull.outermost.fill(v);
      for (int axis = 0; axis < 3; ++axis) {
        if (p[axis] < mesh.points[hull.outermost[2 * axis]][axis]) hull.outermost[2 * axis] = v;
        if (p[axis] > mesh.points[hull.outermost[2 * axis + 1]][axis]) hull.outermost[2 * axis + 1] = v;
      }
      hull.box.add(p);
    }
    hull.triangles.push_back(t);
  }
  return hulls;
}

std::optional<bool> is_inside(const SurfaceMesh& mesh, const Hull& hull, Vec3 p) {
  bool inside = false;
  for (const std::uint32_t t : hull.triangles) {
    const auto [i, j, k] = mesh.triangles[t];
    const Vec3 a = mesh.points[i], b = mesh.points[j], c = mesh.points[k];
    if (std::max({a.x, b.x, c.x}) < p.x || std::max({a.y, b.y, c.y}) < p.y || std::min({a.y, b.y, c.y}) > p.y ||
        std::max({a.z, b.z, c.z}) < p.z || std::min({a.z, b.z, c.z}) > p.z)
      continue;
    const std::optional<bool> meets = ray_meets(p, a, b, c);
    if (!meets) return std::nullopt;
    inside ^= *meets;
  }
  return inside;
}

/// All outermost vertices of `inner` that do not lie on `outer` lie inside it. (One would do for pieces that do not
/// intersect; pieces that do should not be taken for cavities.)
bool encloses(const SurfaceMesh& mesh, const Hull& outer, const Hull& inner) {
  if (!outer.box.contains(inner.box.lo) || !outer.box.contains(inner.box.hi)) return false;
  bool any = false;
  for (const VertexIndex v : inner.outermost) {
    const std::optional<bool> inside = is_inside(mesh, outer, mesh.points[v]);
    if (!inside) continue;
    if (!*inside) return false;
    any = true;
  }
  return any;
}

}  // namespace

Nesting find_nesting(const SurfaceMesh& mesh, const Pieces& pieces, const std::vector<char>& closed) {
  const std::vector<Hull> hulls = make_hulls(mesh, pieces, closed);
  Nesting nesting;
  nesting.depth.assign(hulls.size(), 0);
  nesting.parent.assign(hulls.size(), kNone);
  std::vector<std::vector<std::uint32_t>> around(hulls.size());
  for (std::uint32_t inner = 0; inner < hulls.size(); ++inner) {
    if (hulls[inner].triangles.empty()) continue;
    for (std::uint32_t outer = 0; outer < hulls.size(); ++outer)
      if (outer != inner && !hulls[outer].triangles.empty() && encloses(mesh, hulls[outer], hulls[inner]))
        around[inner].push_back(outer);
    nesting.depth[inner] = static_cast<std::uint32_t>(around[inner].size());
  }
  for (std::uint32_t inner = 0; inner < hulls.size(); ++inner)
    for (const std::uint32_t outer : around[inner])
      if (nesting.parent[inner] == kNone || nesting.depth[outer] > nesting.depth[nesting.parent[inner]])
        nesting.parent[inner] = outer;
  return nesting;
}

}  // namespace octafront::repair
