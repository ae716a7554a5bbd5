#pragma once

// What a run of octafront left in a file, mesh or surface, and what can be counted and measured of its boundary.

#include <octafront/octafront.h>

#include "geometry/measures.h"
#include "geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace octafront {

using Json = nlohmann::ordered_json;

struct MadeResult {
  /// Of a mesh: the faces of only one tetrahedron, found anew, not believed; patches are those that the file gives
  /// them.
  SurfaceMesh boundary;
  Json about;  ///< of a mesh: tets, defect, regions, quality; of all: components, and the counts of kind_of()
};

/// Reads a surface where the file's name ends in .off or .obj, else a mesh.
MadeResult read_result(const std::string& file);

/// Calls visit(p) for the corners of a triangle and points inside it, none farther from the next than `spacing`.
template <class Visit>
void sample(const TriangleCorners& t, double spacing, Visit&& visit) {
  const double longest = std::sqrt(longest_squared_edge(t[0], t[1], t[2]));
  const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      visit(t[0] + (t[1] - t[0]) * (static_cast<double>(i) / n) + (t[2] - t[0]) * (static_cast<double>(j) / n));
  visit(centroid(t[0], t[1], t[2]));
}

struct Farthest {
  double distance = 0;
  Vec3 at;
  void add(double d, Vec3 p) {
    if (d > distance) *this = {d, p};
  }
  /// In parts of the diagonal.
  Json json(double diagonal) const { return {{"distance", distance / diagonal}, {"at", {at.x, at.y, at.z}}}; }
};

inline TriangleCorners corners_of(const SurfaceMesh& s, const Triangle& t) {
  return {s.points[t[0]], s.points[t[1]], s.points[t[2]]};
}

}  // namespace octafront
