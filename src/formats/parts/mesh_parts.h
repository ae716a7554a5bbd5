#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/groups.h"
#include "base/core/utf8.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/edge_nodes.h"
#include "base/mesh/label_at.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace octafront::io {

// formats/parts: a mesh between file and arrays. Readers leave elements and faces (raw_mesh.h, surface_builder.h),
// which become an ordered TetMesh or SurfaceMesh in one place; writers see regions, patches, curves and sets as one
// list of parts.

/// A region, patch, curve or further set of a mesh, as files have them.
struct Part {
  enum class Origin { kRegion, kPatch, kCurve, kSet };
  Origin origin;
  NamedSet::Kind kind;   ///< regions: elements; patches: faces; curves: edges
  std::uint32_t number;  ///< of the region, patch or curve, or place in `sets`
  std::uint32_t tag;     ///< the same for formats whose numbers are above 0: one more, or of a region tag_of_region()
  std::string name;      ///< as given, or made by default_name()
  bool is_named;         ///< false: the name was made
  std::span<const std::uint32_t> members;
};

/// The name of a part that has none: "body" or "body_2", "patch_3", "curve_4". `only`: there is no other one.
std::string default_name(Part::Origin origin, std::uint32_t number, bool only);

/// A face of a tetrahedron: the one opposite to its corner `face`.
struct Side {
  TetIndex tet;
  int face;
};

/// Room for the nodes of an element, face or edge of any order.
using CellRoom = std::array<VertexIndex, 35>;
using FaceRoom = std::array<VertexIndex, 15>;
using EdgeRoom = std::array<VertexIndex, 5>;

/// The nodes of elements of order 3 and 4, and of their faces and edges, in the order of VTK's Lagrange cells.
class HighNodes {
 public:
  /// Of a mesh of a lower order nothing may be asked.
  explicit HighNodes(const TetMesh& mesh);

  VertexIndex of_tet(std::size_t t, std::size_t k) const;
  /// Of a face, as its corners run, of the element beside it.
  VertexIndex of_face(const Side& side, const Triangle& corners, std::size_t k) const;
  /// Of an edge of a curve.
  VertexIndex of_edge(const Edge& edge, std::size_t k) const;

 private:
  struct Use {
    VertexIndex high;
    TetIndex tet;
  };
  /// The node of an element that has these weights.
  template <std::size_t kCorners>
  VertexIndex node(TetIndex t, const std::array<VertexIndex, kCorners>& corners,
                   const std::array<int, kCorners>& weights) const;

  const TetMesh& mesh_;
  Groups<Use, std::uint64_t> at_low_;  ///< edges between vertices of curves, at their lower ends
};

/// Node k of a cell of VTK of order 3 or 4 among those of tet_lattice(); of Gmsh among those of VTK.
std::size_t lattice_node_of_vtk(int order, std::size_t k);
std::size_t lattice_node_of_gmsh(int order, std::size_t k);
std::size_t vtk_node_of_gmsh(int order, std::size_t k);

/// A mesh as writers see it: the boundary and the interfaces as one list of faces, and all that has a number or name as
/// one list of parts, which every format turns into sets of its own. Refers to the mesh. O(mesh).
class MeshParts {
 public:
  /// What writers are not shown.
  struct Hidden {
    bool mid_nodes = false;  ///< those behind the corners, of any order, and the points that are nothing else
    bool faces = false;      ///< and edges, and all parts of them
    bool wide_cells = false;
    std::size_t last_points = 0;  ///< so many at the end, which are mid-side nodes
  };
  explicit MeshParts(const TetMesh& mesh) : MeshParts(mesh, Hidden{}) {}
  MeshParts(const TetMesh& mesh, Hidden hidden);

