#pragma once

// What a run of octafront left in a file, mesh or surface, and what can be counted and measured of its boundary.

#include <octafront/octafront.h>

#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
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

/// Calls visit(p) for points of a triangle without its corners: halved across the longest edge until none is longer
/// than `spacing`, so that needles need few.
template <class Visit>
void sample_inside(const TriangleCorners& t, double spacing, const Visit& visit) {
  int k = 0;
  for (const int i : {1, 2})
    if (squared_distance(t[i], t[(i + 1) % 3]) > squared_distance(t[k], t[(k + 1) % 3])) k = i;
  const Vec3 a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], middle = (a + b) * 0.5;
  if (distance(a, b) <= spacing) return visit(centroid(a, b, c));
  visit(middle);
  sample_inside({a, middle, c}, spacing, visit);
  sample_inside({middle, b, c}, spacing, visit);
}

/// The same with the corners.
template <class Visit>
void sample(const TriangleCorners& t, double spacing, const Visit& visit) {
  for (const Vec3 corner : t) visit(corner);
  sample_inside(t, spacing, visit);
}

/// The distance that no point of the triangle is farther from the tree's triangle nearest to its middle: that of a
/// corner, for the distance to one triangle is convex. Spares the points of triangles that are in both surfaces.
inline double farthest_from_one(const TriangleCorners& t, const TriangleTree& tree) {
  const TriangleCorners& one = tree.corners(tree.nearest(centroid(t[0], t[1], t[2])).triangle);
  double farthest = 0;
  for (const Vec3 p : t)
    farthest = std::max(farthest, distance(p, closest_point_on_triangle(p, one[0], one[1], one[2])));
  return farthest;
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
