#include "base/core/parallel.h"
#include "images/nets/net_steps.h"

#include <algorithm>
#include <cmath>

namespace octafront::nets {

namespace {

/// Vertices of faces between what the surface holds and what it does not.
std::vector<std::uint8_t> vertices_of(const Net& net, const GivenSurface& surface) {
  std::vector<std::uint8_t> touched(net.corner.size(), 0);
  for (const Quad& q : net.quads)
    if (surface.holds(q.lower) != surface.holds(q.upper))
      for (const VertexIndex v : q.v) touched[v] = 1;
  return touched;
}

/// To the nearest place of the surface, within the cell: what its walls take of the way there the rest of the way makes
/// up for, as if the surface were flat. Where it does not reach into the cell, the nearest place that was tried.
Vec3 on_surface(const GivenSurface& surface, const Lattice& lattice, const VertexCells& cells, VertexIndex v, Vec3 p) {
  constexpr int kSteps = 20;
  Vec3 best = p;
  double least = HUGE_VAL;
  for (int step = 0; step < kSteps; ++step) {
    const TriangleTree::Nearest nearest = surface.tree.nearest(lattice.to_world(p));
    if (nearest.squared_distance < least) least = nearest.squared_distance, best = p;
    const Vec3 there = lattice.to_straight(nearest.point), allowed = cells.clamped(v, there);
    if (allowed == there) return there;
    const Vec3 way = there - p, left = allowed - p;
    const double along = dot(way, left);
    if (!(along > 0)) break;
    p = cells.clamped(v, p + left * (squared_length(way) / along));
  }
  return best;
}

}  // namespace

PlacedVertices place_on_surfaces(const Net& net, const Lattice& lattice, std::span<const GivenSurface> surfaces,
                                 std::vector<Vec3>& x, const RunContext& context) {
  PlacedVertices placed;
  if (surfaces.empty()) return placed;
  const double voxel = voxel_of(lattice.grid());
  // A surface says where between the middles of voxels it is, as grey values do.
  const VertexCells cells = VertexCells::without_layers(lattice, net);
  placed.is_placed.resize(x.size(), 0);
  placed.on.resize(x.size(), 0);
  placed.far.resize(surfaces.size(), 0);
  std::vector<double> squared(x.size(), voxel * voxel);
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    context.check();
    const std::vector<std::uint8_t> touched = vertices_of(net, surfaces[s]);
    parallel_for(x.size(), [&](std::size_t v) {
      if (!touched[v]) return;
      const TriangleTree::Nearest nearest = surfaces[s].tree.nearest(lattice.to_world(x[v]), squared[v]);
      if (nearest.triangle == kNone) return;
      squared[v] = nearest.squared_distance;
      placed.is_placed[v] = 1;
      placed.on[v] = static_cast<std::uint16_t>(s);
    });
    for (std::size_t v = 0; v < x.size(); ++v) placed.far[s] += touched[v] && !placed.is_placed[v];
  }
  parallel_for(x.size(), [&](std::size_t v) {
    if (placed.is_placed[v])
      x[v] = on_surface(surfaces[placed.on[v]], lattice, cells, static_cast<VertexIndex>(v), x[v]);
  });
  return placed;
}

std::vector<Deviation> deviations(std::span<const GivenSurface> surfaces, const PlacedVertices& placed,
                                  std::span<const Vec3> world) {
  std::vector<double> away(placed.is_placed.size(), 0);
  parallel_for(away.size(), [&](std::size_t v) {
    if (placed.is_placed[v]) away[v] = std::sqrt(surfaces[placed.on[v]].tree.nearest(world[v]).squared_distance);
  });
  std::vector<Deviation> all(surfaces.size());
  for (std::size_t v = 0; v < away.size(); ++v) {
    if (!placed.is_placed[v]) continue;
    Deviation& of = all[placed.on[v]];
    ++of.vertices, of.sum += away[v], of.largest = std::max(of.largest, away[v]);
  }
  return all;
}

}  // namespace octafront::nets