  const TetMesh& mesh() const { return mesh_; }
  /// Points that are to be written: the first ones of the mesh.
  std::size_t points() const { return points_; }
  /// Of these the corners of tetrahedra, which come first where there are others.
  std::size_t corner_points() const;
  std::size_t tets() const { return mesh_.tets.size(); }
  std::size_t faces() const { return hidden_.faces ? 0 : mesh_.boundary.size() + mesh_.interfaces.size(); }
  std::size_t edges() const { return hidden_.faces ? 0 : mesh_.curve_edges.size(); }
  /// Whether they have no faces and edges because none are wanted.
  bool cells_only() const { return hidden_.faces; }
  bool second_order() const { return second_order_; }
  std::span<const WideCell> wide_cells() const {
    return hidden_.wide_cells ? std::span<const WideCell>() : mesh_.wide_cells;
  }
  std::span<const WideFace> wide_faces() const {
    return hidden_.wide_cells ? std::span<const WideFace>() : mesh_.wide_faces;
  }

  const Triangle& face(std::size_t f) const {
    return f < mesh_.boundary.size() ? mesh_.boundary[f] : mesh_.interfaces[f - mesh_.boundary.size()];
  }
  std::uint32_t region_of(std::size_t t) const { return mesh_.region.empty() ? 0 : mesh_.region[t]; }
  /// The labels of regions, where each that occurs has one that files can hold; else empty.
  const std::vector<std::int32_t>& labels() const { return labels_; }
  /// What formats call region r that have a number above 0 for each: its label where all have one of their own, else
  /// r + 1.
  std::uint32_t tag_of_region(std::uint32_t r) const { return tag_of(Part::Origin::kRegion, r); }
  /// The same of a region, patch or curve.
  std::uint32_t tag_of(Part::Origin origin, std::uint32_t n) const {
    return are_tags_[static_cast<std::size_t>(origin)] ? static_cast<std::uint32_t>(label_at(labels_of(origin), n))
                                                       : n + 1;
  }
  /// What formats call it that hold any number: its label where it has one (of regions: each its own), else n + 1.
  std::int64_t number_of(Part::Origin origin, std::uint32_t n) const {
    return are_numbers_[static_cast<std::size_t>(origin)] ? label_at(labels_of(origin), n) : std::int64_t{n} + 1;
  }
  std::uint32_t patch_of(std::size_t f) const {
    const bool inside = f >= mesh_.boundary.size();
    const auto& patch = inside ? mesh_.interface_patch : mesh_.patch;
    return patch.empty() ? 0 : patch[inside ? f - mesh_.boundary.size() : f];
  }
  std::uint32_t curve_of(std::size_t e) const { return mesh_.curve.empty() ? 0 : mesh_.curve[e]; }

  /// Corners and, at second order, mid-side nodes, in the order of VTK (edges 12 23 13 14 24 34; 12 23 31; 12). At
  /// order 3 and 4 that of VTK's Lagrange cells: of edges 12 23 31 14 24 34, of faces, inside.
  std::span<const VertexIndex> tet_nodes(std::size_t t, CellRoom& room) const;
  std::span<const VertexIndex> face_nodes(std::size_t f, FaceRoom& room) const;
  std::span<const VertexIndex> edge_nodes(std::size_t e, EdgeRoom& room) const;
  /// One of them.
  VertexIndex tet_node(std::size_t t, std::size_t k) const {
    constexpr std::array<std::uint8_t, 6> kMids{0, 3, 1, 2, 4, 5};  // of kTetEdges
    if (order_ > 2) return high_.of_tet(t, k);
    return k < 4 ? mesh_.tets[t][k] : mesh_.mid_nodes[t][kMids[k - 4]];
  }
  /// The same in the order of tet_lattice().
  VertexIndex lattice_node(std::size_t t, std::size_t k) const {
    return k < 4         ? mesh_.tets[t][k]
           : order_ == 2 ? mesh_.mid_nodes[t][k - 4]
                         : mesh_.high_nodes[t * (nodes_per_tet() - 4) + k - 4];
  }
  VertexIndex face_node(std::size_t f, std::size_t k) const {
    const Triangle& t = face(f);
    if (order_ > 2) return high_.of_face(sides()[f], t, k);
    return k < 3 ? t[k] : mids_(t[k - 3], t[(k - 2) % 3]);
  }
  VertexIndex edge_node(std::size_t e, std::size_t k) const {
    const Edge& edge = mesh_.curve_edges[e];
    if (order_ > 2) return high_.of_edge(edge, k);
    return k < 2 ? edge[k] : mids_(edge[0], edge[1]);
  }
  /// Of an edge between vertices of faces or curves.
  VertexIndex mid_node(VertexIndex a, VertexIndex b) const { return mids_(a, b); }
  std::size_t nodes_per_tet() const { return octafront::nodes_of_tet(order_); }
  std::size_t nodes_per_face() const { return static_cast<std::size_t>((order_ + 1) * (order_ + 2) / 2); }
  std::size_t nodes_per_edge() const { return static_cast<std::size_t>(order_ + 1); }
  /// 1 to 4: that of the elements that are written.
  int order() const { return order_; }

