#include "layers/directions.h"

#include "base/core/parallel.h"
#include "layers/bare_patches.h"

#include <algorithm>
#include <span>

namespace octafront::layers {

namespace {

/// Normals that differ by less, as cosine, are one: what rounding makes of a plane.
constexpr double kSameNormal = 1 - 1e-12;
/// A direction must lie at least so far, as sine, above each triangle: about 3 degrees.
constexpr double kLeastSight = 0.05;
/// Smoothing may take this part of the best sight.
constexpr double kKeptSight = 0.6;
constexpr int kHalvings = 4;
/// All triples of so many normals are tried; of more the direction is approached by steps (M. Badoiu, K. Clarkson,
/// Smaller core-sets for balls, 2003).
constexpr std::size_t kMostForTriples = 14;
constexpr int kApproaches = 400;

void add_distinct(std::vector<Vec3>& normals, Vec3 n, double same = kSameNormal) {
  if (n == Vec3{}) return;
  if (std::ranges::none_of(normals, [&](Vec3 m) { return dot(m, n) > same; })) normals.push_back(n);
}

double sight_of(std::span<const Vec3> normals, Vec3 d) {
  double least = 1;
  for (const Vec3 n : normals) least = std::min(least, dot(n, d));
  return least;
}

Vec3 best_by_triples(std::span<const Vec3> normals) {
  Vec3 best;
  double best_sight = -2;
  const auto consider = [&](Vec3 d) {
    d = normalized(d);
    if (d == Vec3{}) return;
    if (const double sight = sight_of(normals, d); sight > best_sight) best = d, best_sight = sight;
  };
  for (std::size_t i = 0; i < normals.size(); ++i) {
    consider(normals[i]);
    for (std::size_t j = i + 1; j < normals.size(); ++j) {
      consider(normals[i] + normals[j]);
      for (std::size_t k = j + 1; k < normals.size(); ++k) {
        const Vec3 axis = cross(normals[j] - normals[i], normals[k] - normals[i]);
        consider(axis), consider(-axis);
      }
    }
  }
  return best;
}

Vec3 best_by_steps(std::span<const Vec3> normals) {
  Vec3 d = normals.front();
  for (int i = 1; i <= kApproaches; ++i) {
    const Vec3 worst = *std::ranges::min_element(normals, {}, [&](Vec3 n) { return dot(n, d); });
    d += (worst - d) / (i + 1);
  }
  return normalized(d);
}

/// What a vertex is like: the normals of the walls there, those of other patches, in whose planes it stays.
class Corner {
 public:
  Corner(const Walls& walls, VertexIndex v) {
    for (const std::uint32_t f : walls.faces[v])
      if (walls.is_wall[f])
        add_distinct(normals_, walls.inward[f]);
      else
        add_distinct(planes_, walls.inward[f], kSamePlane);
  }

  bool is_stuck() const { return planes_.size() > 2; }
  double sight(Vec3 d) const { return sight_of(normals_, d); }

  /// The part of d in the planes; zero if there is none.
  Vec3 within(Vec3 d) const {
    if (planes_.size() == 1) {
      d = d - planes_[0] * dot(planes_[0], d);
      d = normalized(d);
      return normalized(d - planes_[0] * dot(planes_[0], d));
    }
    if (planes_.size() == 2) {
      const Vec3 line = normalized(cross(planes_[0], planes_[1]));
      return dot(line, d) < 0 ? -line : line;
    }
    return normalized(d);
  }

  Vec3 best() const {
    std::vector<Vec3> seen;
    for (const Vec3 n : normals_) add_distinct(seen, within(n));
    if (seen.empty()) return {};
    return within(seen.size() <= kMostForTriples ? best_by_triples(seen) : best_by_steps(seen));
  }

 private:
  std::vector<Vec3> normals_, planes_;
};

/// `own` and the mean of its neighbours, half and half; less of theirs where that would see too little.
Vec3 smoothed(const Corner& corner, Vec3 own, Vec3 mean, double needed) {
  double part = 0.5;
  for (int i = 0; i <= kHalvings; ++i, part /= 2) {
    const Vec3 d = corner.within(own * (1 - part) + mean * part);
    if (corner.sight(d) >= needed) return d;
  }
  return own;
}

}  // namespace

Directions choose_directions(const Walls& walls, int passes) {
  const std::size_t n = walls.surface.points.size();
  Directions made{std::vector<Vec3>(n), std::vector<Reason>(n, Reason::kNone)};
  std::vector<double> best(n, 0);
  parallel_for(walls.wall_vertices.size(), [&](std::size_t i) {
    const VertexIndex v = walls.wall_vertices[i];
    const Corner corner(walls, v);
    if (corner.is_stuck()) {
      made.reason[v] = Reason::kBare;
      return;
    }
    const Vec3 d = corner.best();
    best[v] = corner.sight(d);
    if (d == Vec3{} || best[v] < kLeastSight)
      made.reason[v] = Reason::kDirection;
    else
      made.step[v] = d;
  });
  for (int pass = 0; pass < passes; ++pass) {
    const std::vector<Vec3> before = made.step;
    parallel_for(walls.wall_vertices.size(), [&](std::size_t i) {
      const VertexIndex v = walls.wall_vertices[i];
      if (before[v] == Vec3{}) return;
      Vec3 sum;
      walls.for_each_neighbour(v, [&](VertexIndex w) { sum += before[w]; });
      const Vec3 mean = normalized(sum);
      if (mean == Vec3{} || mean == before[v]) return;
      made.step[v] = smoothed(Corner(walls, v), before[v], mean, kKeptSight * best[v]);
    });
  }
  parallel_for(walls.wall_vertices.size(), [&](std::size_t i) {
    const VertexIndex v = walls.wall_vertices[i];
    if (made.step[v] == Vec3{}) return;
    made.step[v] *= std::min(kMostStretch, 1 / Corner(walls, v).sight(made.step[v]));
  });
  return made;
}

}  // namespace octafront::layers
