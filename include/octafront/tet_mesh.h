#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// Index of a tetrahedron in the `tets` of its mesh.
using TetIndex = std::uint32_t;

/// The anatomy of a tetrahedron, drawn once; everything else refers to it.
///
///            d                 Positive: seen from d, a, b, c turn counter-clockwise; that is
///           /|\                  orient3d(a, b, c, d) = ((b - a) x (c - a)) . (d - a) > 0.
///          / | \                 The unit tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1) is positive.
///         /  |  \              Face i is opposite corner i; its corners, as kTetFaces lists them, run
///        a---|---c               counter-clockwise seen from outside.
///         \  |  /              Half-face h = 4 * tet + i is face i of that tet.
///          \ | /               (This is the order of VTK, Gmsh and MEDIT.)
///            b
using Tet = std::array<VertexIndex, 4>;

/// Corners of face i (opposite corner i), counter-clockwise seen from outside.
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
/// Corners of the six edges.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// A named set of parts of a mesh, overlapping others or not.
struct NamedSet {
  enum class Kind { kNodes, kEdges, kFaces, kElements };
  std::string name;
  Kind kind = Kind::kNodes;
  /// Ascending, each once. Nodes: indices into points (mid-side nodes too); elements: into tets; edges: into
  /// curve_edges; faces: into boundary, and, counting on behind it, into interfaces.
  std::vector<std::uint32_t> members;

  friend bool operator==(const NamedSet&, const NamedSet&) = default;
};

/// A wedge or pyramid that consecutive tetrahedra of a mesh make up, as boundary layers do.
struct WideCell {
  TetIndex first = 0;           ///< of its tetrahedra
  std::uint32_t tet_count = 0;  ///< 3: a wedge; 2: a pyramid
  /// Wedge: a triangle, counter-clockwise seen from the other one, and that one above it. Pyramid: its base,
  /// counter-clockwise seen from the apex, the apex, kNone.
  std::array<VertexIndex, 6> nodes{};

  friend bool operator==(const WideCell&, const WideCell&) = default;
};

/// A quadrilateral of wedges and pyramids that two consecutive boundary faces make up, counter-clockwise seen from
/// outside.
struct WideFace {
  std::uint32_t first = 0;
  std::array<VertexIndex, 4> nodes{};

  friend bool operator==(const WideFace&, const WideFace&) = default;
};

/// A face inside whose nodes were doubled (split_patches()): what a cohesive element of no height connects.
struct SplitFace {
  /// The corners of the face of the element behind it, counter-clockwise seen from in front, and their partners in
  /// front. At the end of a sheet they are the same.
  std::array<VertexIndex, 6> nodes{};
  std::uint32_t patch = 0;  ///< of its side in front, NAME_plus

  friend bool operator==(const SplitFace&, const SplitFace&) = default;
};

/// A contact that is open: two patches of the boundary that lie on each other, with nodes of their own.
struct OpenedContact {
  std::uint32_t first = 0, second = 0;  ///< patches; those of split_contacts() are `A|B` of part A and `B|A` of part B
  std::uint32_t conforming = 1;         ///< 1: their triangles are the same; 0: each has its own

  friend bool operator==(const OpenedContact&, const OpenedContact&) = default;
};

