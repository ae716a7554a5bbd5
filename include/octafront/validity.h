#pragma once

#include <octafront/no_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <optional>
#include <string>

namespace octafront {

/// The first way in which a mesh breaks the laws below, as a sentence with ids and coordinates; else nullopt.
///   - indices in range, coordinates finite, no vertex unused, every tet positive by exact sign
///   - every face in one or two tets; in two only from opposite sides
///   - the faces in one tet are exactly `boundary`, oriented outward, each once; interfaces lie between two tets, each
///     listed once
///   - curve edges are edges of tets; sets have members in range, ascending
///   - second order: each edge has one mid-side node, of its own, and all of them come behind the corners
///   - second order: every element has a positive Jacobian, by the exact sign of its twenty Bernstein coefficients
///   - sum of the tet volumes equal to the volume that the boundary encloses, to rounding
/// Throws Cancelled if `context` asks for it. Cost: O(tets), about 0.3 s per million.
std::optional<std::string> first_defect(const TetMesh& mesh, const RunContext& context = no_context());

/// As above, and the boundary must be `surface`, triangle for triangle (same coordinates, same orientation; numbering
/// and order are free). Of a complex (SurfaceMesh::sides) boundary and interfaces together must be the triangles, each
/// with the regions of the tetrahedra on its sides, and no regions meet elsewhere.
std::optional<std::string> first_defect(const TetMesh& mesh, const SurfaceMesh& surface,
                                        const RunContext& context = no_context());

/// The first wedge or pyramid (TetMesh::wide_cells) that is turned inside out or torn, as an element of its own and not
/// as the tetrahedra that it is made of: first_defect() knows of these alone. nullopt: every corner of each wedge, and
/// of each pyramid's base, has a positive Jacobian by exact sign.
std::optional<std::string> first_wide_defect(const TetMesh& mesh);

}  // namespace octafront
