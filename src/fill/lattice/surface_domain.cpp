#include <octafront/surface_mesh.h>

#include "fill/lattice/implicit_domain.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace octafront {

namespace {

/// The part of the segment pq at which it meets the plane of a triangle.
double meeting_part(Vec3 p, Vec3 q, const TriangleCorners& t) {
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const double at_p = dot(n, p - t[0]), at_q = dot(n, q - t[0]);
  return at_p == at_q ? 0.5 : std::clamp(at_p / (at_p - at_q), 0.0, 1.0);
}

constexpr int kBisections = 24;

}  // namespace

SurfaceDomain::SurfaceDomain(const SurfaceMesh& surface, Defects defects)
    : defects_(defects), triangles_(surface), winding_(defects == Defects::kClean ? SurfaceMesh{} : surface) {}

int SurfaceDomain::side(Vec3 p) const {
  if (defects_ != Defects::kClean) return std::abs(winding_.at(p)) > 0.5 ? 1 : -1;
  const TriangleTree::Location location = triangles_.locate(p);
  if (location == TriangleTree::Location::kOnSurface) return 0;
  return location == TriangleTree::Location::kInside ? 1 : -1;
}

double SurfaceDomain::bisect(Vec3 inside, Vec3 outside, double from, double to) const {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (from + to);
    (side(inside + (outside - inside) * middle) >= 0 ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

double SurfaceDomain::crossing(Vec3 inside, Vec3 outside) const {
  std::vector<double> hits;
  triangles_.for_each_hit(inside, outside, [&](std::uint32_t triangle, const SegmentHit& hit) {
    if (hit.kind == SegmentHit::Kind::kPoint)
      hits.push_back(meeting_part(inside, outside, triangles_.corners(triangle)));
  });
  if (hits.size() == 1 && !has_holes()) return hits[0];
  std::sort(hits.begin(), hits.end());
  // The first piece between hits that lies outside ends the body: at the hit before it, or, where the surface has a
  // hole, somewhere within the last piece that begins inside.
  const Vec3 along = outside - inside;
  double before = 0;
  for (const double hit : hits) {
    if (hit > before && side(inside + along * (0.5 * (before + hit))) < 0) break;
    before = hit;
  }
  if (before > 0 && side(inside + along * (0.5 * (before + 1))) < 0) return before;
  return before > 0 && !has_holes() ? before : bisect(inside, outside, 0, 1);
}

bool SurfaceDomain::is_clear(Vec3 p, double reach) const {
  return !has_holes() && triangles_.nearest(p, reach * reach).triangle == kNone;
}

}  // namespace octafront
