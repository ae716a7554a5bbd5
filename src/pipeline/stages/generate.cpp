#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/inside.h>
#include <octafront/named_groups.h>
#include <octafront/split.h>

#include "base/comm/packing.h"
#include "base/core/wording.h"
#include "base/shared/shared_tets.h"
#include "pipeline/inside/fins.h"
#include "pipeline/stages/agreement.h"
#include "pipeline/stages/checkpoint.h"
#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/shell.h"
#include "pipeline/stages/stages.h"
#include "pipeline/stages/true_shape.h"

#include <algorithm>
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

/// Curves where patches meet, and what stands on fins in their place.
void finish_curves(TetMesh& mesh, Fins* fins, Run& run) {
  if (fins == nullptr) return add_patch_curves(mesh);
  run.stage("lines and points", [&](const Stage& stage) {
    fins->leave(mesh);
    add_patch_curves(mesh);
    for (std::string& note : fins->enter(mesh)) stage.note(std::move(note));
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

/// improve_in_shape(), or what is kept of it.
void improve_or_read(const Prepared& input, Filled& filled, Run& run) {
  ImprovedMesh improved = run.checkpoint->kept<ImprovedMesh>("improved", [&] {
    improve_in_shape(input, filled, run);
    return ImprovedMesh{std::move(filled.mesh), std::move(filled.boundary)};
  });
  filled.mesh = std::move(improved.mesh), filled.boundary = std::move(improved.boundary);
}

/// Whether what follows improvement looks at elements of all ranks together.
bool wants_all(const Domain& domain, const Options& options, const Fins* fins) {
  return domain.geometry || !domain.true_volumes.empty() || fins != nullptr || options.order > 1 ||
         options.volume.shell != 0 || !options.split.empty();
}

/// `fins`: of the domain's lines and points, which it has as sheets; null: it has none.
Result generate_once(const Domain& domain, const Options& asked, const RunContext& context, Fins* fins,
                     const Checkpoints& checkpoints) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  refuse_for_ranks(options, context);
  agree_on(domain.surface, "input", context);
  const Prepared input = prepare(domain, run);
  agree_on(input.surface.mesh(), "repaired input", context);
  check_split(input.surface.mesh(), names_listed(options.split, input.surface.mesh().patch_names));
  const SizeField sizes = choose_sizes(input, domain, asked, run);
  agree_on(sizes, input.surface.mesh().points, "size field", context);
  Checkpoint checkpoint(checkpoints, input, sizes, run);
  run.checkpoint = &checkpoint;
  Filled filled = fill_to_target(input, sizes, run);
  agree_on(filled, "mesh as it was filled", context);
  improve_or_read(input, filled, run);
  agree_on(filled, "improved mesh", context);
  if (wants_all(domain, options, fins)) make_whole(filled, run);
  if (!options.layers.outside) add_layers(input, filled, run);
  note_missed_elements(filled, run);
  check_shape(input, filled, run);
  layer_walls(filled, run);
  place_on_geometry(input, filled, run);
  if (options.layers.outside) add_layers(input, filled, run);
  raise_order(input, filled, run);
  agree_on(filled, "mesh", context);
  name_patches(input, filled);
  name_parts(input, filled, run);
  pair_nodes(input, filled.mesh, run);
  check_result(filled, run);
  finish_curves(filled.mesh, fins, run);
  split(filled.mesh, run);
  describe(filled.mesh, run.report, comm_of(filled, run));
  run.comm().agree(run.report.hash, "mesh at the end");
  describe_true_volumes(filled, domain, run.report);
  if (!filled.layers) describe_sizes(filled.mesh, filled.boundary.sizes, run.report, comm_of(filled, run));
  if (context.ranks == nullptr || !context.ranks->shares_tets) make_whole(filled, run);
  return {std::move(filled.mesh), filled.boundary.sizes, run.close(), filled.tets == Tets::kShare};
}

/// Whether smaller bounds would be heard: they are not where the user bounds the deviation, or keeps the triangles.
bool heeds_bounds(const Options& options) {
  return !keeps_surface(options) && !options.surface.max_deviation && traits_of(options.method).has_front;
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
  with.true_volumes.clear();
  return with;
}

/// generate() of a domain without lines and points, or with fins for them.
Result generate_in(const Domain& domain, const Options& asked, const RunContext& context, Fins* fins,
                   const Checkpoints& checkpoints) {
  Result made = generate_once(domain, asked, context, fins, checkpoints);
  std::vector<OffSolid> off = off_solids(domain, made.report);
  if (off.empty()) return made;
  Domain nearer = domain;
  for (int k = 0; k < kTriesOfBounds && !off.empty() && heeds_bounds(asked); ++k) {
    std::string why = "volumes were off, so elements were made smaller there: " + in_words(domain, off);
    nearer.bound = tightened(nearer, off);
    made = generate_once(nearer, asked, context, fins, checkpoints);
    made.report.stages.front().notes.push_back(std::move(why));
    off = off_solids(domain, made.report);
  }
  if (off.empty()) return made;
  throw MeshingError(
      fmt::format("the mesh does not keep the volumes of the CAD solids within {:g} %: {}. {}", 100 * kVolumeKept,
                  in_words(domain, off),
                  asked.size.elements ? "Ask for more elements" : "Give a smaller size, or a smaller `max_deviation`"));
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

Result generate(const Domain& domain, const Options& asked, const RunContext& context) {
  return generate_with({}, domain, asked, context);
}

Result generate_with(const Checkpoints& checkpoints, const Domain& domain, const Options& asked,
                     const RunContext& context) {
  open_checkpoint(checkpoints, domain, asked, context);
  if (domain.wires.empty() && domain.points.empty()) return generate_in(domain, asked, context, nullptr, checkpoints);
  if (!traits_of(asked.method).fills_complexes)
    throw OptionError("this method has no lines and points inside: choose method octree-aft");
  Fins fins = fins_of(domain, asked, context);
  return generate_in(with_sheets(domain, fins, context), asked, context, &fins, checkpoints);
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
