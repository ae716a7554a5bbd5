// What a format cannot hold is said, never dropped in silence.

#include <octafront/named_groups.h>

#include "formats/files/formats.h"

#include <algorithm>
#include <set>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Origin = Part::Origin;

class Losses {
 public:
  Losses(const FormatInfo& format, const MeshParts& mesh) : format_(format), mesh_(mesh) {}

  std::vector<std::string> all() {
    const FormatHolds& holds = format_.holds;
    if (!holds.second_order && mesh_.mesh().is_second_order())
      lose(fmt::format("holds linear elements only: {} mid-side nodes are left out",
                       mesh_.mesh().points.size() - mesh_.points()));
    if (!holds.high_order && mesh_.mesh().high_order > 0)
      lose(fmt::format("holds no elements of order {}: {} nodes are left out, and elements are linear; {} hold them{}",
                       mesh_.mesh().order(), mesh_.mesh().points.size() - mesh_.points(), names_of_high_order(),
                       way_out()));
    if (const std::size_t wide = mesh_.mesh().wide_cells.size(); mesh_.wide_cells().size() < wide)
      lose(fmt::format("is given no wedges and pyramids{} here: {} are written as their tetrahedra",
                       !holds.wide_cells ? "" : fmt::format(" of order {}", mesh_.mesh().order()), wide));
    if (!holds.doubles) lose("holds single precision: coordinates are rounded to seven digits");
    numbered("region", mesh_.parts(Origin::kRegion), holds.regions);
    numbered("patch", mesh_.parts(Origin::kPatch), holds.patches);
    numbered("curve", mesh_.parts(Origin::kCurve), holds.curves);
    renumbered("regions", mesh_.parts(Origin::kRegion), holds.regions);
    renumbered("patches", mesh_.parts(Origin::kPatch), holds.patches);
    renumbered("curves", mesh_.parts(Origin::kCurve), holds.curves);
    if (mesh_.cells_only()) leave_out_faces();
    if (!holds.interfaces && !mesh_.cells_only() && !mesh_.mesh().interfaces.empty())
      lose(fmt::format("holds no faces inside: {} are left out", mesh_.mesh().interfaces.size()));
    sets("nodes", NamedSet::Kind::kNodes, holds.node_sets);
    sets("edges", NamedSet::Kind::kEdges, holds.edge_sets);
    sets("faces", NamedSet::Kind::kFaces, holds.face_sets);
    sets("elements", NamedSet::Kind::kElements, holds.element_sets);
    return std::move(notes_);
  }

 private:
  void lose(const std::string& what) { notes_.push_back(fmt::format("{} {}", format_.title, what)); }

  static std::string names_of_high_order() {
    std::string names;
    for (const Format& other : formats())
      if (other.info.holds.high_order && other.info.writes_mesh)
        names += (names.empty() ? "" : ", ") + std::string(other.info.name);
    return names;
  }

  /// For programs that read the format.
  std::string_view way_out() const {
    return format_.name == "xdmf" ? "; DOLFINx reads order 3 from msh (gmshio), and takes order 4 as arrays" : "";
  }

  void leave_out_faces() {
    const TetMesh& mesh = mesh_.mesh();
    notes_.push_back(fmt::format("cells only: {} faces and {} edges are left out, and patches, curves and sets of them",
                                 mesh.boundary.size() + mesh.interfaces.size(), mesh.curve_edges.size()));
  }

  void numbered(std::string_view what, std::span<const Part> parts, Keeps keeps) {
    const auto named = std::count_if(parts.begin(), parts.end(), [](const Part& p) { return p.is_named; });
    // One part without a name is what a mesh has that was never divided; curves are always somebody's wish.
    const bool matters = parts.size() > 1 || named > 0 || (what == "curve" && !parts.empty());
    const std::string_view several = what == "patch" ? "patches" : what == "curve" ? "curves" : "regions";
    if (keeps == Keeps::kNothing && matters) lose(fmt::format("holds no {}: {} are left out", several, parts.size()));
    if (keeps == Keeps::kNumbers && named > 0) lose(fmt::format("holds no names of {}, only their numbers", several));
    if (keeps == Keeps::kNodeSets && !parts.empty()) lose(fmt::format("holds {} as sets of nodes", several));
  }

  bool is_medit() const { return format_.name == "medit" || format_.name == "meditb"; }

  /// Numbers below 1, and others that are not the tags of parts, which have no names beside them.
  void renumbered(std::string_view what, std::span<const Part> parts, Keeps keeps) {
    if (is_medit() || format_.name == "tetgen" || keeps == Keeps::kNothing) return;
    const bool has_labels = what == "regions" && format_.endings.starts_with(".vt") && !mesh_.labels().empty();
    std::string changes;
    std::size_t changed = 0;
    constexpr std::size_t kShown = 4;
    for (const Part& part : parts) {
      const std::int64_t number = mesh_.number_of(part.origin, part.number);
      if (part.is_named || number == std::int64_t{part.tag}) continue;
      if (++changed <= kShown) changes += fmt::format("{}{} for {}", changes.empty() ? "" : ", ", part.tag, number);
    }
    // A mesh whose only number is 0 has none.
    const bool says_nothing = parts.size() == 1 && mesh_.number_of(parts[0].origin, parts[0].number) == 0;
    if (changed == 0 || has_labels || says_nothing) return;
    lose(fmt::format("has other numbers of {}: {}{}", what, changes, changed > kShown ? ", ..." : ""));
  }

  void sets(std::string_view of, NamedSet::Kind kind, bool holds) {
    if (holds) return;
    std::string names;
    for (const Part& p : mesh_.parts(Origin::kSet))
      if (p.kind == kind && !(is_medit() && medit_set(mesh_.mesh().sets[p.number])))
        names += (names.empty() ? "" : ", ") + one_line(p.name);
    if (!names.empty()) lose(fmt::format("holds no further sets of {}: left out are {}", of, names));
  }

  const FormatInfo& format_;
  const MeshParts& mesh_;
  std::vector<std::string> notes_;
};

}  // namespace

std::vector<std::string> losses(const FormatInfo& format, const MeshParts& mesh) {
  return Losses(format, mesh).all();
}

std::string loss_of_fields(const FormatInfo& format, std::span<const MeshField> fields) {
  if (fields.empty() || format.holds.fields) return {};
  // One at nodes and one of elements are often of one name.
  std::set<std::string> known;
  std::string names, holders;
  for (const MeshField& field : fields)
    if (known.insert(field.name).second) names += (names.empty() ? "" : ", ") + in_quotes(field.name);
  for (const Format& other : formats())
    if (other.info.holds.fields && other.info.writes_mesh)
      holders += (holders.empty() ? "" : ", ") + std::string(other.info.name);
  return fmt::format("{} holds no fields: left out are {}; fields are held by {}", format.title, names, holders);
}

}  // namespace octafront::io
