#pragma once

#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace octafront {

/// What MEDIT's files (those of MMG, FreeFEM, ...) know of the entities of a mesh. Sets of a mesh that are called so,
/// and are of this kind, are these; other formats hold them as sets with these names. What is required keeps its place,
/// and as an edge, face or element its vertices, whatever is done to the mesh.
struct MeditSet {
  std::string_view name;
  NamedSet::Kind kind;
  bool is_required;
};
inline constexpr std::array<MeditSet, 6> kMeditSets{{{"Corners", NamedSet::Kind::kNodes, false},
                                                     {"RequiredVertices", NamedSet::Kind::kNodes, true},
                                                     {"Ridges", NamedSet::Kind::kEdges, false},
                                                     {"RequiredEdges", NamedSet::Kind::kEdges, true},
                                                     {"RequiredTriangles", NamedSet::Kind::kFaces, true},
                                                     {"RequiredTetrahedra", NamedSet::Kind::kElements, true}}};
/// The entry of a set; null: it is of none.
const MeditSet* medit_set(const NamedSet& set);
/// The vertices of all that is required, ascending.
std::vector<VertexIndex> required_vertices(const TetMesh& mesh);

/// A set of nodes, edges or faces by the places of their vertices, for surfaces, which have no sets: one, two or three
/// each.
struct PlacedSet {
  std::string name;
  NamedSet::Kind kind = NamedSet::Kind::kNodes;
  std::vector<Vec3> places;

  std::size_t each() const { return kind == NamedSet::Kind::kNodes ? 1 : kind == NamedSet::Kind::kEdges ? 2 : 3; }
  friend bool operator==(const PlacedSet&, const PlacedSet&) = default;
};
/// Whether vertices of the set stay wherever a surface is changed: corners, and what is required.
bool keeps_vertices(const PlacedSet& set);
/// The sets of a mesh but for those of elements.
std::vector<PlacedSet> placed_sets(const TetMesh& mesh);
/// Adds those whose members are all in the mesh, vertex by vertex at the same coordinates; of those of kMeditSets what
/// is there. Edges that are none of curves become edges of a new one. Returns a sentence about what is missing, or an
/// empty string.
std::string add_placed_sets(TetMesh& mesh, std::span<const PlacedSet> sets);

/// What a further set of a mesh is to hold.
struct GroupRule {
  struct Sphere {
    Vec3 center;
    double radius = 0;  ///< > 0
  };
  std::string name;
  NamedSet::Kind kind = NamedSet::Kind::kNodes;  ///< in a box or sphere; of patches: always faces
  /// A closed box, a closed ball, or patches by name or number (from 1).
  std::variant<Box3, Sphere, std::vector<std::string>> where;
};

/// Adds the set to the mesh: nodes in the box or ball; faces of boundary and interfaces, curve edges or elements whose
/// corners all are; or the faces of the patches. Returns a sentence for the user where there is something to say: no
/// such patch, nothing found (then no set is added); else an empty string.
std::string add_group(TetMesh& mesh, const GroupRule& rule);

/// Adds the lines along which patches of the boundary and of interfaces meet, or a patch ends, as curves: one for each
/// set of patches that meet, called "A|B" ("A + A|B + B" where names have bars) where all of them have names, "A end"
/// at the end of one. Does nothing to a mesh that has curves already.
void add_patch_curves(TetMesh& mesh);

}  // namespace octafront
