#pragma once

#include <octafront/domain.h>
#include <octafront/named_groups.h>
#include <octafront/options.h>
#include <octafront/quality.h>
#include <octafront/repair.h>
#include <octafront/report.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <string>

namespace octafront {

/// A tetrahedral mesh, the sizes it was made to, and what was done.
struct Result {
  TetMesh mesh;
  SizeField sizes;
  Report report;
  bool is_share = false;  ///< the mesh has a rank's share of the tetrahedra (Ranks::shares_tets)
};

/// Where ranks have shares, the first one gets all tetrahedra, and no other any. Called by all ranks; does nothing
/// where the result is no share. Bytes that travel: those of the tetrahedra.
void gather_at_first(Result& result, const RunContext& context);

/// The elements of least beta, the worst first: of all ranks' together, where they have shares; called by all then.
std::vector<PoorElement> worst_elements(const Result& result, std::size_t count, const RunContext& context);

/// From a domain (octafront/domain.h) to a valid tetrahedral mesh: repair, features, size field, surface front, volume
/// front, improvement, check. A SurfaceMesh is a domain as it stands: repair_surface() tidies it, and what has defects
/// beyond that is refused; open_domain() mends it first. Where a domain was mended, a mesh of automatic sizes stays
/// nearer to what was moved (Domain::bound), unless `options` bounds the deviation itself; for a domain from an image
/// the options are those of options_for_voxels(), and what these give up is a note of the report.
///
/// Examples: generate(open_domain("scan.stl")) meshes whatever the file holds, at an automatic size;
/// generate(read_surface("bracket.stl").surface) what is a closed surface.
///
/// The result keeps every law of first_defect(), and depends on nothing but `domain` and `options`.
/// Throws OptionError, InputError (defects, listed), MeshingError, Cancelled.
Result generate(const Domain& domain, const Options& options = {}, const RunContext& context = {});

/// The run up to the surface front: what the boundary of the mesh will be.
struct SurfaceResult {
  SurfaceMesh surface;
  SizeField sizes;
  Report report;
};
SurfaceResult generate_surface(const Domain& domain, const Options& options = {}, const RunContext& context = {});

/// The sizes, as they are after the surface front has made them smaller where lines run side by side or the surface
/// would stray too far; report.expected_tets predicts the number of tetrahedra from them.
struct SizeResult {
  SizeField sizes;
  Report report;
};
SizeResult generate_sizes(const Domain& domain, const Options& options = {}, const RunContext& context = {});

/// What options that take a place may name in the mesh that generate() would make, as far as it is known before: of
/// curves those that stand inside, but not where patches will meet.
PlaceNames expected_place_names(const Domain& domain, const Options& options = {});

/// Throws OptionError with a sentence if the options contradict each other or lie outside their ranges.
void check_options(const Options& options);

/// Options for an image, as they suit voxels so far apart; what was given stays.
///
/// A size that was given rules where it is coarser than voxels: surfaces may stray by a third of what it exceeds them
/// by, which takes no elements smaller than half of it (SurfaceOptions::finest) but in regions that are smaller, and
/// layers thinner than the size are filled by flat elements. With automatic sizes surfaces follow the net so closely
/// (.16 voxels) that they are no farther than a voxel from the voxels' faces, as far as the budget of automatic sizes
/// allows. A number of elements decides by itself. Whatever the sizes, regions keep their volumes. Of features only the
/// edges of the image's box are kept (feature_angle 85), unless an angle is given.
Options options_for_voxels(Options options, double spacing);

/// What options_for_voxels() gives up for a size that is coarser than voxels, as a sentence; empty: nothing.
std::string given_up_for_size(const Options& options, double spacing);

}  // namespace octafront
