#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/named_groups.h>

#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/stages.h"
#include "pipeline/stages/true_shape.h"

#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace {

/// What a domain asks for beside what the user does.
Options suited(const Domain& domain, const Options& asked) {
  if (domain.geometry) return options_for_geometry(domain, asked);
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

/// So often a mesh is made with smaller bounds where solids do not keep their volume.
constexpr int kTriesOfBounds = 3;

Result generate_once(const Domain& domain, const Options& asked, const RunContext& context) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  const Prepared input = prepare(domain, run);
  const SizeField sizes = choose_sizes(input, domain, asked, run);
  Filled filled = fill_to_target(input, sizes, run);
  improve_in_shape(input, filled, run);
  if (!options.layers.outside) add_layers(input, filled, run);
  note_missed_elements(filled.mesh, run);
  check_shape(input, filled, run);
  place_on_geometry(input, filled, run);
  if (options.layers.outside) add_layers(input, filled, run);
  raise_order(input, filled, run);
  name_patches(input, filled);
  name_parts(input, filled, run);
  pair_nodes(input, filled.mesh, run);
  add_patch_curves(filled.mesh);
  check_result(filled.mesh, &filled.boundary.surface, run);
  describe(filled.mesh, run.report);
  describe_true_volumes(filled, domain, run.report);
  if (!filled.layers) describe_sizes(filled.mesh, filled.boundary.sizes, run.report);
  return {std::move(filled.mesh), filled.boundary.sizes, run.close()};
}

/// Whether smaller bounds would be heard: they are not where the user bounds the deviation, or keeps the triangles.
bool heeds_bounds(const Options& options) {
  return !keeps_surface(options) && !options.surface.max_deviation && traits_of(options.method).has_front;
}

}  // namespace

Result generate(const Domain& domain, const Options& asked, const RunContext& context) {
  Result made = generate_once(domain, asked, context);
  std::vector<OffSolid> off = off_solids(domain, made.report);
  if (off.empty()) return made;
  Domain nearer = domain;
  for (int k = 0; k < kTriesOfBounds && !off.empty() && heeds_bounds(asked); ++k) {
    std::string why = "volumes were off, so elements were made smaller there: " + in_words(domain, off);
    nearer.bound = tightened(nearer, off);
    made = generate_once(nearer, asked, context);
    made.report.stages.front().notes.push_back(std::move(why));
    off = off_solids(domain, made.report);
  }
  if (off.empty()) return made;
  throw MeshingError(
      fmt::format("the mesh does not keep the volumes of the CAD solids within {:g} %: {}. {}", 100 * kVolumeKept,
                  in_words(domain, off),
                  asked.size.elements ? "Ask for more elements" : "Give a smaller size, or a smaller `max_deviation`"));
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
