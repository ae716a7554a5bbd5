#include "surface/edits/local_guards.h"

#include <atomic>
#include <utility>

namespace octafront::surface {

namespace {

/// Relative slack of the Delaunay test: four points on a circle do not flip to and fro.
constexpr double kDelaunaySlack = 1e-9;
/// Flips in space need not end as those in a plane do: this many per half-edge of the start at most, on average. In a
/// plane they end, but the fans on both sides of a long edge take the product of their numbers: so many count as one.
constexpr std::uint64_t kFlipsPerEdge = 20, kFlatFlips = 100;
/// Sine of the angle up to which two triangles lie in one plane: that of rounding, also where they are needles.
constexpr double kFlatSine = 1e-6;

constexpr double kHuge = 1e300;

double cotangent_at(Vec3 apex, Vec3 a, Vec3 b) {
  const Vec3 u = a - apex, v = b - apex;
  const double area = length(cross(u, v)), cosine = dot(u, v);
  if (area > 0) return cosine / area;
  return cosine < 0 ? -kHuge : kHuge;
}

}  // namespace

bool faces_outward(const WorkingMesh& mesh, Vec3 area_vector, const VertexIndex (&vertices)[3], double cosine) {
  const double bound = cosine * length(area_vector);
  for (const VertexIndex v : vertices) {
    if (mesh.has_normal(v) && !(dot(area_vector, mesh.normal[v]) > bound)) return false;
  }
  return true;
}

bool is_delaunay(const WorkingMesh& mesh, HalfEdge h) {
  const Vec3 a = mesh.points[mesh.start[h]], b = mesh.points[mesh.end(h)];
  const Vec3 at_c = mesh.points[mesh.apex(h)], at_d = mesh.points[mesh.apex(mesh.twin[h])];
  // Nearly always neither angle is obtuse: no need of roots.
  if (dot(a - at_c, b - at_c) >= 0 && dot(a - at_d, b - at_d) >= 0) return true;
  const double c = cotangent_at(at_c, a, b), d = cotangent_at(at_d, a, b);
  return c + d >= -kDelaunaySlack * (1 + std::abs(c) + std::abs(d));
}

bool flip_is_sound(const WorkingMesh& mesh, HalfEdge h, const TurnLimits& limits) {
  const HalfEdge g = mesh.twin[h];
  const VertexIndex a = mesh.start[h], b = mesh.start[g], c = mesh.apex(h), d = mesh.apex(g);
  const Vec3 pa = mesh.points[a], pb = mesh.points[b], pc = mesh.points[c], pd = mesh.points[d];
  const Vec3 adc = cross(pd - pa, pc - pa), bcd = cross(pc - pb, pd - pb), star = adc + bcd;
  return turns_little(adc, star, limits.star) && turns_little(bcd, star, limits.star) &&
         faces_outward(mesh, adc, {a, d, c}, limits.surface) && faces_outward(mesh, bcd, {b, c, d}, limits.surface);
}

namespace {

/// Whether the two triangles beside an edge lie in one plane.
bool is_flat(const WorkingMesh& mesh, HalfEdge h) {
  const Vec3 a = mesh.points[mesh.start[h]], b = mesh.points[mesh.end(h)];
  const Vec3 u = cross(b - a, mesh.points[mesh.apex(h)] - a),
             v = cross(mesh.points[mesh.apex(mesh.twin[h])] - a, b - a);
  return dot(u, v) > 0 && length(cross(u, v)) <= kFlatSine * dot(u, v);
}

/// may_try(h): whether this edge and the two triangles beside it may be looked at.
template <class MayTry>
std::uint64_t flip_all(WorkingMesh& mesh, std::vector<HalfEdge>& edges, const TurnLimits& limits,
                       const MayTry& may_try) {
  std::uint64_t flips = 0, spent = 0;
  const std::uint64_t budget = kFlatFlips * kFlipsPerEdge * (edges.size() + 10);
  while (!edges.empty() && spent < budget) {
    const HalfEdge h = edges.back();
    edges.pop_back();
    if (mesh.start[h] == kNone || !may_try(h) || mesh.is_feature[h] || is_delaunay(mesh, h)) continue;
    if (!flip_is_sound(mesh, h, limits) || !mesh.may_flip(h)) continue;
    spent += is_flat(mesh, h) ? 1 : kFlatFlips;
    const HalfEdge turned = mesh.flip(h), other = mesh.twin[turned];
    ++flips;
    edges.insert(edges.end(), {next_of(turned), previous_of(turned), next_of(other), previous_of(other)});
  }
  edges.clear();
  return flips;
}

}  // namespace

std::uint64_t make_delaunay(WorkingMesh& mesh, std::vector<HalfEdge>& edges, const TurnLimits& limits) {
  return flip_all(mesh, edges, limits, [](HalfEdge) { return true; });
}

std::uint64_t make_delaunay(WorkingMesh& mesh, const SurfaceBlocks& blocks, std::vector<HalfEdge> edges,
                            const TurnLimits& limits) {
  std::atomic<std::uint64_t> flips = 0;
  blocks.run(
      std::move(edges), [&](HalfEdge h) { return mesh.start[h]; },
      [&](const SurfaceBlocks::Block& block, std::span<const HalfEdge> of_block, std::vector<HalfEdge>& left) {
        std::vector<HalfEdge> stack(of_block.begin(), of_block.end());
        flips += flip_all(mesh, stack, limits, [&](HalfEdge h) {
          if (block.has_both(h)) return true;
          left.push_back(h);
          return false;
        });
      });
  return flips;
}

}  // namespace octafront::surface
