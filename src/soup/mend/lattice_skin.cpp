#include "base/core/disjoint_sets.h"
#include "base/core/renumber.h"
#include "base/core/stage.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/features.h"
#include "fill/lattice/cut_lattice.h"
#include "fill/lattice/lattice_octree.h"
#include "fill/lattice/manifold.h"
#include "fill/lattice/stuff.h"
#include "soup/mend/mend_steps.h"

#include <algorithm>
#include <cmath>

namespace octafront::mend {
namespace {

/// The boundary of a mesh as a surface of its own, with the nearest wall of each triangle.
LatticeSkin boundary_of(const TetMesh& mesh, const SurfaceMesh& walls, double near) {
  LatticeSkin skin;
  PointsTaken taken(mesh.points);
  const TriangleTree tree(walls);
  for (const Triangle& t : mesh.boundary) {
    const Vec3 middle = centroid(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    const TriangleTree::Nearest nearest = tree.nearest(middle);
    skin.surface.triangles.push_back(taken.take(t, skin.surface.points));
    skin.surface.source.push_back(nearest.triangle);
    skin.is_far.push_back(nearest.squared_distance > near * near);
  }
  return skin;
}

/// Everything within a distance of triangles.
class Neighbourhood final : public ImplicitDomain {
 public:
  Neighbourhood(const TriangleTree& walls, double distance) : walls_(walls), distance_(distance) {}

  int side(Vec3 p) const override { return walls_.is_within(p, distance_) ? 1 : -1; }

  double crossing(Vec3 inside, Vec3 outside) const override {
    double from = 0, to = 1;
    constexpr int kBisections = 24;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (from + to);
      (side(inside + (outside - inside) * middle) > 0 ? from : to) = middle;
    }
    return 0.5 * (from + to);
  }

  bool is_clear(Vec3 p, double reach) const override {
    const double away = std::sqrt(walls_.nearest(p).squared_distance);
    return std::abs(away - distance_) > reach;
  }

 private:
  const TriangleTree& walls_;
  double distance_;
};

LatticeOctree octree_around(const SurfaceMesh& walls, double distance, double edge, const RunContext& context) {
  const double leaf = kLatticeSidePerEdge * edge;
  constexpr double kMargin = 4;
  const RootCube root = lattice_root(bounding_box(walls.points), leaf, kMargin + distance / leaf);
  std::vector<Box3> reach;
  const Vec3 by{distance + 2 * leaf, distance + 2 * leaf, distance + 2 * leaf};
  for (const Triangle& t : walls.triangles) {
    Box3 box;
    for (const VertexIndex v : t) box.add(walls.points[v]);
    reach.push_back({box.lo - by, box.hi + by});
  }
  return {root, divide_lattice(
                    root, SizeField::uniform(edge), reach, [](OctreeKey) { return CellSide::kOutside; }, context)};
}

/// Drops the parts that bound cavities: only what is seen from outside stays.
void keep_outer_parts(SurfaceMesh& surface) {
  DisjointSets parts(surface.points.size());
  for (const Triangle& t : surface.triangles)
    for (const VertexIndex v : t) parts.join(t[0], v);
  std::vector<double> volume(surface.points.size(), 0);
  for (const Triangle& t : surface.triangles) {
    const std::uint32_t part = parts.find(t[0]);
    volume[part] +=
        signed_volume(surface.points[part], surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]);
  }
  std::erase_if(surface.triangles, [&](const Triangle& t) { return volume[parts.find(t[0])] < 0; });
}

}  // namespace

LatticeSkin skin_of_lattice(const SurfaceMesh& walls, double edge, const RunContext& context) {
  constexpr double kFeatureAngle = 40, kGrowth = 0.5;
  StageReport counts;
  const TriangleTree tree(walls);
  const double most = bounding_box(walls.points).diagonal();
  const SizeField sizes = SizeField::from_function(
      [&](Vec3 p) { return edge + kGrowth * std::sqrt(tree.nearest(p).squared_distance); }, edge, most);
  const TetMesh mesh = stuff_surface(walls, detect_features(walls, kFeatureAngle), SurfaceDomain::Defects::kOpen, sizes,
                                     {context, counts});
  return boundary_of(mesh, walls, edge);
}

LatticeSkin wrap_of(const SurfaceMesh& walls, double distance, const RunContext& context) {
  constexpr double kEdgePerDistance = 0.7;
  const double edge = kEdgePerDistance * distance;
  StageReport counts;
  const TriangleTree tree(walls);
  const LatticeOctree octree = octree_around(walls, distance, edge, context);
  TetMesh mesh = cut_lattice(octree.root, octree.tree, Neighbourhood(tree, distance), {context, counts});
  make_boundary_manifold(mesh, context);
  SurfaceMesh outer{mesh.points, mesh.boundary, {}, {}, {}};
  keep_outer_parts(outer);
  mesh.boundary = std::move(outer.triangles);
  return boundary_of(mesh, walls, distance);
}

}  // namespace octafront::mend
