#pragma once

#include <octafront/domain.h>
#include <octafront/ids.h>
#include <octafront/repair.h>
#include <octafront/second_order.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "base/geometry/true_geometry.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/known_surface.h"
#include "base/shared/shared_tets.h"
#include "fill/lattice/implicit_domain.h"
#include "periodic/periodic_cell.h"
#include "pipeline/stages/layered.h"
#include "pipeline/stages/run.h"
#include "surface/remeshing/remesh.h"

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// What repair closed (kClosedByRepair). Its rim is no line of the body where the surface goes on smoothly: no element
/// need follow it. So it is meshed as a part of the patches around it, and named again in the mesh.
struct ClosedPatch {
  std::uint32_t patch = kNone;         ///< kNone: nothing was closed
  std::vector<std::uint8_t> is_in_it;  ///< per triangle of the input; empty: none
};

/// Finds the patch by its name and gives its triangles to the patches around them.
ClosedPatch take_closed_patch(SurfaceMesh& surface, const EdgeTable& edges);

/// The triangles of the boundary that lie on it are of that patch again. If there are none, its name goes, if it is the
/// last. `tree`: over the triangles of the input.
void name_closed_patch(const ClosedPatch& closed, const TriangleTree& tree, SurfaceMesh& boundary);
void name_closed_patch(const ClosedPatch& closed, const TriangleTree& tree, TetMesh& mesh);

// pipeline/stages: the list of stages. Takes a domain and options, runs the wings one after the other, times them,
// and leaves a checked mesh and a report. The public face is octafront/generate.h.
//
// One function each, in the order of the pipeline. What a stage takes is const and what it makes
// is new, but for improvement, which changes the mesh in place; any of them can be called alone with a Run of its own.

/// The input as every later stage needs it.
struct Prepared {
  KnownSurface surface;                                             ///< repaired, unfolded
  SurfaceDomain::Defects defects = SurfaceDomain::Defects::kClean;  ///< other than clean where the method allows it
  /// Per triangle, how far the new surface may deviate there, where that is less than everywhere else: where unfolding
  /// has used up a part of the user's bound, and where repair moved something. Empty: nowhere less.
  std::vector<double> bound = {};
  bool unfolded = false;  ///< folds were taken off
  /// Of the regions, by number, before folds were taken off. Only of a clean surface.
  std::vector<double> volumes = {};
  ClosedPatch closed = {};
  const TrueGeometry* geometry = nullptr;  ///< null: not known
  PeriodicCell cell = {};                  ///< whose opposite faces are the same

  /// The bounds that new triangles must keep by their places. Where vertices go to the true geometry afterwards, bounds
  /// choose sizes and no more.
  std::span<const double> kept_bound() const { return geometry ? std::span<const double>() : bound; }
};

/// A mesh and the surface that it fills, triangle for triangle. With layers, that is the surface on their tops, until
/// add_layers().
struct Filled {
  TetMesh mesh;
  Remeshed boundary;
  std::optional<GrownLayers> layers = {};
  Tets tets = Tets::kAll;  ///< what of them each rank has; all other arrays are whole
};

/// Of the ranks that have shares of it; alone if all have all.
Comm comm_of(const Filled& filled, const Run& run);
/// The elements of all ranks.
std::uint64_t element_count(const Filled& filled, const Run& run);
/// All ranks get them all.
void make_whole(Filled& filled, const Run& run);

/// Does something to the mesh as if its boundary were what follows the input: not the tops of layers.
template <class Work>
auto on_ground(Filled& filled, const Work& work) {
  if (!filled.layers) return work();
  TetMesh& mesh = filled.mesh;
  TetMesh faces;
  faces.boundary = filled.layers->ground.triangles, faces.patch = filled.layers->ground.patch;
  const auto swap_faces = [&] {
    std::swap(mesh.boundary, faces.boundary), std::swap(mesh.patch, faces.patch);
    std::swap(mesh.interfaces, faces.interfaces), std::swap(mesh.interface_patch, faces.interface_patch);
  };
  swap_faces();
  auto made = work();
  swap_faces();
  return made;
}

