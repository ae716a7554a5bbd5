#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/inside.h>
#include <octafront/limits.h>
#include <octafront/named_groups.h>
#include <octafront/split.h>

#include "base/core/wording.h"
#include "base/shared/packing.h"
#include "base/shared/shared_tets.h"
#include "periodic/paired_nodes.h"
#include "pipeline/inside/fins.h"
#include "pipeline/stages/agreement.h"
#include "pipeline/stages/contact_choice.h"
#include "pipeline/stages/finish.h"
#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/kept_volumes.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/requirements.h"
#include "pipeline/stages/true_shape.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace octafront {

namespace {

/// What a domain asks for beside what the user does.
Options suited(const Domain& domain, const Options& typed) {
  const Options asked = options_for_flow(domain, typed);
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

/// Refuses to open, or to make sets of, what the mesh will not have.
void check_places(const SurfaceMesh& surface, const Options& options) {
  check_split(surface, names_listed(options.split, surface.patch_names));
  for (const std::string& group : options.groups) check_group(surface, group_rule(group));
}

/// `fins`: of the domain's lines and points, which it has as sheets; null: it has none.
Result generate_once(const Domain& domain, const Options& asked, const RunContext& context, Fins* fins) {
  const Options options = suited(domain, asked);
  Run run(options, context);
  refuse_for_ranks(options, context);
  agree_on(domain.surface, "input", context);
  const Prepared input = prepare(domain, run);
  agree_on(input.surface.mesh(), "repaired input", context);
  // Those of CAD were looked at with its names.
  if (!domain.geometry) check_places(input.surface.mesh(), options);
  const SizeField sizes = choose_sizes(input, domain, asked, run);
  require_expected_elements(run.report.expected_tets);
  agree_on(sizes, input.surface.mesh().points, "size field", context);
  Filled filled = fill_to_target(input, sizes, run);
  require_elements(static_cast<double>(filled.mesh.tets.size()), "the mesh");
  agree_on(filled, "mesh as it was filled", context);
  improve_in_shape(input, filled, run);
  agree_on(filled, "improved mesh", context);
  const Finishing made{domain, input, filled, fins, run};
  finish(made);
  describe(made);
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

/// Opposite faces of an image become the same sooner where they stay nearer to its voxels: tried again, so often, with
/// half the bound on the deviation that suits the size.
constexpr int kNearerCells = 3;

Result generate_nearer(const Domain& domain, Options asked, const RunContext& context, Fins* fins) {
  const bool may_be_nearer = domain.voxel_spacing > 0 && asked.size.size && !asked.surface.max_deviation;
  std::string note;
  for (int tries = may_be_nearer ? kNearerCells : 0;; --tries) {
    try {
      Result made = generate_once(domain, asked, context, fins);
      if (!note.empty()) made.report.stages.back().notes.push_back(std::move(note));
      return made;
    } catch (const FacesDiffer&) {
      const std::optional<double> strayed = suited(domain, asked).surface.max_deviation;
      if (tries == 0 || !strayed) throw;
      asked.surface.max_deviation = 0.5 * *strayed;
      note = fmt::format("opposite faces became the same within {:.3g} of the voxels: `max_deviation`", 0.5 * *strayed);
    }
  }
}

/// generate() of a domain without lines and points, or with fins for them.
Result generate_in(const Domain& domain, const Options& asked, const RunContext& context, Fins* fins) {
  const auto make = [&](const Domain& of) { return generate_nearer(of, asked, context, fins); };
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
  if (const std::vector<PartContact> contacts = contacts_of(domain); come_apart(contacts))
    return generate_apart(domain, contacts, asked, context,
                          [&](const Domain& part, const Options& options) { return generate(part, options, context); });
  Result made = generate_freely(domain, asked, context);
  require_of(made.mesh, longest_edge(made.mesh, made.sizes, asked.require), asked.require, made.report);
  return made;
}

SurfaceResult generate_surface(const Domain& domain, const Options& asked, const RunContext& context) {
  if (!domain.contacts.is_shared())
    throw OptionError("`contacts`: contacts are opened in a mesh of tetrahedra; a surface has shared ones");
  const Options options = suited(domain, asked);
  Run run(options, context);
  const Prepared input = prepare(domain, run);
  const SizeField sizes = choose_sizes(input, domain, asked, run);
  Remeshed made = triangulate_to_target(input, sizes, run);
  name_closed_patch(input.closed, input.surface.tree(), made.surface);
  if (input.geometry) {
    MeshPatches patches = patches_in_mesh(made.surface, input.geometry);
    for (std::uint32_t& patch : made.surface.patch) patch = patches.number[patch];
    made.surface.patch_names = std::move(patches.names);
  }
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
  if (!domain.geometry) check_places(input.surface.mesh(), options);
  SizeField sizes = choose_sizes(input, domain, asked, run);
  if (traits_of(options.method).has_front) sizes = triangulate_to_target(input, sizes, run).sizes;
  require_expected_elements(run.report.expected_tets);
  return {std::move(sizes), run.close()};
}

}  // namespace octafront
