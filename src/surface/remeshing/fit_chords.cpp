#include "surface/remeshing/fit_chords.h"

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"

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

/// What the normals around a vertex make of a sum of them: moves along directions that faces look in. Directions in
/// which they hardly look count less (kDamped of all), so that what is nearly flat does not shift in its plane.
class Directions {
 public:
  void add(Vec3 n, double weight) {
    xx_ += weight * n.x * n.x, xy_ += weight * n.x * n.y, xz_ += weight * n.x * n.z;
    yy_ += weight * n.y * n.y, yz_ += weight * n.y * n.z, zz_ += weight * n.z * n.z;
  }
  Vec3 solve(Vec3 r) const {
    constexpr double kDamped = 0.02;
    const double damp = kDamped * (xx_ + yy_ + zz_);
    const double a = xx_ + damp, d = yy_ + damp, f = zz_ + damp;
    const double m0 = d * f - yz_ * yz_, m1 = xz_ * yz_ - xy_ * f, m2 = xy_ * yz_ - xz_ * d;
    const double det = a * m0 + xy_ * m1 + xz_ * m2;
    if (!(det > 0)) return {};
    const double m3 = a * f - xz_ * xz_, m4 = xy_ * xz_ - a * yz_, m5 = a * d - xy_ * xy_;
    return Vec3{m0 * r.x + m1 * r.y + m2 * r.z, m1 * r.x + m3 * r.y + m4 * r.z, m2 * r.x + m4 * r.y + m5 * r.z} / det;
  }

 private:
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
};

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
  std::vector<Directions> directions(n);
  parallel_for(n, [&](std::size_t v) {
    for (const std::uint32_t c : corners_at[v]) directions[v].add(faces[c / 3].normal, faces[c / 3].area);
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
      next[v] = way[v] + directions[v].solve(off);
    });
    way.swap(next);
  }
  return way;
}

}  // namespace octafront
