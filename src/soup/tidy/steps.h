#pragma once

// The steps of repair_surface, each on the surface as the step before it left it. They drop, divide and turn faces, and
// never move a vertex.

#include <octafront/repair.h>
#include <octafront/run_context.h>

#include "base/mesh/edge_table.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace octafront::tidy {

/// The surface on its way through repair.
struct Draft {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> face;  ///< per triangle: the input face
  const RunContext& context;
  std::optional<EdgeTable> known_edges = std::nullopt;  ///< to be reset by whatever changes triangles

  /// The edges of the mesh: most steps change nothing, and find them as the step before did.
  const EdgeTable& edges() {
    if (!known_edges) known_edges = make_edge_table(mesh.points.size(), mesh.triangles, context);
    return *known_edges;
  }
};

/// The input, checked.
Draft make_draft(const SurfaceMesh& soup, const RunContext& context);
/// All steps. Takes the mesh out of the draft; `known_edges`, if there are any, are those of the result.
RepairedSurface tidied(Draft& draft);

/// Input faces that a step touched, each once, ascending.
using InputFaces = std::vector<std::uint32_t>;

/// Throws InputError if an index or a coordinate of the input is out of range, or arrays do not match.
void check_input(const SurfaceMesh& soup);

struct Merged {
  std::uint64_t merged = 0, unused = 0;
};
/// Lets triangles refer to the first of equal vertices (0 equals -0) and drops vertices that none refers to.
Merged merge_vertices(Draft& draft);
/// Drops vertices that no triangle refers to; returns how many.
std::uint64_t drop_unused_vertices(Draft& draft);

struct Degenerate {
  std::uint64_t removed = 0, divided = 0;
  InputFaces faces;
};
/// Drops triangles with a repeated vertex. Triangles whose corners lie on a line are closed up: the faces at their
/// longest edge are divided at the corner in its middle, which changes no point of the surface.
Degenerate drop_degenerate(Draft& draft);

struct Duplicates {
  std::uint64_t copies = 0;  ///< faces dropped of which an equal one stays
  std::uint64_t sheets = 0;  ///< faces dropped in sheets of no thickness, none stays
  InputFaces copy_faces, sheet_faces;
};
/// Of triangles with the same three vertices one stays, or, where two layers face each other and the rest is closed
/// without them, none.
Duplicates drop_duplicates(Draft& draft);

/// Of a complex: drops triangles with nothing on either side, joins those of two bodies at the same place, and turns
/// all such that the outside or the higher region lies in front.
void clean_walls(Draft& draft, RepairedSurface& result);

/// The pieces of a surface that hang together over edges of two faces.
struct Pieces {
  std::vector<std::uint32_t> piece_of_triangle;  ///< numbered by their first triangle
  std::vector<char> orientable;                  ///< per piece
  std::uint64_t turned = 0;
  InputFaces turned_faces;
  std::uint32_t count() const { return static_cast<std::uint32_t>(orientable.size()); }
};
/// Turns the fewest faces such that the two faces of each edge agree, piece by piece.
Pieces orient_pieces(Draft& draft);

struct Shells {
  std::vector<std::uint32_t> body_of_piece;
  std::uint32_t bodies = 0, cavities = 0;
  std::uint64_t inside_out = 0, turned_cavities = 0;
  InputFaces inside_out_faces, turned_cavity_faces;  ///< the first face of each piece that was turned
};
/// Turns closed pieces outward, and those that lie inside an odd number of others inward.
Shells orient_shells(Draft& draft, const Pieces& pieces);

/// Number of closed pieces around each closed piece (0 for others), and the innermost of them (kNone without).
/// Only pieces with `closed[piece]` count.
struct Nesting {
  std::vector<std::uint32_t> depth, parent;
};
Nesting find_nesting(const SurfaceMesh& mesh, const Pieces& pieces, const std::vector<char>& closed,
                     const RunContext& context);

/// Exact sign of six times the volume that each piece encloses with the origin.
std::vector<int> volume_signs(const SurfaceMesh& mesh, const Pieces& pieces);

/// Keeps the triangles that are not marked.
void drop_marked(Draft& draft, const std::vector<char>& marked);
void sort_unique(InputFaces& faces);

}  // namespace octafront::tidy
