#pragma once

#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <string>
#include <variant>
#include <vector>

namespace octafront {

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

/// Gives `mesh` the interfaces, curves and sets of `before`, an earlier state of it, as far as their faces, edges and
/// nodes are still there: nodes at the same coordinates. What is lost is said, in sentences. Sets of elements are kept
/// if no element changed.
std::vector<std::string> carry_groups(const TetMesh& before, TetMesh& mesh);

}  // namespace octafront
