#pragma once

// The part of a mesh that may change, taken out with as much around it as the smooth surface of its walls is known by,
// and put back among all that stays.

#include <octafront/tet_mesh.h>

#include "base/mesh/labels.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::adapt {

/// A part of a mesh. Vertices, tets, faces and curve edges are in the order of the whole; what lies at the cut is no
/// boundary face of it.
struct Section {
  TetMesh mesh;
  Origins of;                        ///< of each item its number in the whole mesh
  std::vector<std::uint8_t> frozen;  ///< per vertex: not all elements around it may change
  std::vector<std::uint8_t> loose;   ///< per tet: it has a vertex that is not frozen
};

/// Marks the vertices of marked tets; `near` has other marks already.
void mark_vertices(std::span<const Tet> tets, std::span<const std::uint8_t> marked, std::vector<std::uint8_t>& near);
/// Marks the tets with a marked vertex, then their vertices.
void grow_layer(std::span<const Tet> tets, std::vector<std::uint8_t>& marked, std::vector<std::uint8_t>& near);

/// The `chosen` tets and `layers` more of them, by vertices, are those that may change; a vertex is frozen unless all
/// tets around it may. Requires a valid linear mesh; `chosen` has one entry per tet, and becomes 1 for all that may
/// change.
Section section_of(const TetMesh& whole, std::vector<std::uint8_t>& chosen, int layers);

/// The loose tets as a mesh of their own: closed, its boundary that of the whole and the faces at which it was cut.
TetMesh closed_part(const TetMesh& mesh, std::span<const std::uint8_t> loose);

/// What became of the items of the whole mesh.
struct SplicedIds {
  std::vector<VertexIndex> old_of_new;   ///< per vertex its number before; kNone: new
  std::vector<TetIndex> old_tet_of_new;  ///< per tet likewise; one that has another corner or place of a corner is new
  std::uint64_t moved_vertices = 0, moved_tets = 0;  ///< those outside that got other numbers
};

/// The whole mesh with what was made of the loose tets of a section. All that is outside keeps its number, and so does
/// what is unchanged inside. What is new fills the numbers of what has gone, then comes behind; where less is new than
/// has gone, the last of those that stay fill the numbers that are left.
///
/// `made`: of the section's mesh, `from` as put_together() tells it.
SplicedIds splice(TetMesh& whole, const Section& section, const TetMesh& made, const Origins& from);

/// Per tet of `now` the one of `before` that has the same corners at the same places, kNone: there is none.
std::vector<TetIndex> same_tets(const TetMesh& before, const TetMesh& now, std::span<const VertexIndex> old_of_new);

}  // namespace octafront::adapt
