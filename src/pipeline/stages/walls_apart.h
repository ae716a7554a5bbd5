#pragma once

// Walls go where their ground is, each by itself: where a gap is narrower than that moves them they could meet. There
// they stay as they were.

#include "adapt/schedule/adapt_mesh.h"

#include <functional>
#include <vector>

namespace octafront {

/// The triangles of a boundary that cross others, two for each crossing.
std::vector<TriangleCorners> crossing_triangles(const std::vector<Vec3>& points, const std::vector<Triangle>& boundary,
                                                const Stage& stage);

/// Adapts by a metric and rules; returns the triangles that cross others then.
using TryWalls = std::function<std::vector<TriangleCorners>(const adapt::MetricField&, const adapt::AdaptRules&)>;
/// Tries until the boundary does not cross itself: where it would, walls of `given` stay, and what is around grows into
/// their sizes; where that is not enough all stay. Notes say so. The last try is the one that counts.
void keep_walls_apart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules,
                      const TryWalls& attempt, const Stage& stage);

/// adapt_mesh() such that the boundary does not cross itself, by keep_walls_apart().
adapt::Adapted adapted_with_walls_apart(const TetMesh& given, const adapt::MetricField& metric, adapt::AdaptRules rules,
                                        const Stage& stage);

}  // namespace octafront