  /// Per face the tetrahedron that it looks out of (for an interface one of its two). Made at the first call.
  const std::vector<Side>& sides() const;

  /// Regions, patches and curves that have members, ascending, then the sets of the mesh.
  const std::vector<Part>& parts() const { return parts_; }
  /// Those of one origin.
  std::span<const Part> parts(Part::Origin origin) const;
  /// What had to change for them to be UTF-8 without control characters, as writers get them; empty: nothing.
  std::string note_on_names() const { return names_.note(); }
  /// The nodes of a part, ascending, mid-side nodes too.
  std::vector<VertexIndex> nodes_of(const Part& part) const;

 private:
  const std::vector<std::int64_t>& labels_of(Part::Origin origin) const {
    return origin == Part::Origin::kRegion  ? mesh_.region_labels
           : origin == Part::Origin::kPatch ? mesh_.patch_labels
                                            : mesh_.curve_labels;
  }
  void take_labels(Part::Origin origin);
  void add_numbered(Part::Origin origin, const Groups<>& members, const std::vector<std::uint32_t>& numbers,
                    const std::vector<std::string>& names);

  const TetMesh& mesh_;
  Hidden hidden_;
  bool second_order_;
  int order_;
  std::size_t points_;
  EdgeNodes mids_;
  HighNodes high_;
  std::array<Groups<>, 3> groups_;
  std::array<std::vector<std::uint32_t>, 3> numbers_;
  std::vector<Part> parts_;
  NameCleaning names_;
  std::vector<std::int32_t> labels_;
  std::array<bool, 3> are_tags_{}, are_numbers_{};  ///< the labels of regions, patches, curves
  mutable std::vector<Side> sides_;
};

/// Elements of one kind by the parts that they are in: every combination that occurs once, in order. Formats whose
/// elements have one place each (entities, families) name those places by several parts.
struct Combinations {
  std::vector<std::vector<std::uint32_t>> parts;  ///< of each combination: indices into MeshParts::parts(), ascending
  Groups<> members;                               ///< its elements; nodes in no set are in none
  std::vector<std::uint32_t> of;                  ///< per element its combination; kNone: none
};
Combinations combinations(const MeshParts& mesh, NamedSet::Kind kind);

/// Numbers of elements that occur, ascending, and the elements of each.
struct ByNumber {
  std::vector<std::uint32_t> numbers;
  Groups<> members;
};
template <class NumberOf>
ByNumber by_number(std::uint32_t count, const NumberOf& number_of) {
  // Consecutive elements mostly share a number: equal neighbours are passed over before sorting.
  constexpr std::size_t kRange = 8192;
  ByNumber by;
  by.numbers = parallel_collect<std::uint32_t>(
      count, kRange, [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
        for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
          if (const std::uint32_t number = number_of(i); found.empty() || found.back() != number)
            found.push_back(number);
      });
  std::sort(by.numbers.begin(), by.numbers.end());
  by.numbers.erase(std::unique(by.numbers.begin(), by.numbers.end()), by.numbers.end());
  const auto slot = [&](std::uint32_t i) {
    return std::lower_bound(by.numbers.begin(), by.numbers.end(), number_of(i)) - by.numbers.begin();
  };
  by.members = group_by_owner(by.numbers.size(), count, slot);
  return by;
}

}  // namespace octafront::io
