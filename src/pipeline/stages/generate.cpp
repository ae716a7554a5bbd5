#include <octafront/generate.h>
#include <octafront/named_groups.h>

#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/stages.h"

#include <utility>

namespace octafront {

namespace {

/// What a domain asks for beside what the user does.
Options suited(const Domain& domain, const Options& asked) {
  return domain.voxel_spacing > 0 ? options_for_voxels(asked, domain.voxel_spacing) : asked;
}

/// The sizes; what they give up because `asked` is coarser than voxels is said.
SizeField choose_sizes(const Prepared& input, const Domain& domain, const Options& asked, Run& run) {
  SizeField sizes = choose_sizes(input, run);
  if (domain.voxel_spacing == 0) return sizes;
  if (std::string lost = given_up_for_size(asked, domain.voxel_spacing); !lost.empty())
    run.report.stages.back().notes.push_back(std::move(lost));
  return sizes;
}

}  // namespace

Result generate(const Domain& domain, const Options& asked, const RunContext& context) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  const Prepared input = prepare(domain, run);
  const SizeField sizes = choose_sizes(input, domain, asked, run);
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

SurfaceResult generate_surface(const Domain& domain, const Options& asked, const RunContext& context) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  const Prepared input = prepare(domain, run);
  const SizeField sizes = choose_sizes(input, domain, asked, run);
  Remeshed made = triangulate_to_target(input, sizes, run);
  name_closed_patch(input.closed, input.surface.tree(), made.surface);
  run.report.points = made.surface.points.size();
  run.report.boundary_faces = made.surface.triangles.size();
  run.report.volume = enclosed_volume(made.surface);
  run.report.surface_edges = summarize_surface_edges(made.surface.points, made.surface.triangles, made.sizes);
  return {std::move(made.surface), made.sizes, run.close()};
}

SizeResult generate_sizes(const Domain& domain, const Options& asked, const RunContext& context) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  const Prepared input = prepare(domain, run);
  SizeField sizes = choose_sizes(input, domain, asked, run);
  if (traits_of(options.method).has_front) sizes = triangulate_to_target(input, sizes, run).sizes;
  return {std::move(sizes), run.close()};
}

}  // namespace octafront
