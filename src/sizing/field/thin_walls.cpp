#include "sizing/field/thin_walls.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "sizing/field/affordable.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

namespace octafront {

namespace {

/// Triangles of edge length h on an area of h^2.
constexpr double kTrianglesPerSquare = 4 / std::numbers::sqrt3;

/// Elements for each triangle of the surface of a wall, by its thickness in sizes: as measured on plates. The steps are
/// where a second and a third layer begin; behind the last row the volume decides.
struct Row {
  double thickness, tets;
};
constexpr Row kTetsPerTriangle[] = {{0, 1.47},   {1.05, 1.5},  {1.09, 2.6},
                                    {1.3, 2.93}, {1.72, 2.93}, {1.78, 4.2},
                                    {1.95, 4.7}, {2.45, 4.7},  {3, 3 * kTetsPerCube / (2 * kTrianglesPerSquare)}};
constexpr double kThickest = std::end(kTetsPerTriangle)[-1].thickness;

double tets_per_triangle(double thickness) {
  const Row* above = std::find_if(std::begin(kTetsPerTriangle) + 1, std::end(kTetsPerTriangle) - 1,
                                  [&](const Row& r) { return thickness < r.thickness; });
  const Row &b = *above, &a = above[-1];
  return a.tets + (b.tets - a.tets) * (thickness - a.thickness) / (b.thickness - a.thickness);
}

/// A wall of one layer, in sizes. Triangles that are kept may be so many times fewer than the sizes ask for: then walls
/// of several layers have points inside, and the volume decides there too.
constexpr double kOneLayer = 1.05, kCoarse = 0.75;

/// Places looked at, spread evenly over the triangles that the surface will have: shares to a percent, in milliseconds.
constexpr int kPlacesOfWalls = 4096;
/// Rays begin this part of the model inside the surface, so as not to meet it where they start.
constexpr double kSkipped = 1e-7;

}  // namespace

ThinWalls::Look ThinWalls::look(std::span<const SurfacePiece> pieces, std::span<const double> sizes,
                                std::optional<std::size_t> triangles) const {
  RawVector<double> squares(pieces.size());  // then those of all pieces up to each
  parallel_for(pieces.size(), [&](std::size_t i) { squares[i] = length(pieces[i].n) / (sizes[i] * sizes[i]); });
  std::partial_sum(squares.begin(), squares.end(), squares.begin());
  const double all = squares.empty() ? 0 : squares.back();
  Look seen{{}, triangles ? static_cast<double>(*triangles) / all : kTrianglesPerSquare};
  const double step = all / kPlacesOfWalls;
  std::vector<Place>& looked_at = seen.places;
  double next = 0.5 * step;
  for (auto passed = squares.begin(); passed != squares.end(); ++passed) {
    passed = std::upper_bound(passed, squares.end(), next);
    if (passed == squares.end()) break;
    const auto count = std::ceil((*passed - next) / step);
    next += count * step;
    looked_at.push_back({static_cast<std::size_t>(passed - squares.begin()), count * step});
  }
  parallel_for(looked_at.size(), [&](std::size_t i) {
    const std::size_t k = looked_at[i].piece;
    looked_at[i].walls = thickness(pieces[k].p, normalized(pieces[k].n), kThickest * sizes[k]) / sizes[k];
  });
  return seen;
}

double ThinWalls::excess_tets(std::span<const SurfacePiece> pieces, std::span<const double> sizes,
                              std::optional<std::size_t> triangles) const {
  const Look seen = look(pieces, sizes, triangles);
  const bool are_coarse = seen.triangles_per_square < kCoarse * kTrianglesPerSquare;
  double excess = 0;
  for (const Place& p : seen.places) {
    if (p.walls >= kThickest || (are_coarse && p.walls > kOneLayer)) continue;
    // The elements of one side of the wall, less those that its half of the volume stands for.
    excess += p.squares * (seen.triangles_per_square * tets_per_triangle(p.walls) - kTetsPerCube * p.walls / 2);
  }
  return excess;
}

double ThinWalls::tets_through(std::span<const SurfacePiece> pieces, std::span<const double> sizes,
                               std::optional<std::size_t> triangles) const {
  const Look seen = look(pieces, sizes, triangles);
  double through = 0;
  for (const Place& p : seen.places)
    if (p.walls <= kOneLayer) through += p.squares * seen.triangles_per_square * tets_per_triangle(p.walls);
  return through;
}

/// Way to the sheet that faces p from behind; infinite if there is none within reach.
double ThinWalls::thickness(Vec3 p, Vec3 normal, double reach) const {
  const double skipped = kSkipped * tree_.box().diagonal();
  const Vec3 from = p - skipped * normal;
  const auto is_other_side = [&](const TriangleTree::RayHit& hit) {
    if (hit.triangle == kNone) return false;
    const auto& [a, b, c] = tree_.corners(hit.triangle);
    return faces(unit_normal(a, b, c), normal);
  };
  // Where the wall is thinner than what is skipped its other side lies behind the start.
  if (const TriangleTree::RayHit hit = tree_.first_hit(from, normal, skipped); is_other_side(hit))
    return std::max(0.0, skipped - hit.t);
  const TriangleTree::RayHit hit = tree_.first_hit(from, -normal, reach);
  return is_other_side(hit) ? skipped + hit.t : HUGE_VAL;
}

}  // namespace octafront
