#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/inside.h>
#include <octafront/limits.h>
#include <octafront/named_groups.h>
#include <octafront/split.h>

#include "base/comm/packing.h"
#include "base/core/wording.h"
#include "base/shared/shared_tets.h"
#include "pipeline/inside/fins.h"
#include "pipeline/stages/adapting.h"
#include "pipeline/stages/agreement.h"
#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/kept_volumes.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/requirements.h"
#include "pipeline/stages/shell.h"
#include "pipeline/stages/stages.h"
#include "pipeline/stages/true_shape.h"
#include "pipeline/stages/volume_tolerance.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
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

/// Curves where patches meet, and what stands on fins in their place.
void finish_curves(TetMesh& mesh, Fins* fins, Run& run) {
  if (fins == nullptr) return add_patch_curves(mesh);
  run.stage("lines and points", [&](const Stage& stage) {
    fins->leave(mesh);
    add_patch_curves(mesh);
    for (std::string& note : fins->enter(mesh)) stage.note(std::move(note));
  });
}

void place_sets(const Domain& domain, TetMesh& mesh, Run& run) {
  if (domain.sets.empty()) return;
  run.stage("sets", [&](const Stage& stage) {
    if (const std::string missing = add_placed_sets(mesh, domain.sets); !missing.empty())
      stage.note(missing + "; with `keep_surface` those of the surface stay");
  });
}

void split(TetMesh& mesh, Run& run) {
  if (run.options.split.empty()) return;
  run.stage("split", [&](const Stage& stage) {
    for (std::string& note : split_patches(mesh, names_listed(run.options.split, mesh.patch_names)))
      stage.note(std::move(note));
  });
  check_result(mesh, nullptr, run);
}

/// Whether what follows improvement looks at elements of all ranks together.
bool wants_all(const Domain& domain, const Prepared& input, const Filled& filled, const Run& run, const Fins* fins) {
  const Options& options = run.options;
  return domain.geometry || !domain.true_volumes.empty() || !domain.sets.empty() || fins != nullptr ||
         options.order > 1 || options.improve.no_bridging || options.volume.shell != 0 || !options.split.empty() ||
         options.surface.keep_volumes || requires_something(options.require) ||
         owes_volume(input, filled.boundary, run);
}

/// What of the input is narrow at an element; nullopt also where other ranks have it.
std::optional<NarrowPlace> narrow_place_of(const Prepared& input, const Filled& filled, std::uint64_t tet,
                                           const Options& options) {
  if (filled.tets != Tets::kAll || tet >= filled.mesh.tets.size()) return std::nullopt;
  std::array<Vec3, 4> element;
  for (std::size_t i = 0; i < 4; ++i) element[i] = filled.mesh.points[filled.mesh.tets[tet][i]];
  return narrow_place_at(input.surface.mesh(), element, keeps_surface(options));
}

/// `fins`: of the domain's lines and points, which it has as sheets; null: it has none.
Result generate_once(const Domain& domain, const Options& asked, const RunContext& context, Fins* fins) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  refuse_for_ranks(options, context);
  agree_on(domain.surface, "input", context);
  const Prepared input = prepare(domain, run);
  agree_on(input.surface.mesh(), "repaired input", context);
  check_split(input.surface.mesh(), names_listed(options.split, input.surface.mesh().patch_names));
  const SizeField sizes = choose_sizes(input, domain, asked, run);
  require_expected_elements(run.report.expected_tets);
  agree_on(sizes, input.surface.mesh().points, "size field", context);
  Filled filled = fill_to_target(input, sizes, run);
  require_elements(static_cast<double>(filled.mesh.tets.size()), "the mesh");
  agree_on(filled, "mesh as it was filled", context);
  improve_in_shape(input, filled, run);
  agree_on(filled, "improved mesh", context);
  if (wants_all(domain, input, filled, run, fins)) make_whole(filled, run);
  if (!options.layers.outside) add_layers(input, filled, run);
  note_missed_elements(filled, run);
  layer_walls(filled, run);
  place_on_geometry(input, filled, run);
  keep_mesh_volumes(input, wanted_volumes(input, domain), filled, run);
  check_shape(input, filled, run);
  if (options.layers.outside) add_layers(input, filled, run);
  refuse_lost_volumes(domain, filled, run);
  divide_bridges(filled.mesh, run);
  raise_order(input, filled, run);
  agree_on(filled, "mesh", context);
  if (!input.geometry) name_patches(input, filled);
  name_parts(input, filled, run);
  pair_nodes(input, filled.mesh, run);
  check_result(filled, run);
  finish_curves(filled.mesh, fins, run);
  place_sets(domain, filled.mesh, run);
  split(filled.mesh, run);
  run.stage("summary", [&](const Stage& stage) {
    describe(filled.mesh, run.report, comm_of(filled, run));
    require_elements(static_cast<double>(run.report.tets), "the mesh");
    run.comm().agree(run.report.hash, "mesh at the end");
    describe_true_volumes(filled, domain, run.report);
    describe_input_volumes(input, filled, run.report);
    if (!filled.layers) describe_sizes(filled.mesh, filled.boundary.sizes, run.report, comm_of(filled, run));
    note_volumes(input, filled, run.options, run.report, stage);
    note_least(run.report, stage, [&](std::uint64_t tet) { return narrow_place_of(input, filled, tet, run.options); });
  });
  if (context.ranks == nullptr || !context.ranks->shares_tets) make_whole(filled, run);
  return {std::move(filled.mesh), filled.boundary.sizes, run.close(), filled.tets == Tets::kShare};
}

