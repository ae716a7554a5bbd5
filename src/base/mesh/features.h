#pragma once

#include <octafront/ids.h>

#include "base/mesh/edge_table.h"

#include <vector>

namespace octafront {

struct SurfaceMesh;

/// The lines and points of a surface that every later stage must keep.
struct Features {
  std::vector<Edge> edges;           ///< feature edges, smaller index first, sorted, each once
  std::vector<VertexIndex> corners;  ///< vertices where curves end, meet or bend sharply; sorted
};

/// Edges whose faces turn by at least `angle_degrees`, edges between different patches, and edges that have not just
/// two faces; corners where other than two of them meet, or where a curve turns by at least `angle_degrees`. A closed
/// curve may be without corners. Slivers as low as the rounding noise of files (1e-5 of the model's diagonal) turn with
/// a neighbour, so a sharp edge beside one is found once, but for the rims of plates as thin as that. Cost: O(n log n),
/// about 0.1 s per million triangles.
Features detect_features(const SurfaceMesh& surface, double angle_degrees);
/// The same with the edges at hand.
Features detect_features(const SurfaceMesh& surface, const EdgeTable& edges, double angle_degrees);

}  // namespace octafront
