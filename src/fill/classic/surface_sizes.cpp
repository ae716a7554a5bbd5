#include "fill/classic/surface_sizes.h"

#include <octafront/surface_mesh.h>

#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <memory>

namespace octafront {

namespace {

std::vector<double> mean_edge_lengths(const SurfaceMesh& surface) {
  std::vector<double> sum(surface.points.size(), 0), count(surface.points.size(), 0);
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) {
      const VertexIndex a = t[k], b = t[(k + 1) % 3];
      const double l = distance(surface.points[a], surface.points[b]);
      for (const VertexIndex v : {a, b}) sum[v] += l, ++count[v];
    }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = count[v] > 0 ? sum[v] / count[v] : 0;
  return sum;
}

struct Source {
  SurfaceMesh surface;
  TriangleTree tree;
  std::vector<double> at_vertex;

  double at(Vec3 p) const {
    const TriangleTree::Nearest nearest = tree.nearest(p);
    const auto& [i, j, k] = surface.triangles[nearest.triangle];
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[k], q = nearest.point;
    const double u = triangle_area(q, b, c), v = triangle_area(a, q, c), w = triangle_area(a, b, q);
    const double all = u + v + w;
    return all > 0 ? (u * at_vertex[i] + v * at_vertex[j] + w * at_vertex[k]) / all : at_vertex[i];
  }
};

}  // namespace

SizeField sizes_from_surface(const SurfaceMesh& surface) {
  const auto source =
      std::make_shared<const Source>(Source{surface, TriangleTree(surface), mean_edge_lengths(surface)});
  double lo = source->at_vertex[surface.triangles[0][0]], hi = lo;
  for (const Triangle& t : surface.triangles)
    for (const VertexIndex v : t) lo = std::min(lo, source->at_vertex[v]), hi = std::max(hi, source->at_vertex[v]);
  return SizeField::from_function([source](Vec3 p) { return source->at(p); }, lo, hi);
}

}  // namespace octafront
