#pragma once

// A mesh as parts with numbers, and back: patches, regions, curves and sets become labels that go along with what is
// made of them.

#include <octafront/tet_mesh.h>

#include "adapt/ground/ground.h"
#include "adapt/passes/piece.h"
#include "base/mesh/labels.h"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

namespace octafront::adapt {

/// What the numbers of parts stand for: each for all that the item of the mesh has which is named here.
struct PartLabels {
  std::vector<std::uint32_t> walls;       ///< faces; kNone: between regions and not listed
  std::vector<TetIndex> regions;          ///< tets
  std::vector<std::uint32_t> paths;       ///< edges of curves; kNone: a feature alone
  std::map<Edge, std::uint32_t> staying;  ///< the same of edges that must not be divided (Parts::kStays), as the mesh
                                          ///< numbers their vertices
};

struct TakenApart {
  Parts parts;  ///< vertices without metrics
  Walls walls;
  PartLabels labels;
  std::vector<std::uint8_t> kept;  ///< per part of walls: its triangles stay; empty: none do
};

/// Requires a valid linear mesh. Lines are where walls bend by `feature_angle` (degrees), end, or meet others, the
/// mesh's curves, and `kinks` (ascending), whose ends all stay; vertices where the boundary touches itself stay, all
/// others of walls are `off`. Faces of one tet that the boundary does not list are no walls: the mesh was cut out of
/// another there.
TakenApart take_apart(const TetMesh& mesh, double feature_angle, std::span<const Edge> kinks = {});

/// Holds what sets of the mesh, by their numbers, have: nodes; edges of lines, and faces, with their vertices; elements
/// with all that is between their vertices.
void hold_sets(TakenApart& taken, const TetMesh& mesh, std::span<const std::uint32_t> sets);

/// The mesh again, with all that hangs on `before`: vertices that were there in their order, new ones behind. `from`:
/// of vertices those that they are, of all else an item of the same labels.
TetMesh put_together(const Parts& parts, const PartLabels& labels, const TetMesh& before, Origins& from);

/// Walls as triangles, each once, and the points that they have.
struct WallsOfParts {
  SurfaceMesh surface;              ///< `patch`: the parts
  std::vector<std::uint8_t> outer;  ///< per triangle
  std::vector<VertexIndex> vertex;  ///< per point the one of the mesh that it is
};
/// Those that are not `left_out`.
WallsOfParts wall_triangles(const Parts& parts,
                            const std::function<bool(const Triangle& corners, std::uint32_t part)>& left_out);

}  // namespace octafront::adapt
