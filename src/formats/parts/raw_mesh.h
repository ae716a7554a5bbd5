#pragma once

#include <octafront/io.h>

#include "formats/containers/input.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

/// Where mid-side nodes stand behind the corners: place i of a file's list is the edge kMids[i] of kTetEdges (12 13 14
/// 23 24 34).
using MidOrder = std::array<std::uint8_t, 6>;
/// 12 23 13 14 24 34, of nearly all formats.
inline constexpr MidOrder kVtkMids{0, 3, 1, 2, 4, 5};
/// 12 23 13 14 34 24.
inline constexpr MidOrder kGmshMids{0, 3, 1, 2, 5, 4};
/// 12 13 14 23 24 34: MEDIT, Netgen.
inline constexpr MidOrder kPlainMids{0, 1, 2, 3, 4, 5};

/// A mesh as a file has it: before orientation, boundary and numbering are put in order. All indices are known to be in
/// range.
struct RawMesh {
  /// What a format calls by a name alone. Members: points, edges, triangles or tets of this struct.
  struct Group {
    std::string name;
    NamedSet::Kind kind;
    std::vector<std::uint32_t> members = {};
  };

  /// A map x' = R x + shift that leads nodes to others, and these: {copy, original}.
  struct Period {
    std::array<Vec3, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Vec3 shift;
    std::vector<std::array<VertexIndex, 2>> pairs = {};
  };

  /// What Input::field asks for. A field has values at points or in elements.
  struct Field {
    std::vector<std::string> names;  ///< of all that could be asked for, as the file lists them
    std::vector<double> at_points;   ///< one per point, or empty; of tensors `components` per point
    std::uint64_t components = 1;
    /// One per element, or as many as Input::wants_element_tensors lets there be, or empty. Of triangles there may be
    /// fewer than there are beside tetrahedra.
    std::vector<double> at_tets, at_triangles;

    /// Enters the name of one that is there; whether its values are asked for.
    bool offer(const Input& input, std::string_view name, std::uint64_t of_components = 1);
    /// Enters the value, or values, of the tetrahedra and triangles that `raw` has more than values.
    void take(double value, const RawMesh& raw) { take({&value, 1}, raw); }
    void take(std::span<const double> values, const RawMesh& raw);
  };

  std::string format;  ///< for messages, e.g. "Gmsh MSH 4.1"
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  std::vector<std::array<VertexIndex, 6>> mid_nodes;  ///< one per tet, in the order of kTetEdges; empty: linear
  /// Of order 3 or 4: as TetMesh::high_nodes. Fewer than all tets need: some have none.
  std::vector<VertexIndex> high_nodes;
  std::uint32_t high_order = 0;
  std::vector<std::int64_t> tet_ref;  ///< one per tet; empty: regions come from groups
  std::vector<Triangle> triangles;
  std::vector<std::int64_t> triangle_ref;      ///< one per triangle; empty: patches come from groups
  std::vector<std::uint32_t> triangle_source;  ///< one per triangle, or empty
  std::vector<std::uint32_t> triangle_layers;  ///< as TetMesh::face_layers: one per triangle, or empty
  std::vector<Edge> edges;
  std::vector<std::int64_t> edge_ref;  ///< as of triangles
  std::vector<WideCell> wide_cells;    ///< made by add_wide_cell(), ascending
  /// Made by add_face() of quadrilaterals, linear or not; in the order of the triangles.
  std::vector<WideFace> wide_faces;
  std::map<std::int64_t, std::string> region_names, surface_names, curve_names;  ///< by reference
  std::map<std::int64_t, std::int64_t> region_labels;  ///< by reference: TetMesh::region_labels
  std::vector<Group> groups;
  std::vector<Period> periods;
  std::uint64_t other_elements = 0;  ///< of kinds that a TetMesh does not hold
  std::uint64_t hexahedra = 0;       ///< that were divided
  std::vector<std::string> notes;
  Field field;

  /// Adds a tetrahedron whose nodes are corners, then mid-side nodes in that order, if it has them. A file must not mix
  /// both kinds; ordered_mesh() refuses it.
  void add_tet(std::span<const VertexIndex> nodes, std::int64_t ref, const MidOrder& order = kVtkMids);
  /// The same of order 3 or 4; `nodes` in the order of tet_lattice().
  void add_high_tet(std::span<const VertexIndex> nodes, std::int64_t ref);
  /// Adds the two or three tetrahedra of a pyramid (5 or 13 nodes: its base, the apex) or wedge (6 or 15 nodes: a
  /// triangle and the one above it), in the order of kPlainWide. Their quadrilaterals are divided from the lowest node,
  /// so that neighbours match (J. Dompierre et al., How to subdivide pyramids, prisms and hexahedra into tetrahedra,
  /// 1999). A wedge with an edge of no length between its triangles is a pyramid, with two a tetrahedron.
  /// `rank`: the numbers of points by which one is the lowest; empty: their indices. Returns how many tetrahedra.
  std::uint32_t add_wide_cell(std::span<const VertexIndex> nodes, std::int64_t ref,
                              std::span<const std::uint64_t> rank = {});
  /// Adds the tetrahedra of a hexahedron (its first eight nodes: a quadrilateral, and the one above it), divided in the
  /// same way; those of an edge or face of no length are left out. That it was one is forgotten.
  std::uint32_t add_hexahedron(std::span<const VertexIndex> nodes, std::int64_t ref,
                               std::span<const std::uint64_t> rank = {});
  /// Adds a triangle, of three nodes or six, or the two of a quadrilateral, of four, eight or nine, along its shorter
  /// diagonal; beside wedges and pyramids ordered_mesh() divides it as they are. The points must be known. Returns how
  /// many triangles.
  std::uint32_t add_face(std::span<const VertexIndex> nodes, std::int64_t ref);
};

/// Turns inverted tetrahedra, drops unused vertices and triangles that bound nothing, adds boundary faces that are
/// missing (in a patch of their own), turns triangles outward, and numbers regions and patches: reference r becomes
/// r - 1 where all references are small and positive, else they are counted through in increasing order. Triangles
/// between two tetrahedra become interfaces; edges of no tetrahedron go. Groups become what MeshFile says. Throws
/// InputError if there are no tetrahedra, or if their mid-side nodes contradict each other.
MeshFile ordered_mesh(RawMesh raw, const Input& input);

/// The triangles as a surface, references or groups as patches; of a mesh with tetrahedra its boundary and interfaces,
/// with the regions on both sides. Throws InputError if there are no triangles.
SurfaceFile surface_of(RawMesh raw, const Input& input);

}  // namespace octafront::io