/// Lines and points by the sizes that there would be without them, and those that are asked for them by name.
Fins fins_of(const Domain& domain, const Options& asked, const RunContext& context) {
  Options options = suited(domain, asked);
  const auto is_inside = [&](const std::string& name) {
    const auto has_name = [&](const auto& thing) { return thing.name == name; };
    return std::any_of(domain.wires.begin(), domain.wires.end(), has_name) ||
           std::any_of(domain.points.begin(), domain.points.end(), has_name);
  };
  std::erase_if(options.size.named, [&](const NamedSize& named) { return is_inside(named.name); });
  Run run(options, context);
  const Prepared input = prepare(domain, run);
  return {domain.wires, domain.points, choose_sizes(input, run), asked.size.named, input.surface};
}

Domain with_sheets(const Domain& domain, const Fins& fins, const RunContext& context) {
  Domain with = domain;
  with.surface = embed_sheets(domain.surface, fins.sheets(), {}, context).surface;
  with.bound.clear();
  with.geometry = nullptr;
  with.true_volumes.clear(), with.chord_depths.clear();
  return with;
}

/// generate() of a domain without lines and points, or with fins for them.
Result generate_in(const Domain& domain, const Options& asked, const RunContext& context, Fins* fins) {
  const auto make = [&](const Domain& of) { return generate_once(of, asked, context, fins); };
  const std::optional<double>& percent = asked.surface.volume_tolerance;
  return percent ? with_volumes_within(*percent, domain, make) : make(domain);
}

}  // namespace

void gather_at_first(Result& result, const RunContext& context) {
  if (std::exchange(result.is_share, false)) gather_tets_at_first(result.mesh, Comm(context.ranks));
}

std::vector<PoorElement> worst_elements(const Result& result, std::size_t count, const RunContext& context) {
  const Comm comm(result.is_share ? context.ranks : nullptr);
  std::vector<PoorElement> worst = worst_elements(result.mesh, count);
  const std::uint64_t first = count_tets(result.mesh, comm).before;
  for (PoorElement& element : worst) element.tet += static_cast<TetIndex>(first);
  worst = gathered_lists(comm, worst, "worst elements");
  std::ranges::sort(worst, {}, [](const PoorElement& e) { return std::pair(e.beta, e.tet); });
  worst.resize(std::min(count, worst.size()));
  return worst;
}

namespace {

/// generate(), whatever is required of the mesh.
Result generate_freely(const Domain& domain, const Options& asked, const RunContext& context) {
  if (domain.wires.empty() && domain.points.empty()) return generate_in(domain, asked, context, nullptr);
  if (!traits_of(asked.method).fills_complexes)
    throw OptionError("this method has no lines and points inside: choose method octree-aft");
  Fins fins = fins_of(domain, asked, context);
  Options options = asked;
  if (!options.size.field)
    options.size.regions.insert(options.size.regions.end(), fins.narrow().begin(), fins.narrow().end());
  return generate_in(with_sheets(domain, fins, context), options, context, &fins);
}

}  // namespace

Result generate(const Domain& domain, const Options& asked, const RunContext& context) {
  Result made = generate_freely(domain, asked, context);
  require_of(made.mesh, longest_edge(made.mesh, made.sizes, asked.require), asked.require, made.report);
  return made;
}

SurfaceResult generate_surface(const Domain& domain, const Options& asked, const RunContext& context) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  const Prepared input = prepare(domain, run);
  const SizeField sizes = choose_sizes(input, domain, asked, run);
  Remeshed made = triangulate_to_target(input, sizes, run);
  name_closed_patch(input.closed, input.surface.tree(), made.surface);
  require_elements(static_cast<double>(made.surface.triangles.size()), "the surface");
  run.report.points = made.surface.points.size();
  run.report.boundary_faces = made.surface.triangles.size();
  run.report.volume = enclosed_volume(made.surface);
  run.report.surface_edges = summarize_surface_edges(made.surface.points, made.surface.triangles, made.sizes);
  note_volumes(input, made.surface, options, Stage(context, run.report.stages.back()));
  return {std::move(made.surface), made.sizes, run.close()};
}

SizeResult generate_sizes(const Domain& domain, const Options& asked, const RunContext& context) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  const Prepared input = prepare(domain, run);
  SizeField sizes = choose_sizes(input, domain, asked, run);
  if (traits_of(options.method).has_front) sizes = triangulate_to_target(input, sizes, run).sizes;
  require_expected_elements(run.report.expected_tets);
  return {std::move(sizes), run.close()};
}

}  // namespace octafront
