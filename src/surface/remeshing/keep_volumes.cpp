#include "surface/remeshing/keep_volumes.h"

#include "base/core/groups.h"
#include "base/mesh/complex.h"
#include "surface/check/surface_check.h"
#include "surface/ground/crossings.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace octafront::remeshing {

namespace {

constexpr double kMostMove = 0.2;  // of the shortest edge: triangles keep their shape
constexpr int kVolumeSteps = 3;    // volumes are nearly linear in moves so small
constexpr int kRoundsBack = 8;
constexpr std::size_t kMostRegionsSolved = 3000;  // the system is dense
constexpr double kSamePlane = 1e-10;              // what cosines of equal normals may lack of 1

std::vector<double> volumes_of(const SurfaceMesh& complex, std::size_t regions) {
  std::vector<double> volumes(regions, 0);
  const Vec3 origin = complex.points.empty() ? Vec3{} : complex.points[0];
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto& [a, b, c] = complex.triangles[t];
    const double v = dot(complex.points[a] - origin, cross(complex.points[b] - origin, complex.points[c] - origin)) / 6;
    const auto [front, behind] = complex.sides[t];
    if (front != kNone) volumes[front] -= v;
    if (behind != kNone) volumes[behind] += v;
  }
  return volumes;
}

/// L L^T x = b in place, of a matrix by its lower half; regions that nothing moves have a row of zeros and stay.
void solve(std::vector<double>& k, std::vector<double>& b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = k[i * n + j];
      for (std::size_t m = 0; m < j; ++m) sum -= k[i * n + m] * k[j * n + m];
      if (j < i)
        k[i * n + j] = sum / k[j * n + j];
      else
        k[i * n + i] = sum > 0 ? std::sqrt(sum) : HUGE_VAL;
    }
    double sum = b[i];
    for (std::size_t m = 0; m < i; ++m) sum -= k[i * n + m] * b[m];
    b[i] = sum / k[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t m = i + 1; m < n; ++m) b[i] -= k[m * n + i] * b[m];
    b[i] /= k[i * n + i];
  }
}

class Keeper {
 public:
  Keeper(SurfaceMesh& complex, const Features& features, const SurfaceMesh& input)
      : complex_(complex),
        before_(complex.points),
        regions_(std::max(region_count(complex), region_count(input))),
        wanted_(volumes_of(input, regions_)),
        moves_(complex.points.size(), 1) {
    for (const Edge& e : features.edges) moves_[e[0]] = moves_[e[1]] = 0;
    for (const VertexIndex v : features.corners) moves_[v] = 0;
    find_reach();
    keep_flat_parts();
  }

  std::uint64_t run(const RunContext& context) {
    for (int step = 0; step < kVolumeSteps; ++step) {
      context.check();
      press();
    }
    if (!take_back_crossings(context) || first_complex_defect_but_crossings(complex_, context))
      complex_.points = before_;
    std::uint64_t moved = 0;
    for (std::size_t v = 0; v < before_.size(); ++v) moved += complex_.points[v] != before_[v];
    return moved;
  }

 private:
  void find_reach() {
    reach_.assign(complex_.points.size(), HUGE_VAL);
    for (const Triangle& t : complex_.triangles)
      for (int i = 0; i < 3; ++i) {
        const VertexIndex a = t[i], b = t[(i + 1) % 3];
        const double l = kMostMove * distance(before_[a], before_[b]);
        reach_[a] = std::min(reach_[a], l);
        reach_[b] = std::min(reach_[b], l);
      }
  }

  /// Faces on the box of an image are to stay in it: no vertex with two triangles in one plane moves.
  void keep_flat_parts() {
    std::vector<Vec3> normal;
    for (const Triangle& t : complex_.triangles)
      normal.push_back(normalized(cross(before_[t[1]] - before_[t[0]], before_[t[2]] - before_[t[0]])));
    const Groups<> at(complex_.points.size(), [&](const auto& add) {
      for (std::uint32_t t = 0; t < complex_.triangles.size(); ++t)
        for (const VertexIndex v : complex_.triangles[t]) add(v, t);
    });
    for (VertexIndex v = 0; v < complex_.points.size(); ++v) {
      const auto around = at[v];
      for (std::size_t i = 0; i < around.size() && moves_[v]; ++i)
        for (std::size_t k = i + 1; k < around.size(); ++k)
          if (std::abs(dot(normal[around[i]], normal[around[k]])) > 1 - kSamePlane) moves_[v] = 0;
    }
  }

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
  };

  std::vector<Gradient> gradients() const {
    std::vector<Gradient> all(complex_.points.size());
    for (std::size_t t = 0; t < complex_.triangles.size(); ++t) {
      const auto& [a, b, c] = complex_.triangles[t];
      const Vec3 third = cross(complex_.points[b] - complex_.points[a], complex_.points[c] - complex_.points[a]) / 6;
      for (const VertexIndex v : {a, b, c}) {
        if (!moves_[v]) continue;
        all[v].add(complex_.sides[t][1], third);
        all[v].add(complex_.sides[t][0], third * -1);
        all[v].area += length(third);
      }
    }
    return all;
  }

  /// One step towards the volumes wanted.
  void press() {
    const std::vector<Gradient> gradient = gradients();
    std::vector<double> k(regions_ * regions_, 0), pressure = volumes_of(complex_, regions_);
    for (std::size_t r = 0; r < regions_; ++r) pressure[r] = wanted_[r] - pressure[r];
    for (const Gradient& g : gradient)
      for (const auto& [r, a] : g.of)
        for (const auto& [s, b] : g.of)
          if (s <= r && g.area > 0) k[r * regions_ + s] += dot(a, b) / g.area;
    solve(k, pressure);
    for (std::size_t v = 0; v < gradient.size(); ++v) {
      const Gradient& g = gradient[v];
      if (!(g.area > 0)) continue;
      Vec3 move;
      for (const auto& [r, a] : g.of) move += a * (pressure[r] / g.area);
      const Vec3 all = complex_.points[v] + move - before_[v];
      const double l = length(all);
      complex_.points[v] = l <= reach_[v] ? before_[v] + all : before_[v] + all * (reach_[v] / l);
    }
  }

  /// False if something crosses whatever goes back.
  bool take_back_crossings(const RunContext& context) {
    for (int round = 0; round < kRoundsBack; ++round) {
      context.check();
      const auto crossings = find_crossings(complex_);
      if (crossings.empty()) return true;
      for (const auto& pair : crossings)
        for (const std::uint32_t t : pair)
          for (const VertexIndex v : complex_.triangles[t]) complex_.points[v] = before_[v];
    }
    return false;
  }

  SurfaceMesh& complex_;
  const std::vector<Vec3> before_;
  const std::size_t regions_;
  const std::vector<double> wanted_;
  std::vector<std::uint8_t> moves_;
  std::vector<double> reach_;
};

}  // namespace

std::uint64_t keep_volumes(SurfaceMesh& complex, const Features& features, const SurfaceMesh& input,
                           const RunContext& context) {
  if (complex.sides.empty() || region_count(input) > kMostRegionsSolved) return 0;
  return Keeper(complex, features, input).run(context);
}

}  // namespace octafront::remeshing
