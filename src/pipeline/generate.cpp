#include <octafront/generate.h>
#include <octafront/named_groups.h>

#include "pipeline/kept_shape.h"
#include "pipeline/methods.h"
#include "pipeline/pipeline.h"
#include "pipeline/stages.h"

namespace octafront {

namespace {

/// `surface`: a SurfaceMesh, or Mended.
template <class Surface>
Result mesh_of(const Surface& surface, const Options& options, const RunContext& context) {
  Run run(options, context);
  const Prepared input = prepare(surface, run);
  const SizeField sizes = choose_sizes(input, run);
  Filled filled = fill_to_target(input, sizes, run);
  improve_in_shape(input, filled, run);
  note_missed_elements(filled.mesh, run);
  check_shape(input, filled, run);
  raise_order(input, filled, run);
  name_patches(input, filled);
  add_patch_curves(filled.mesh);
  check_result(filled.mesh, &filled.boundary.surface, run);
  describe(filled.mesh, run.report);
  describe_sizes(filled.mesh, filled.boundary.sizes, run.report);
  return {std::move(filled.mesh), filled.boundary.sizes, run.close()};
}

template <class Surface>
SurfaceResult boundary_of_mesh(const Surface& surface, const Options& options, const RunContext& context) {
  Run run(options, context);
  const Prepared input = prepare(surface, run);
  const SizeField sizes = choose_sizes(input, run);
  Remeshed made = triangulate_to_target(input, sizes, run);
  name_closed_patch(input.closed, input.surface.tree(), made.surface);
  run.report.points = made.surface.points.size();
  run.report.boundary_faces = made.surface.triangles.size();
  run.report.volume = enclosed_volume(made.surface);
  run.report.surface_edges = summarize_surface_edges(made.surface.points, made.surface.triangles, made.sizes);
  return {std::move(made.surface), made.sizes, run.close()};
}

template <class Surface>
SizeResult sizes_of(const Surface& surface, const Options& options, const RunContext& context) {
  Run run(options, context);
  const Prepared input = prepare(surface, run);
  SizeField sizes = choose_sizes(input, run);
  if (traits_of(options.method).has_front) sizes = triangulate_to_target(input, sizes, run).sizes;
  return {std::move(sizes), run.close()};
}

}  // namespace

Result generate(const SurfaceMesh& surface, const Options& options, const RunContext& context) {
  return mesh_of(surface, options, context);
}

Result generate(const Mended& mended, const Options& options, const RunContext& context) {
  return mesh_of(mended, options, context);
}

SurfaceResult generate_surface(const SurfaceMesh& surface, const Options& options, const RunContext& context) {
  return boundary_of_mesh(surface, options, context);
}

SurfaceResult generate_surface(const Mended& mended, const Options& options, const RunContext& context) {
  return boundary_of_mesh(mended, options, context);
}

SizeResult generate_sizes(const SurfaceMesh& surface, const Options& options, const RunContext& context) {
  return sizes_of(surface, options, context);
}

SizeResult generate_sizes(const Mended& mended, const Options& options, const RunContext& context) {
  return sizes_of(mended, options, context);
}

}  // namespace octafront
