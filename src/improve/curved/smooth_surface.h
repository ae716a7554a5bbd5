#pragma once

// The smooth surface and the smooth feature curves that an input of triangles stands for.
//
// At each vertex, and on each side of a feature edge for itself, a height over the tangent plane, a polynomial of
// degree four, is fitted to the three rings of vertices around; a point of a triangle lies where the fits of its three
// corners say, averaged by its barycentric coordinates (weighted averaging of local fittings: X. Jiao, D. Wang,
// "Reconstructing high-order surfaces for meshing", 2012). The surface passes through the vertices of the input;
// distances to a smooth surface fall with the fifth power of the input's edge length, where flat triangles have the
// second. Feature curves are done likewise with the vertices along them. Where the vertices do not look like those of a
// smooth surface it is the input's own.

#include <octafront/surface_mesh.h>

#include "base/core/groups.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/features.h"
#include "improve/curved/local_fit.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace octafront::curved {

/// A point of the input's triangles, or of the segments of its feature edges.
struct Foot {
  Vec3 at;
  std::uint32_t on = kNone;  ///< triangle, or feature edge
};

class SmoothSurface {
 public:
  /// `sharp`: the features by angle alone, for a patch may end where the surface is smooth. `tree` over the triangles.
  /// Surface and tree must outlive this.
  SmoothSurface(const SurfaceMesh& surface, const EdgeTable& edges, const TriangleTree& tree, Features sharp);

  /// The nearest point of the triangles within `reach` of p whose normal does not point away from `normal` (unit).
  std::optional<Foot> surface_foot(Vec3 p, Vec3 normal, double reach) const;
  /// The nearest point of the sharp feature edges within `reach`.
  std::optional<Foot> curve_foot(Vec3 p, double reach) const;
  /// Whether a foot on a curve lies where curves end, meet or bend sharply.
  bool is_corner(const Foot& on_curve, double tolerance) const;

  /// Makes the fits that these feet need; in parallel.
  void prepare(std::span<const Foot> on_surface, std::span<const Foot> on_curves);
  /// The points of the smooth surface and curves; REQUIRES that the feet were prepared.
  Vec3 surface_point(const Foot& foot) const;
  Vec3 curve_point(const Foot& foot) const;

 private:
  using Wedge = std::uint32_t;  ///< the triangles at a vertex between two feature edges: its side of the surface

  void find_wedges(const EdgeTable& edges);
  SurfaceFit make_fit(Wedge wedge) const;
  /// Height of the triangle times the angle by which the surface turns there, over the edge where that is most; not
  /// over sharp ones: beside these its neighbours tell.
  double sag(std::uint32_t triangle) const;
  /// The same over one edge, which is not sharp.
  double sag_over(std::uint32_t half_edge) const;
  /// Whether a fit leaves the triangles at its vertex no farther than their neighbours let them expect.
  bool stays_near(const SurfaceFit& fit, Wedge wedge) const;
  CurveFit make_curve_fit(std::uint32_t end) const;
  /// Length of a feature edge times the angle by which its curve turns at this end; infinite if the curve ends there.
  double sag_at(VertexIndex v, std::uint32_t edge) const;
  /// The same for a curve and one of its edges: the end that turns less says how much.
  bool stays_near(const CurveFit& fit, std::uint32_t edge) const;
  std::vector<Vec3> points_along(VertexIndex from, std::uint32_t edge) const;
  VertexIndex corner_vertex(std::uint32_t corner) const { return surface_.triangles[corner / 3][corner % 3]; }
  VertexIndex end_vertex(std::uint32_t end) const { return sharp_.edges[end / 2][end % 2]; }
  /// The end of a feature edge that stands for all that share its fit: both at a vertex inside a curve.
  std::uint32_t fit_of_end(std::uint32_t end) const;

  const SurfaceMesh& surface_;
  const TriangleTree& tree_;
  Features sharp_;
  TriangleTree curves_;
  std::vector<std::array<std::uint32_t, 2>> curve_at_;  ///< per vertex inside a curve: its two feature edges
  std::vector<std::uint32_t> neighbour_;                ///< per half-edge: the triangle across, kNone over sharp edges
  std::vector<Wedge> wedge_of_;                         ///< per corner of a triangle: the least corner of its wedge
  Groups<> corners_of_;                                 ///< per wedge: its corners
  std::vector<std::uint32_t> fit_of_wedge_;             ///< place in fits_, or kNone
  std::vector<std::uint32_t> curve_fit_of_;             ///< per end of a feature edge: place in curve_fits_, or kNone
  std::vector<SurfaceFit> fits_;
  std::vector<CurveFit> curve_fits_;
};

}  // namespace octafront::curved
