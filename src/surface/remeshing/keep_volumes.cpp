#include "surface/remeshing/keep_volumes.h"

#include "base/core/conjugate_gradients.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/symmetric_matrix.h"
#include "base/mesh/complex.h"
#include "surface/edits/working_mesh.h"
#include "surface/remeshing/surface_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

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

/// Per vertex the way along its normal, so that triangles lie as near to the input as vertices off it let them, by
/// least squares: chords of what is bent lie half outside then. `moves`: per vertex, whether it may; others get none.
/// What lies nearest must bound the same regions, within half an edge.
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

constexpr double kMostMove = 0.2;    // of the shortest edge: triangles keep their shape
constexpr double kMostToFit = 0.75;  // of that way: the rest is for volumes
constexpr int kVolumeSteps = 6;
/// Volumes this near to what is wanted need no further step: a hundredth of what a note is written for.
constexpr double kVolumeReached = 1e-4;
constexpr int kRoundsBack = 8, kHalves = 3;  // of these rounds so many go back half the way
constexpr double kSamePlane = 1e-10;         // what cosines of equal normals may lack of 1
constexpr SolverLimits kSolved{.steps = 400, .enough = 1e-12};

/// What a vertex adds to the volumes of the regions around it.
struct Gradient {
  std::vector<std::pair<std::uint32_t, Vec3>> of;
  double area = 0;
  void add(std::uint32_t region, Vec3 a) {
    if (region == kNone) return;
    for (auto& [r, g] : of)
      if (r == region) {
        g += a;
        return;
      }
    of.push_back({region, a});
  }
  /// Where these pressures move it.
  Vec3 move_by(const std::vector<double>& pressure) const {
    Vec3 move;
    for (const auto& [r, a] : of) move += a * (pressure[r] / area);
    return move;
  }
};

/// The pressures that change volumes by `missing`. Regions that nothing moves have a row of zeros, and none.
class PressureSolver {
 public:
  explicit PressureSolver(const std::vector<Gradient>& gradients) : gradients_(gradients) {}

  std::vector<double> solve(const std::vector<double>& missing) const {
    return solved_by_conjugate_gradients(
        diagonal_of(missing.size()), missing, [&](const std::vector<double>& p) { return change_by(p); }, kSolved);
  }

 private:
  std::vector<double> diagonal_of(std::size_t regions) const {
    std::vector<double> diagonal(regions, 0);
    for (const Gradient& g : gradients_)
      for (const auto& [r, a] : g.of)
        if (g.area > 0) diagonal[r] += squared_length(a) / g.area;
    return diagonal;
  }
  std::vector<double> change_by(const std::vector<double>& pressure) const {
    std::vector<double> change(pressure.size(), 0);
    for (const Gradient& g : gradients_) {
      if (!(g.area > 0)) continue;
      const Vec3 move = g.move_by(pressure);
      for (const auto& [r, a] : g.of) change[r] += dot(a, move);
    }
    return change;
  }

  const std::vector<Gradient>& gradients_;
};

class Keeper {
 public:
  Keeper(SurfaceMesh& surface, const Features& features, std::span<const double> wanted,
         std::span<const VertexIndex> fixed)
      : surface_(surface),
        before_(surface.points),
        wanted_(wanted.begin(), wanted.end()),
        moves_(surface.points.size(), 1) {
    wanted_.resize(std::max<std::size_t>(wanted_.size(), region_count(surface)), 0);
    for (const Edge& e : features.edges) moves_[e[0]] = moves_[e[1]] = 0;
    for (const VertexIndex v : features.corners) moves_[v] = 0;
    for (const VertexIndex v : fixed) moves_[v] = 0;
    find_reach();
    keep_flat_parts();
  }

  std::uint64_t run(const TooFar& too_far, const KnownSurface* input, const RunContext& context) {
    if (input != nullptr) {
      const std::vector<Vec3> to_fit = moves_to_fit(surface_, moves_, *input);
      for (std::size_t v = 0; v < to_fit.size(); ++v) {
        const double l = length(to_fit[v]), most = kMostToFit * reach_[v];
        surface_.points[v] = before_[v] + (l <= most ? to_fit[v] : to_fit[v] * (most / l));
      }
      go_back(too_far, context);
    }
    for (int step = 0; step < kVolumeSteps; ++step) {
      context.check();
      const std::vector<double> missing = missing_volumes();
      if (missing.empty()) break;
      press(missing);
      go_back(too_far, context);
    }
    std::uint64_t moved = 0;
    for (std::size_t v = 0; v < before_.size(); ++v) moved += surface_.points[v] != before_[v];
    return moved;
  }

 private:
  void find_reach() {
    reach_.assign(surface_.points.size(), HUGE_VAL);
    for (const Triangle& t : surface_.triangles)
      for (int i = 0; i < 3; ++i) {
        const VertexIndex a = t[i], b = t[(i + 1) % 3];
        const double l = kMostMove * distance(before_[a], before_[b]);
        reach_[a] = std::min(reach_[a], l);
        reach_[b] = std::min(reach_[b], l);
      }
  }

