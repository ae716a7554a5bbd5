#pragma once

#include <octafront/surface_mesh.h>

#include <vector>

namespace octafront {

/// The lines and points of a surface that every later stage must keep.
struct Features {
  std::vector<Edge> edges;            ///< feature edges, smaller index first, sorted, each once
  std::vector<VertexIndex> corners;   ///< vertices where curves end, meet or bend sharply; sorted
};

/// Edges whose faces turn by at least `angle_degrees`, and edges between different patches; corners where other than
/// two of them meet, or where two meet at an angle sharper than `angle_degrees`.
Features detect_features(const SurfaceMesh& surface, double angle_degrees);

}  // namespace octafront
