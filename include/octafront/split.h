#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// Opens a mesh along faces inside: patches between two regions, or sheets (cracks, faults), by name or number (from
/// 1). Each node there is doubled as often as the elements around it come apart: where patches cross there are more
/// than two, at the end of a sheet inside, the tip of a crack, it stays one. Coordinates stay the same, so the two
/// sides touch.
///
/// Of a patch `fault` the faces of the elements in front of it, where its triangles' normals point, become the patch
/// `fault_plus` of the boundary, those of the elements behind it `fault_minus`; `split_faces` tells which belong
/// together. Of a name that stands for patches in several regions, "fault (clay|clay)", all are opened. A face all of
/// whose corners lie at the end of a sheet stays closed. Sets and curves that have a doubled node or edge have its
/// copies, too; further sets of faces have both sides.
///
/// Returns sentences for the user: what was done. Throws OptionError, before any change, where a patch does not exist
/// or has no face inside. O(mesh).
std::vector<std::string> split_patches(TetMesh& mesh, const std::vector<std::string>& places);

/// Opens the contacts of parts: the faces between two regions that lie in one of these patches. Nodes are doubled as
/// split_patches() does, also where contacts meet, so that parts come apart that no other contact holds together.
///
/// A contact `A|B` becomes the patches `A|B`, the faces of the elements of A, and `B|A`, those of B; a piece `A|B#2`
/// both with this number. One with a name of its own, `seat`, becomes `seat (A|B)` and `seat (B|A)`. One of the two has
/// the number of the patch before, and `opened_contacts` tells which belong together.
std::vector<std::string> split_contacts(TetMesh& mesh, const std::vector<std::uint32_t>& patches);

/// How parts meet in a contact.
enum class ContactWay {
  kShared,   ///< one face, one set of nodes
  kSplit,    ///< opened: the same triangles on both sides, nodes doubled
  kSeparate  ///< each part has triangles of its own, by its own sizes
};

/// What is asked of the contacts of an input; later rules come before earlier ones, and these before `all`.
struct ContactChoice {
  struct Rule {
    std::string contact;  ///< `A|B` (either way round, all its pieces), a patch, or a part: all contacts of it
    ContactWay way = ContactWay::kShared;
  };
  ContactWay all = ContactWay::kShared;
  std::vector<Rule> rules = {};

  bool is_shared() const { return all == ContactWay::kShared && rules.empty(); }
};

/// What the other side of an opening may be called, by the name of a patch: `fault_minus` of `fault_plus`, `B|A#2` of
/// `A|B#2`, `seat (B|A)` of `seat (A|B)`. Names of parts may have bars, so there may be several; none: it is no side.
std::vector<std::string> other_sides(const std::string& patch);

/// The patches with faces between two regions, ascending.
std::vector<std::uint32_t> contacts_of(const TetMesh& mesh);

/// Throws OptionError if a mesh of this complex would have nothing to split under one of these names.
void check_split(const SurfaceMesh& complex, const std::vector<std::string>& places);

}  // namespace octafront
