#pragma once

// A mesh as parts with numbers, and back: patches, regions, curves and sets become labels that go along with what is
// made of them.

#include <octafront/tet_mesh.h>

#include "adapt/ground/ground.h"
#include "adapt/piece/piece.h"

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace octafront::adapt {

/// What the numbers of parts stand for. Each is a list: its number in the mesh, then the sets that it is in.
struct Labels {
  using Label = std::vector<std::uint32_t>;
  std::vector<Label> walls;       ///< patch first; kNone: between regions and not listed
  std::vector<Label> regions;     ///< region first
  std::vector<Label> paths;       ///< of each line: curve first; kNone: a feature alone
  std::map<Edge, Label> staying;  ///< of edges that must not be divided (Parts::kStays), as the mesh numbers them
};

struct TakenApart {
  Parts parts;  ///< vertices without metrics
  Walls walls;
  Labels labels;
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

/// The mesh again, with the names of `before`: vertices that were there in their order, new ones behind. `old_of_new`
/// gets the number in `before` of each vertex; kNone: new.
TetMesh put_together(const Parts& parts, const Labels& labels, const TetMesh& before,
                     std::vector<VertexIndex>& old_of_new);

}  // namespace octafront::adapt
