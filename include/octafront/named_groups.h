#pragma once

#include <octafront/mesh_field.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace octafront {

struct SurfaceMesh;

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

/// What options that take a place may name (docs/use/places.md): names, "patch_3" and the like of what has none. Of a
/// surface that has no `sides` cells are not looked for: its one region is "body", and of one with walls inside none is
/// named.
struct PlaceNames {
  std::vector<std::string> regions, patches, curves, sets;
  std::vector<std::string> contacts = {};  ///< the patches that are sides of opened ones
};
PlaceNames place_names(const SurfaceMesh& surface);
PlaceNames place_names(const TetMesh& mesh);

/// What a further set of a mesh is to hold.
struct GroupRule {
  struct Sphere {
    Vec3 center;
    double radius = 0;  ///< > 0
  };
  std::string name;
  NamedSet::Kind kind = NamedSet::Kind::kNodes;  ///< in a box or sphere; of what has a name: whatever it holds
  /// A closed box, a closed ball, patches, or one region, patch, curve or set; by name or number (docs/use/places.md).
  std::variant<Box3, Sphere, std::vector<std::string>, std::string> where;
};
/// Reads NAME=PLACE (docs/use/places.md), or with a kind before a box or sphere, NAME=elements:box:... Throws
/// OptionError.
GroupRule group_rule(const std::string& text);

/// Refuses a rule by patches that a mesh of this surface or complex will not have, before it is made: names that
/// neither a division by angle nor split_patches() would make. Throws OptionError, which lists those that there are.
void check_group(const SurfaceMesh& surface, const GroupRule& rule);

/// Adds the set to the mesh: nodes in the box or ball; faces of boundary and interfaces, curve edges or elements whose
/// corners all are; the faces of the patches; or what is called so, a set for each kind. Returns a sentence for the
/// user where there is something to say: nothing is called so, or nothing found (then no set is added); else an empty
/// string. Throws OptionError for a patch that there is not.
std::string add_group(TetMesh& mesh, const GroupRule& rule);

/// Elements whose values of a field lie in the same part of its range.
struct FieldBin {
  std::string set;             ///< its name, "E_03"
  double mean = 0;             ///< by volume
  double least = 0, most = 0;  ///< of the values
  std::uint64_t elements = 0;
  double volume = 0;
};
/// Adds a set of elements for each of `count` equal parts of the range of a field of elements (one number each) that
/// holds some: every element is in one of them. For sections of material, a constant each. Requires count > 0.
std::vector<FieldBin> add_bins(TetMesh& mesh, const MeshField& field, std::uint32_t count);

/// Adds the lines along which patches of the boundary and of interfaces meet, or a patch ends, as curves: one for each
/// set of patches that meet, called "A|B" ("A + A|B + B" where names have bars) where all of them have names, "A end"
/// at the end of one. Does nothing to a mesh that has curves already.
void add_patch_curves(TetMesh& mesh);

}  // namespace octafront
