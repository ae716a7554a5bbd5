#pragma once

// base/places: one language of places (docs/use/places.md), for every option that takes one. Takes what people write
// and a surface or a mesh; leaves what lies there, or says what there is. Sets of a mesh, and openings in it, there.

#include <octafront/named_groups.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "base/mesh/edge_table.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace octafront {

/// A place as it is written: a name or number, patches, a box or a ball.
struct Place {
  std::string text;
  std::variant<std::string, std::vector<std::string>, Box3, GroupRule::Sphere> where;

  bool is_in_space() const { return where.index() > 1; }
};

/// Reads NAME, 3, patches:A,B, box:X0,Y0,Z0,X1,Y1,Z1 or sphere:X,Y,Z,R. `option` is who asks, in messages. Throws
/// OptionError where numbers are missing or none.
Place place_of(std::string_view option, const std::string& text);

/// The places in a list, with `separator` between. Names themselves may hold it: what is called like more of the list
/// comes first.
std::vector<Place> places_listed(std::string_view option, const std::string& list, char separator,
                                 std::span<const std::string> known);

/// What a part is called that may have no name: "patch_3" is the third patch.
std::string patch_label(const std::vector<std::string>& names, std::uint32_t patch);

/// Which of the names a name stands for, ascending: those that are it, or a piece of it, "A|B#2" of "A|B", where
/// "A|B#1" is the first alone; else those of a name that stands for one in each pair of regions, "fault" for "fault
/// (clay|sand)"; else "B|A" for "A|B".
std::vector<std::uint32_t> named_so(const std::vector<std::string>& names, const std::string& name);
/// A name that named_so() takes for this one alone.
std::string alone(const std::vector<std::string>& names, const std::string& name);

/// What the sides of a contact of parts a and b are called: "A|B" of A's and "B|A" of B's, with what stands behind it
/// ("#2") or around it; "seat (A|B)" and "seat (B|A)" of one that has a name of its own.
std::array<std::string, 2> names_of_sides(const std::string& name, const std::string& a, const std::string& b);

/// The patches among the first ones, `is_there`, that are called so: by name, as named_so() says; else by number, from
/// 1, or as "patch_3". None if there is none.
std::vector<std::uint32_t> patches_called(const std::vector<std::string>& names, const std::vector<char>& is_there,
                                          const std::string& name);
/// The same; throws OptionError if there is none.
std::vector<std::uint32_t> patches_called(std::string_view option, const std::vector<std::string>& names,
                                          const std::vector<char>& is_there, const std::string& name);

/// Whether a division by angle or split_patches() calls a patch so, or what has no name: "3", "patch_3", "wall.2",
/// "glue_plus", "body_2".
bool is_made_later(const std::string& name);
/// "seat" of "seat (A|B)", a side of a contact that is opened; else the name.
std::string without_sides(const std::string& name);

/// Names of one kind of part, "region", "patch", "curve" or "set".
struct NamesOfKind {
  std::string_view kind;
  std::vector<std::string> names;
};
/// "there is no patch "lid"; patches: wall, patch_2": without what is asked of it, of every kind the first names.
std::string no_such_place(const std::string& name, const std::vector<NamesOfKind>& there);

/// What lies at a place of a surface.
struct SurfaceItems {
  std::vector<std::uint32_t> regions;
  std::vector<std::uint32_t> triangles;  ///< of patches, or with all corners in a box or ball; ascending
  std::vector<Edge> edges;               ///< of a curve
};

/// The places of a surface or complex. Refers to it, and to its edges: null, and no curve is known.
class SurfacePlaces {
 public:
  explicit SurfacePlaces(const SurfaceMesh& surface, const EdgeTable* edges = nullptr);

  /// The names of its patches, "patch_3" among them, and of its regions.
  const std::vector<std::string>& patches() const { return patches_; }
  const std::vector<std::string>& regions() const { return regions_; }
  std::vector<std::string> names_of_curves() const;
  /// Throws OptionError if nothing is called so.
  SurfaceItems at(std::string_view option, const Place& place) const;

 private:
  std::vector<std::uint32_t> triangles_of(const std::vector<std::uint32_t>& patches) const;
  std::vector<std::pair<std::string, Edge>> curves() const;
  SurfaceItems called(std::string_view option, const std::string& name) const;
  [[noreturn]] void refuse(std::string_view option, const std::string& name) const;

  const SurfaceMesh& surface_;
  const EdgeTable* edges_;
  std::vector<char> is_there_;  ///< per patch
  std::vector<std::string> patches_, regions_;
};

/// Members as of a NamedSet of each kind, in no order.
struct MeshItems {
  std::vector<std::uint32_t> nodes, edges, faces, tets;

  bool empty() const { return nodes.empty() && edges.empty() && faces.empty() && tets.empty(); }
};
/// The elements of the region, the faces of the patch, the edges of the curve and the members of the sets that are
/// called so; of a box or ball all whose nodes, or corners, lie in it. Throws OptionError if nothing is called so.
MeshItems items_at(const TetMesh& mesh, std::string_view option, const Place& place);

}  // namespace octafront