/// Repairs the input, refuses what the method cannot mesh (InputError), takes off folds that the tolerance lets go
/// where the surface is made anew, finds the features; of a periodic cell makes opposite faces the same first. The
/// bounds of a mended one hold where the sizes are automatic and the user bounds nothing.
Prepared prepare(const Domain& input, Run& run);

/// The sizes that the options ask for; report.expected_tets says how many elements they promise, if no surface made to
/// them will tell better.
SizeField choose_sizes(const Prepared& input, Run& run);

/// How true the surface stays to the input: as asked, and with automatic sizes within .4 % of the diagonal.
SurfaceOptions true_to_input(const SurfaceMesh& input, const Options& options);

/// The surface triangulated anew to the sizes, or the input's triangles where the run keeps them.
Remeshed triangulate(const Prepared& input, const SizeField& sizes, Run& run);

/// triangulate(), again with scaled sizes until the elements expected meet the number that was asked for or cannot.
Remeshed triangulate_to_target(const Prepared& input, const SizeField& sizes, Run& run);

/// Surface and volume by the run's method.
Filled fill(const Prepared& input, const SizeField& sizes, Run& run);
/// The volume of a surface that triangulate() left.
Filled fill_surface(const Prepared& input, Remeshed boundary, Run& run);

/// The surface as by triangulate_to_target(), filled; again if the elements made do not meet the number.
Filled fill_to_target(const Prepared& input, const SizeField& sizes, Run& run);

/// Says so if a mesh that is done misses the number of elements that was asked for by more than 15 %.
void note_missed_elements(const Filled& filled, Run& run);

/// Better elements by these options; `filled.boundary` follows what became of the boundary.
void improve_elements(const Prepared& input, Filled& filled, Run& run, const ImproveOptions& options);

/// Mid-side nodes where the run asks for second order, on the smooth surface of the input unless its triangles are
/// kept; `filled.boundary` follows.
void raise_order(const Prepared& input, Filled& filled, Run& run);

/// Names what repair closed, in the mesh and `filled.boundary`.
void name_patches(const Prepared& input, Filled& filled);

/// Enters what became of the edges into the stage's report.
void count_edges(const SecondOrderSummary& made, const Stage& stage);
/// What the stage is called that gives elements this order.
const char* stage_of_order(int order);

/// Throws MeshingError if the mesh breaks a law of first_defect(), or its boundary is not `surface` where one is given.
void check_result(const TetMesh& mesh, const SurfaceMesh* surface, Run& run);
/// The same of what was made, and its boundary.
void check_result(const Filled& filled, Run& run);

/// The boundary with the mesh's points and patches.
SurfaceMesh boundary_of(const TetMesh& mesh);

/// Fills in what the report says of every mesh: counts, volume, quality, hash. `comm`: as in measure.h.
void describe(const TetMesh& mesh, Report& report, const Comm& comm = Comm(nullptr));

// Images have a triangle for each face of a voxel, and scans one for each few points: far more than sizes need that are
// much coarser.

/// The domain of an image with triangles about half as large as the sizes that are asked for, so that sizes, trees and
/// the surface front do not work on more; nothing where they are hardly larger than voxels, where sizes are measured on
/// the surface, or where its triangles must stay.
std::optional<Domain> coarse_domain(const Domain& domain, Run& run);

/// The surface of one body likewise, if it has very many triangles, much smaller than automatic sizes, the size or the
/// number of elements that is given, and the user bounds nowhere how far the new surface may stray: within a twentieth
/// of its mean edge. Not where walls or gaps are about as narrow as that. REQUIRES a clean surface.
std::optional<SurfaceMesh> coarse_surface(const SurfaceMesh& clean, Run& run);

/// After improvement has moved the boundary: each triangle of the mesh that is no longer the one of `before` gets as
/// its source that of the triangle of the `input` that is nearest now, found by the `tree` over it. `before`: the
/// boundary as it was, in the same order.
void renew_sources(TetMesh& mesh, const SurfaceMesh& before, const SurfaceMesh& input, const TriangleTree& tree);

/// What was filled follows what became of its boundary and interfaces, whose vertices come first in the mesh; of
/// a complex whose patches have one pair of sides each.
void follow_boundary(const TetMesh& mesh, SurfaceMesh& filled);

}  // namespace octafront
