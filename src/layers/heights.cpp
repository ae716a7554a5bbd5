#include "layers/heights.h"

#include "base/core/parallel.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace octafront::layers {

namespace {

/// Of the way to another wall, from which layers may grow too; of the way to a patch without layers.
constexpr double kOfGap = 0.4, kOfBareGap = 0.8;
/// Rays start so many heights away from the wall: rounding must not let them hit their own triangles.
constexpr double kStartOfRay = 0.01;
/// Sine up to which a ray runs along a triangle without layers: one that its layers end on. So often it goes on.
constexpr double kAlong = 1e-3;
constexpr int kMostAlong = 16;
/// Heights of neighbours.
constexpr double kMostRatio = 2, kMostSlope = 1;
/// Layers are made thinner down to this part before some are left out.
constexpr double kThinnest = 0.5;
/// From all layers to none over so many edges. Few layers are all there or none: elements where a stack ends lean far
/// over the layer below, as finite volumes do not bear, and thin stacks are no loss.
constexpr std::uint32_t kStepsToNone = 2, kFewLayers = 4;

double asked_height(const Columns& columns, VertexIndex v) {
  return columns.first[v] * columns.height_of(columns.asked);
}

/// What v may have because of its neighbours' lengths.
double limit_by_neighbours(const Walls& walls, const std::vector<double>& height, VertexIndex v) {
  double most = height[v];
  walls.for_each_neighbour(v, [&](VertexIndex w) {
    const double slope = height[w] + kMostSlope * distance(walls.surface.points[v], walls.surface.points[w]);
    most = std::min(most, height[w] > 0 ? std::min(slope, kMostRatio * height[w]) : slope);
  });
  return most;
}

/// Whatever is above what its neighbours let it have comes down, until nothing does.
void relax(const Walls& walls, const Columns& columns, Allowance& allowed) {
  std::vector<double> height(allowed.part.size(), 0);
  for (const VertexIndex v : walls.wall_vertices) height[v] = allowed.part[v] * asked_height(columns, v);
  std::vector<double> next = height;
  for (bool changes = true; changes;) {
    parallel_for(walls.wall_vertices.size(), [&](std::size_t i) {
      const VertexIndex v = walls.wall_vertices[i];
      next[v] = limit_by_neighbours(walls, height, v);
    });
    changes = next != height;
    height = next;
  }
  for (const VertexIndex v : walls.wall_vertices)
    allowed.limit(v, height[v] / asked_height(columns, v), Reason::kNeighbour);
}

/// The most layers that may be had with at least kThinnest of their heights.
std::uint32_t layers_within(const Columns& columns, double part) {
  if (columns.asked <= kFewLayers) return part >= kThinnest ? columns.asked : 0;
  const double all = columns.height_of(columns.asked);
  std::uint32_t count = columns.asked;
  while (count > 0 && kThinnest * columns.height_of(count) > part * all) --count;
  return count;
}

void drop_layers(const Walls& walls, const Allowance& allowed, Columns& columns) {
  const std::uint32_t most_step = columns.asked <= kFewLayers ? columns.asked : (columns.asked + 1) / kStepsToNone;
  for (const VertexIndex v : walls.wall_vertices) columns.count[v] = layers_within(columns, allowed.part[v]);
  for (bool changes = true; changes;) {
    changes = false;
    for (const VertexIndex v : walls.wall_vertices)
      walls.for_each_neighbour(v, [&](VertexIndex w) {
        const std::uint32_t most = columns.count[w] + most_step;
        if (columns.count[v] > most) columns.count[v] = most, changes = true;
      });
  }
}

}  // namespace

namespace {

struct Opposite {
  std::uint32_t triangle;
  double part;  ///< of the way
};

/// What lies in the way of a column.
Opposite opposite_of(const Walls& walls, const TriangleTree& tree, Vec3 from, Vec3 way) {
  double start = kStartOfRay;
  for (int i = 0; i < kMostAlong; ++i) {
    const TriangleTree::RayHit hit = tree.first_hit(from + way * start, way, 1 / std::min(kOfGap, kOfBareGap));
    if (hit.triangle == kNone) break;
    const bool runs_along =
        !walls.is_wall[hit.triangle] && std::abs(dot(walls.inward[hit.triangle], way)) <= kAlong * length(way);
    if (!runs_along) return {hit.triangle, start + hit.t};
    start += hit.t + kStartOfRay;
  }
  return {kNone, 0};
}

}  // namespace

void limit_by_gaps(const Walls& walls, const Columns& columns, Allowance& allowed) {
  const TriangleTree tree(walls.surface);
  parallel_for(walls.wall_vertices.size(), [&](std::size_t i) {
    const VertexIndex v = walls.wall_vertices[i];
    const Vec3 way = columns.step[v] * asked_height(columns, v);
    if (way == Vec3{}) return;
    const Opposite opposite = opposite_of(walls, tree, walls.surface.points[v], way);
    if (opposite.triangle == kNone) return;
    allowed.limit(v, (walls.is_wall[opposite.triangle] ? kOfGap : kOfBareGap) * opposite.part, Reason::kGap);
  });
}

void settle_heights(const Walls& walls, Allowance& allowed, Columns& columns) {
  relax(walls, columns, allowed);
  drop_layers(walls, allowed, columns);
  const double all = columns.height_of(columns.asked);
  for (const VertexIndex v : walls.wall_vertices) {
    const std::uint32_t count = columns.count[v];
    columns.part[v] = count == 0 ? 0 : std::min(1.0, allowed.part[v] * all / columns.height_of(count));
    const bool is_full = count == columns.asked && columns.part[v] == 1;
    columns.reason[v] = is_full                              ? Reason::kNone
                        : allowed.reason[v] == Reason::kNone ? Reason::kNeighbour
                                                             : allowed.reason[v];
  }
}

}  // namespace octafront::layers
