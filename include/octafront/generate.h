#pragma once

#include <octafront/mend.h>
#include <octafront/options.h>
#include <octafront/repair.h>
#include <octafront/report.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

namespace octafront {

/// A tetrahedral mesh, the sizes it was made to, and what was done.
struct Result {
  TetMesh mesh;
  SizeField sizes;
  Report report;
};

/// From a closed surface to a valid tetrahedral mesh: repair, features, size field, surface front, volume front,
/// improvement, check. The surface may be any triangle soup; what repair cannot mend is refused.
///
/// Example: generate(read_surface("bracket.stl").surface) meshes at an automatic size.
///
/// The result keeps every law of first_defect(), and depends on nothing but `surface` and `options`.
/// Throws OptionError, InputError (defects, listed), MeshingError, Cancelled.
Result generate(const SurfaceMesh& surface, const Options& options = {}, const RunContext& context = {});

/// The run up to the surface front: what the boundary of the mesh will be.
struct SurfaceResult {
  SurfaceMesh surface;
  SizeField sizes;
  Report report;
};
SurfaceResult generate_surface(const SurfaceMesh& surface, const Options& options = {}, const RunContext& context = {});

/// The sizes, as they are after the surface front has made them smaller where lines run side by side or the surface
/// would stray too far; report.expected_tets predicts the number of tetrahedra from them.
struct SizeResult {
  SizeField sizes;
  Report report;
};
SizeResult generate_sizes(const SurfaceMesh& surface, const Options& options = {}, const RunContext& context = {});

/// Throws OptionError with a sentence if the options contradict each other or lie outside their ranges.
void check_options(const Options& options);

/// The same of a surface that was mended: where repair moved something (Mended::bound) a mesh of automatic sizes stays
/// nearer to it than elsewhere, unless `options` bounds the deviation itself.
///
/// Example: generate(mend_surface(read_surface("scan.stl").surface)) meshes whatever the file holds.
Result generate(const Mended& mended, const Options& options = {}, const RunContext& context = {});
SurfaceResult generate_surface(const Mended& mended, const Options& options = {}, const RunContext& context = {});
SizeResult generate_sizes(const Mended& mended, const Options& options = {}, const RunContext& context = {});

}  // namespace octafront