  /// Flat parts, as those on the box of an image, are to stay so: no vertex with two triangles in one plane moves.
  void keep_flat_parts() {
    std::vector<Vec3> normal;
    for (const Triangle& t : surface_.triangles)
      normal.push_back(normalized(cross(before_[t[1]] - before_[t[0]], before_[t[2]] - before_[t[0]])));
    const Groups<> at = rows_at_vertices(surface_.points.size(), surface_.triangles);
    for (VertexIndex v = 0; v < surface_.points.size(); ++v) {
      const auto around = at[v];
      for (std::size_t i = 0; i < around.size() && moves_[v]; ++i)
        for (std::size_t k = i + 1; k < around.size(); ++k)
          if (std::abs(dot(normal[around[i]], normal[around[k]])) > 1 - kSamePlane) moves_[v] = 0;
    }
  }

  std::vector<Gradient> gradients() const {
    std::vector<Gradient> all(surface_.points.size());
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto& [a, b, c] = surface_.triangles[t];
      const Vec3 third = cross(surface_.points[b] - surface_.points[a], surface_.points[c] - surface_.points[a]) / 6;
      const auto [front, behind] = surface_.sides_of(t);
      for (const VertexIndex v : {a, b, c}) {
        if (!moves_[v]) continue;
        all[v].add(behind, third);
        all[v].add(front, third * -1);
        all[v].area += length(third);
      }
    }
    return all;
  }

  /// Empty if all regions have what is wanted.
  std::vector<double> missing_volumes() const {
    std::vector<double> missing = volumes_of_regions(surface_);
    missing.resize(wanted_.size(), 0);
    bool is_reached = true;
    for (std::size_t r = 0; r < wanted_.size(); ++r) {
      missing[r] = wanted_[r] > 0 ? wanted_[r] - missing[r] : 0;
      is_reached &= std::abs(missing[r]) <= kVolumeReached * wanted_[r];
    }
    return is_reached ? std::vector<double>{} : missing;
  }

  /// One step towards the volumes wanted. Who is at the end of its way leaves further steps to others.
  void press(const std::vector<double>& missing) {
    const std::vector<Gradient> gradient = gradients();
    const std::vector<double> pressure = PressureSolver(gradient).solve(missing);
    for (std::size_t v = 0; v < gradient.size(); ++v) {
      if (!(gradient[v].area > 0)) continue;
      const Vec3 all = surface_.points[v] + gradient[v].move_by(pressure) - before_[v];
      const double l = length(all);
      if (l >= reach_[v]) moves_[v] = 0;
      surface_.points[v] = before_[v] + (l <= reach_[v] ? all : all * (reach_[v] / l));
    }
  }

  void go_back(const TooFar& too_far, const RunContext& context) {
    for (int round = 0; round < kRoundsBack; ++round) {
      context.check();
      const std::vector<VertexIndex> back = too_far();
      if (back.empty()) return;
      for (const VertexIndex v : back) {
        surface_.points[v] = round < kHalves ? (before_[v] + surface_.points[v]) / 2 : before_[v];
        moves_[v] = 0;
      }
    }
    if (!too_far().empty()) surface_.points = before_;
  }

  SurfaceMesh& surface_;
  const std::vector<Vec3> before_;
  std::vector<double> wanted_;
  std::vector<std::uint8_t> moves_;
  std::vector<double> reach_;
};

}  // namespace

std::uint64_t keep_volumes(SurfaceMesh& surface, const Features& features, std::span<const double> wanted,
                           const TooFar& too_far, std::span<const VertexIndex> fixed, const KnownSurface* input,
                           const RunContext& context) {
  return Keeper(surface, features, wanted, fixed).run(too_far, input, context);
}

namespace surface {

std::vector<VertexIndex> vertices_in_crossings(const SurfaceMesh& surface) {
  std::vector<VertexIndex> found;
  for (const auto& pair : find_crossings(surface))
    for (const std::uint32_t t : pair)
      found.insert(found.end(), surface.triangles[t].begin(), surface.triangles[t].end());
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::uint64_t keep_volumes_clean(SurfaceMesh& surface, const Features& features, std::span<const double> wanted,
                                 std::span<const VertexIndex> fixed, const KnownSurface* input,
                                 const RunContext& context) {
  const std::vector<Vec3> before = surface.points;
  const TooFar crossing = [&] { return vertices_in_crossings(surface); };
  const std::uint64_t moved = keep_volumes(surface, features, wanted, crossing, fixed, input, context);
  if (moved == 0 || surface.sides.empty() || !first_complex_defect_but_crossings(surface, context)) return moved;
  surface.points = before;
  return 0;
}

}  // namespace surface
}  // namespace octafront