/// A tetrahedral mesh as flat arrays: linear, or of second order.
///
/// What leaves the library is *valid* (see first_defect): every tet is positive by exact sign, every face belongs to
/// one or two tets, the faces that belong to one are exactly `boundary`, and no vertex is unused.
///
/// Triangles and edges have no mid-side nodes of their own: theirs are those of the tetrahedra at them.
struct TetMesh {
  std::vector<Vec3> points;                 ///< input units
  std::vector<Tet> tets;                    ///< positive, indices into points
  std::vector<std::uint32_t> region;        ///< one per tet: number of the body it lies in; empty: all 0
  std::vector<std::string> region_names;    ///< region r is region_names[r]; may be shorter than the number of regions
  std::vector<std::int64_t> region_labels;  ///< as in SurfaceMesh
  std::vector<std::int64_t> patch_labels;   ///< the same
  std::vector<std::int64_t> curve_labels;   ///< the same, of curves
  std::vector<Triangle> boundary;           ///< the boundary faces, counter-clockwise seen from outside
  std::vector<std::uint32_t> patch;         ///< one per boundary face: its patch; empty: all 0
  std::vector<std::uint32_t> source;     ///< one per boundary face: the input face nearest to it, or it; kNone: none,
                                         ///< for it was split; may be empty
  std::vector<std::string> patch_names;  ///< as in SurfaceMesh; also of the patches of interfaces
  std::vector<Triangle> interfaces;      ///< faces inside that belong to a patch: between regions, or sheets; either
                                         ///< side may be in front
  std::vector<std::uint32_t> interface_patch;  ///< one per interface: its patch; empty: all 0
  std::vector<Edge> curve_edges;               ///< edges of tets that lie on curves; either end may come first
  std::vector<std::uint32_t> curve;            ///< one per curve edge: its curve; empty: all 0
  std::vector<std::string> curve_names;        ///< curve c is curve_names[c]; may be shorter than the number of curves
  /// Second order: the mid-side nodes of each tet in the order of kTetEdges, shared by the tets at an edge. They are
  /// points like others, behind all corners. Empty: the mesh is linear.
  std::vector<std::array<VertexIndex, 6>> mid_nodes;
  /// Order 3 or 4: the nodes of each tet behind its corners, one tet after the other; they lie where the barycentric
  /// coordinates are multiples of 1/order: of each edge of kTetEdges those from its first end to its second, of each
  /// face of kTetFaces those inside (of order 4 the one nearest to its first corner first), at order 4 one in the
  /// middle. Shared by the tets at an edge or face; points like others, behind all corners. Then `mid_nodes` is empty.
  std::vector<VertexIndex> high_nodes;
  std::uint32_t high_order = 0;  ///< 3 or 4; 0: there are none
  std::vector<NamedSet> sets;    ///< further named parts: what a user asked for, or a file had
  /// Ascending. Files whose formats have wedges and pyramids get these in the place of their tetrahedra; each
  /// quadrilateral between two of them or at the boundary is whole on both sides. Empty: tetrahedra only.
  std::vector<WideCell> wide_cells;
  std::vector<WideFace> wide_faces;  ///< the quadrilaterals of `boundary`; ascending
  /// Translations that lead from a face of the mesh to the one that is its copy: of a periodic cell. Empty: of none.
  std::vector<Vec3> periods;
  /// One per period, the rows of a matrix R: it is a rotation, and x goes to R x + the translation. Empty: none is.
  std::vector<std::array<Vec3, 3>> period_rotations;
  /// Of a periodic cell: the number of the period, the node that is the copy, and the one that it is a copy of;
  /// ascending, mid-side nodes too. points[copy] is points[original] + the period, each coordinate in one rounding; by
  /// a rotation each coordinate is ((R0 x + R1 y) + R2 z) + t, rounded at each step.
  std::vector<std::array<std::uint32_t, 3>> periodic_nodes;
  /// One per boundary face and, behind them, interface: how many boundary layers grow at each corner of it, at least;
  /// kNone: it is no wall of any. Empty: not known.
  std::vector<std::uint32_t> face_layers;
  std::vector<SplitFace> split_faces;          ///< faces of the boundary that touch, where the mesh was split; by patch
  std::vector<OpenedContact> opened_contacts;  ///< by their first patches

  bool is_second_order() const { return !mid_nodes.empty(); }
  /// 1 to 4.
  int order() const { return high_order > 0 ? static_cast<int>(high_order) : is_second_order() ? 2 : 1; }
  /// So many of `high_nodes` are each tet's.
  std::size_t high_nodes_per_tet() const {
    return high_order == 0 ? 0 : (high_order + 1) * (high_order + 2) * (high_order + 3) / 6 - 4;
  }
  /// How many there are of what sets of this kind are made of.
  std::size_t count(NamedSet::Kind kind) const {
    switch (kind) {
      case NamedSet::Kind::kNodes:
        return points.size();
      case NamedSet::Kind::kEdges:
        return curve_edges.size();
      case NamedSet::Kind::kFaces:
        return boundary.size() + interfaces.size();
      default:
        return tets.size();
    }
  }
  friend bool operator==(const TetMesh&, const TetMesh&) = default;
};

}  // namespace octafront
