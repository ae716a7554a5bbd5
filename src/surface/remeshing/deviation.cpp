#include "surface/remeshing/deviation.h"

namespace octafront::remeshing {

namespace {

void look(const SurfaceMesh& from, const TriangleTree& to, double limit, bool at_centroids, std::vector<Vec3>& places) {
  const auto test = [&](Vec3 p) {
    if (to.nearest(p, limit * limit).triangle == kNone) places.push_back(p);
  };
  for (const Vec3 p : from.points) test(p);
  for (const auto& [a, b, c] : from.triangles) {
    const Vec3 pa = from.points[a], pb = from.points[b], pc = from.points[c];
    if (at_centroids) test((pa + pb + pc) / 3);
    if (a < b) test((pa + pb) * 0.5);
    if (b < c) test((pb + pc) * 0.5);
    if (c < a) test((pc + pa) * 0.5);
  }
}

}  // namespace

std::vector<Vec3> places_beyond(double limit, const SurfaceMesh& made, const SurfaceMesh& input,
                                const TriangleTree& input_tree) {
  std::vector<Vec3> places;
  look(made, input_tree, limit, true, places);
  look(input, TriangleTree(made), limit, false, places);
  return places;
}

}  // namespace octafront::remeshing
