#include "surface/remeshing/fit_chords.h"

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/symmetric_matrix.h"

#include <algorithm>
#include <array>

namespace octafront {

namespace {

/// Where triangles are compared with the input, in barycentric coordinates: as an integral of squares takes them, exact
/// for what is linear.
constexpr std::array<std::array<double, 3>, 3> kSamples{
    {{2. / 3, 1. / 6, 1. / 6}, {1. / 6, 2. / 3, 1. / 6}, {1. / 6, 1. / 6, 2. / 3}}};
/// Sweeps that spread what neighbours have in common.
constexpr int kSweeps = 8;
/// How far samples look, in edges.
constexpr double kReach = 0.5;
/// Of all weight around a vertex: directions in which faces hardly look count less, so that what is nearly flat does
/// not shift in its plane.
constexpr double kDamped = 0.02;

struct Face {
  Vec3 normal;
  double area = 0;
  std::array<double, kSamples.size()> off{};  ///< what the input lies above the samples by, along the normal
};

Face compared(const SurfaceMesh& surface, std::size_t t, const KnownSurface& input) {
  const auto& [a, b, c] = surface.triangles[t];
  const Vec3 p = surface.points[a], q = surface.points[b], r = surface.points[c];
  const Vec3 twice = cross(q - p, r - p);
  Face face;
  face.area = length(twice) / 2;
  if (!(face.area > 0)) return face;
  face.normal = twice / (2 * face.area);
  const double reach = kReach * std::max({squared_distance(p, q), squared_distance(q, r), squared_distance(r, p)});
  for (std::size_t s = 0; s < kSamples.size(); ++s) {
    const auto& [u, v, w] = kSamples[s];
    const Vec3 at = p * u + q * v + r * w;
    const TriangleTree::Nearest near = input.tree().nearest(at, kReach * reach);
    if (near.triangle != kNone && input.mesh().sides_of(near.triangle) == surface.sides_of(t))
      face.off[s] = dot(near.point - at, face.normal);
  }
  return face;
}

}  // namespace

std::vector<Vec3> moves_to_fit(const SurfaceMesh& surface, const std::vector<std::uint8_t>& moves,
                               const KnownSurface& input) {
  const std::size_t n = surface.points.size();
  std::vector<Face> faces(surface.triangles.size());
  parallel_for(faces.size(), [&](std::size_t t) { faces[t] = compared(surface, t, input); });
  const Groups<> corners_at(n, [&](const auto& add) {
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
      for (std::uint32_t i = 0; i < 3; ++i)
        if (moves[surface.triangles[t][i]]) add(surface.triangles[t][i], 3 * t + i);
  });
  std::vector<SymmetricMatrix> normals(n);
  parallel_for(n, [&](std::size_t v) {
    for (const std::uint32_t c : corners_at[v]) normals[v].add(faces[c / 3].normal, faces[c / 3].area);
  });
  std::vector<Vec3> way(n), next(n);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    parallel_for(n, [&](std::size_t v) {
      Vec3 off;
      for (const std::uint32_t c : corners_at[v]) {
        const Face& face = faces[c / 3];
        const Triangle& t = surface.triangles[c / 3];
        for (std::size_t s = 0; s < kSamples.size(); ++s) {
          Vec3 moved;
          for (int i = 0; i < 3; ++i) moved += way[t[i]] * kSamples[s][i];
          off += face.normal * (face.area * kSamples[s][c % 3] * (face.off[s] - dot(moved, face.normal)));
        }
      }
      next[v] = way[v] + normals[v].damped_solve(off, kDamped * normals[v].trace());
    });
    way.swap(next);
  }
  return way;
}

}  // namespace octafront
