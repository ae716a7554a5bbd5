#pragma once

// Where the nodes of the boundary would like to be: corners and mid-side nodes on the smooth surface.

#include <octafront/tet_mesh.h>

#include "base/geometry/true_geometry.h"
#include "improve/curved/mid_nodes.h"
#include "improve/curved/smooth_surface.h"

#include <span>
#include <vector>

namespace octafront::curved {

/// A corner that the smooth surface would have elsewhere.
struct CornerMove {
  VertexIndex vertex;
  Vec3 by;
};

/// How far the nodes inside an edge (from its lower end on) or face (the one nearest to its lowest corner first) lie
/// off the straight one between its corners, when those are where they want to be. It keeps this shape where they are
/// not.
using NodeMoves = std::array<Vec3, 3>;

/// An edge of the boundary that would be curved.
struct EdgeBend {
  Edge edge;
  NodeMoves by;
};

/// A face of the boundary, its corners ascending, whose inner nodes have places.
struct FaceBend {
  Triangle face;
  NodeMoves by;
};

/// An element whose inner node has a place of its own; of order 4.
struct TetBend {
  TetIndex tet;
  NodeMoves by;
};

struct Bends {
  std::vector<CornerMove> corners;  ///< ascending
  std::vector<EdgeBend> edges;      ///< ascending
  std::vector<FaceBend> faces;      ///< ascending; of orders 3 and 4
  std::vector<TetBend> tets;        ///< ascending; of order 4
  std::size_t too_far = 0;          ///< corners that stay, for they would have to move too far
};

/// `mesh` is linear. `sharp`: feature edges of its boundary, sorted, those between patches too. In parallel.
Bends find_bends(const TetMesh& mesh, const std::vector<Edge>& sharp, SmoothSurface& surface, int order = 2);

/// The same where the true geometry is known; the patches of the mesh are its patches. Edges bend as they do once their
/// corners are on it. In parallel.
Bends find_bends(const TetMesh& mesh, const TrueGeometry& geometry, int order = 2);

/// What lies over vertices of the boundary goes along with them, nodes of columns over a wall: `below` has for each
/// vertex the one of the boundary under it, itself if there is none.
void add_corners_above(std::span<const VertexIndex> below, Bends& bends);
void add_edges_above(std::span<const VertexIndex> below, const TetEdges& edges, int order, Bends& bends);
/// The same of faces and elements of orders 3 and 4, which move as the wall under each of their nodes does. `bends` has
/// those of the wall alone, its edges too.
void add_faces_above(std::span<const VertexIndex> below, const TetFaces& faces, const TetMesh& mesh, int order,
                     Bends& bends);

}  // namespace octafront::curved
