#pragma once

#include <octafront/options.h>
#include <octafront/report.h>
#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

namespace octafront {

/// A mesh made better, and what was done.
struct Improved {
  TetMesh mesh;
  Report report;
  QualitySummary before;  ///< report.quality is that of the result
};

/// Makes the elements of any valid mesh better, by options.improve: reconnection, smoothing, new vertices. Regions,
/// patches, interfaces, curves, sets and pairs stay where they are. Nodes of sets keep their places unless all around
/// are in the same sets (on boundary and interfaces: all around there); those that elements need no more are left out,
/// which a note says. The boundary stays too, triangle for triangle, unless `surface` is given: a clean surface on
/// which the vertices of the boundary lie, and may then slide; feature curves and corners, found by
/// options.surface.feature_angle, stay what they are. Wedges, pyramids and elements in a set "RequiredTetrahedra" stay
/// as they are, and so does the boundary beside them. With options.order 2 the result is of second order, curved to the
/// `surface`, straight without one; a mesh that is of second order already is taken as a linear one.
///
/// Example: improve_existing(read_mesh("part.msh")).mesh.
///
/// The result is valid (first_defect), and no worse than `mesh` by least beta, smallest and largest dihedral angle.
/// Throws InputError if `mesh` is not valid (the first defect, with ids and coordinates), or `surface` is not clean, or
/// the boundary does not lie on it; OptionError, MeshingError, Cancelled.
Improved improve_existing(const TetMesh& mesh, const Options& options = {}, const SurfaceMesh* surface = nullptr,
                          const RunContext& context = {});

}  // namespace octafront
