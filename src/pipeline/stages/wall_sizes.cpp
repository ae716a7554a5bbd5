#include <octafront/surface_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/mesh/edge_table.h"
#include "pipeline/stages/adapting.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace octafront {
namespace {

/// Smaller pieces by more halvings are noise of the mesh.
constexpr int kMostHalvingsOfWall = 16;

/// Boundary and interfaces, as sets of faces number them.
SurfaceMesh walls_of(const TetMesh& mesh) {
  SurfaceMesh walls;
  walls.points = mesh.points;
  walls.triangles = mesh.boundary;
  walls.triangles.insert(walls.triangles.end(), mesh.interfaces.begin(), mesh.interfaces.end());
  return walls;
}

/// Per triangle the least triangle of its piece. A fillet or hole of a body is no body of its own.
std::vector<std::uint32_t> pieces_of(const SurfaceMesh& walls) {
  const EdgeTable edges = make_edge_table(walls.points.size(), walls.triangles);
  DisjointSets pieces(walls.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto uses = edges.uses(e);
    if (uses.size() == 2) pieces.join(uses[0] / 3, uses[1] / 3);
  }
  std::vector<std::uint32_t> piece(walls.triangles.size());
  for (std::uint32_t t = 0; t < piece.size(); ++t) piece[t] = pieces.find(t);
  return piece;
}

}  // namespace

std::vector<adapt::ToleranceOfSet> add_wall_sizes(TetMesh& mesh, const Options& options, double tolerance,
                                                  double diagonal) {
  if (options.surface.max_deviation || !(tolerance > 0)) return {};
  const SurfaceMesh walls = walls_of(mesh);
  const std::vector<std::uint32_t> piece = pieces_of(walls);
  std::vector<Box3> box(piece.size());
  for (std::size_t t = 0; t < piece.size(); ++t)
    for (const VertexIndex v : walls.triangles[t]) box[piece[t]].add(walls.points[v]);
  std::map<int, NamedSet> sets;
  for (std::uint32_t t = 0; t < piece.size(); ++t) {
    const double size = box[piece[t]].diagonal();
    const int halvings = size > 0 ? std::min(std::ilogb(diagonal / size), kMostHalvingsOfWall) : 0;
    if (halvings < 1) continue;
    NamedSet& set = sets[halvings];
    set.kind = NamedSet::Kind::kFaces;
    set.members.push_back(t);
  }
  std::vector<adapt::ToleranceOfSet> tolerances;
  for (auto& [halvings, set] : sets) {
    tolerances.push_back({static_cast<std::uint32_t>(mesh.sets.size()), std::ldexp(tolerance, -halvings), false});
    mesh.sets.push_back(std::move(set));
  }
  return tolerances;
}

}  // namespace octafront
