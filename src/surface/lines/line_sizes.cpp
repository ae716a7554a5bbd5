#include "surface/lines/line_sizes.h"

#include <octafront/surface_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "surface/lines/point_grid.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace octafront::surface {

std::vector<Vec3> thinned(const SizeField& sizes, const std::vector<Vec3>& places) {
  if (places.empty()) return {};
  std::vector<Vec3> kept;
  PointGrid<NoData> grid(places.front());
  for (const Vec3 p : places) {
    const double h = sizes.at(p);
    bool is_new = true;
    grid.for_each_near(p, h, 0.5, [&](const auto&) { is_new = false; });
    if (!is_new) continue;
    kept.push_back(p);
    grid.add(p, h);
  }
  return kept;
}

std::vector<PointSize> smaller_at(const std::vector<Vec3>& places, double part, const SizeField& sizes) {
  std::vector<PointSize> wanted;
  for (const Vec3 p : thinned(sizes, places)) wanted.push_back({p, part * sizes.at(p)});
  return wanted;
}

std::vector<PointSize> smallest_ones(std::vector<PointSize> places) {
  if (places.empty()) return places;
  std::sort(places.begin(), places.end(), [](const PointSize& a, const PointSize& b) {
    return std::tie(a.size, a.p.x, a.p.y, a.p.z) < std::tie(b.size, b.p.x, b.p.y, b.p.z);
  });
  PointGrid<NoData> grid(places.front().p);
  std::erase_if(places, [&](const PointSize& s) {
    bool is_new = true;
    grid.for_each_near(s.p, s.size, 1, [&](const auto&) { is_new = false; });
    if (is_new) grid.add(s.p, s.size);
    return !is_new;
  });
  return places;
}

namespace {

/// So many elements along a shell keep its shape.
constexpr double kAlongSmallShell = 3;
/// An icosahedron has edges of this part of the third root of the volume of its ball: shells as small keep that.
constexpr double kOfSmallShell = 0.65;

/// What the shells of regions enclose, by side of a triangle: 2 t in front of triangle t, 2 t + 1 behind it. A shell is
/// a closed surface that bounds a region, or a hole in it; shells that touch along an edge are one. Not of sheets, and
/// the outside has none.
std::vector<double> volumes_of_shells(const SurfaceMesh& complex, const EdgeTable& edges) {
  DisjointSets shells(2 * complex.triangles.size());
  const auto join = [&](std::uint32_t t, std::uint32_t u) {
    for (const std::uint32_t i : {0u, 1u})
      for (const std::uint32_t j : {0u, 1u})
        if (complex.sides_of(t)[i] == complex.sides_of(u)[j]) shells.join(2 * t + i, 2 * u + j);
  };
  const auto is_wall = [&](std::uint32_t h) { return complex.sides_of(h / 3)[0] != complex.sides_of(h / 3)[1]; };
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const std::uint32_t g : edges.uses(e))
      for (const std::uint32_t h : edges.uses(e))
        if (g < h && is_wall(g) && is_wall(h)) join(g / 3, h / 3);
  std::vector<double> of_shell(2 * complex.triangles.size(), 0), volumes(of_shell.size(), 0);
  for (std::uint32_t side = 0; side < of_shell.size(); ++side) {
    const std::uint32_t shell = shells.find(side);
    const Vec3 o = complex.points[complex.triangles[shell / 2][0]];
    const auto& [a, b, c] = complex.triangles[side / 2];
    const double volume = six_volumes(o, complex.points[a], complex.points[b], complex.points[c]) / 6;
    of_shell[shell] += side % 2 == 0 ? volume : -volume;
  }
  for (std::uint32_t side = 0; side < volumes.size(); ++side)
    if (complex.sides_of(side / 2)[side % 2] != kNone) volumes[side] = std::abs(of_shell[shells.find(side)]);
  return volumes;
}

}  // namespace

LeastSizes::LeastSizes(const KnownSurface& known, double least) : known_(known), least_(least) {
  const SurfaceMesh& surface = known.mesh();
  if (!(least > 0) || surface.sides.empty()) return;
  const std::vector<double> volumes = volumes_of_shells(surface, known.edges());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    double of = least;
    const auto [front, behind] = surface.sides_of(t);
    for (const std::uint32_t side : {0u, 1u})
      if (front != behind && surface.sides_of(t)[side] != kNone)
        of = std::min(of, elementary::cbrt(volumes[2 * t + side]) / kAlongSmallShell);
    of_triangle_.push_back(of);
  }
  if (std::ranges::all_of(of_triangle_, [&](double of) { return of == least; })) of_triangle_.clear();
}

double LeastSizes::at(Vec3 p) const {
  return of_triangle_.empty() ? least_ : of_triangle_[known_.tree().nearest(p).triangle];
}

std::vector<PointSize> LeastSizes::small_shells(const SizeField& sizes) const {
  std::vector<PointSize> places;
  const SurfaceMesh& surface = known_.mesh();
  for (std::uint32_t t = 0; t < of_triangle_.size(); ++t) {
    if (of_triangle_[t] == least_) continue;
    const auto& [a, b, c] = surface.triangles[t];
    const Vec3 p = centroid(surface.points[a], surface.points[b], surface.points[c]);
    const double size = kOfSmallShell * kAlongSmallShell * of_triangle_[t];
    if (size < sizes.at(p)) places.push_back({p, size});
  }
  return places;
}

}  // namespace octafront::surface
