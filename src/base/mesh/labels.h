#pragma once

// What hangs on the items of a mesh (parts and their names, sets, pairs, layers, sources) and goes along
// with every change of it. Who changes a mesh says of each item which one before it comes from; what there is to carry
// is known here and nowhere else.

#include <octafront/tet_mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// Which item of the mesh before each item of a changed one comes from, by number: it is that one, a part of it, a
/// copy, or one of the same labels. kNone: it is of none. Faces count as in sets: the boundary's, then those of
/// interfaces.
struct Origins {
  std::vector<std::uint32_t> nodes, edges, faces, tets;
};

/// The values of the items with these numbers, `none` where there is no such item; none of items that have no values.
template <class T>
std::vector<T> of_items(const std::vector<T>& values, std::span<const std::uint32_t> items, const T& none = {}) {
  std::vector<T> out;
  if (values.empty()) return out;
  out.reserve(items.size());
  for (const std::uint32_t i : items) out.push_back(i < values.size() ? values[i] : none);
  return out;
}

/// Gives `mesh`, whose points, tets, faces and edges are there, all else that `before` has: names, the numbers of
/// parts, sets (those left empty too), and, where the nodes and items that they need are there, pairs, wedges, pyramids
/// and doubled faces.
void inherit(TetMesh& mesh, const TetMesh& before, const Origins& from);

/// The same of what one kind of items has. The sets of `mesh` are those of `before`, in their order; those of this kind
/// get other members.
void inherit(TetMesh& mesh, const TetMesh& before, NamedSet::Kind kind, std::span<const std::uint32_t> from);

/// The part of a mesh that has these items, in this order, with all that hangs on them. `here` has kNone for each point
/// of the mesh, and has it again afterwards. Requires the nodes of all items, without a repetition.
TetMesh part_of(const TetMesh& whole, const Origins& items, std::vector<VertexIndex>& here);

/// What items of one kind are: those of one number have the same part and are in the same sets.
struct Labels {
  std::vector<std::uint32_t> of;    ///< per item, numbered as they come
  std::vector<std::uint32_t> like;  ///< per number the first item that has it
};
Labels labels_of(const TetMesh& mesh, NamedSet::Kind kind);

/// Whether the item is a member.
bool has_member(const NamedSet& set, std::uint32_t item);
/// Whether there are sets of this kind.
bool has_sets(const TetMesh& mesh, NamedSet::Kind kind);

/// The nodes of sets of nodes that are to keep their places: those that are not amid nodes which are in the same sets,
/// on walls (boundary and interfaces) by the edges of these. Ascending.
std::vector<VertexIndex> nodes_that_stay(const TetMesh& mesh);

}  // namespace octafront
