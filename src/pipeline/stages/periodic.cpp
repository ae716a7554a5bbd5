#include "pipeline/stages/periodic.h"

#include <octafront/error.h>
#include <octafront/tet_mesh.h>

#include "base/core/wording.h"
#include "periodic/face_names.h"
#include "periodic/make_periodic.h"
#include "periodic/paired_nodes.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/stages.h"
#include "soup/tidy/examine.h"

#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// The triangles that opposite faces have, their bounds and what else goes by triangle.
Domain with_surface(const Domain& domain, SurfaceMesh surface, const std::vector<std::uint32_t>& origin) {
  Domain made = domain;
  made.surface = std::move(surface);
  made.found_clean = 0;
  if (domain.bound.empty()) return made;
  made.bound.clear();
  for (const std::uint32_t t : origin) made.bound.push_back(domain.bound[t]);
  return made;
}

/// The domain with this surface, whose sources are triangles of the domain's.
Domain tidied(const Domain& domain, SurfaceMesh surface) {
  std::vector<std::uint32_t> origin;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) origin.push_back(surface.source_of(t));
  surface.source.clear();
  for (const std::uint32_t t : origin) surface.source.push_back(domain.surface.source_of(t));
  return with_surface(domain, std::move(surface), origin);
}

void tell(const MadePeriodic& made, const Stage& stage) {
  stage.count("triangles imprinted", static_cast<double>(made.imprinted));
  stage.count("vertices moved", static_cast<double>(made.moved));
  stage.count("largest move", made.largest_move);
  if (made.imprinted > 0)
    stage.note(
        made.cell.is_box()
            ? fmt::format("opposite faces carried different triangles: both got {} new ones, by the lines of both",
                          made.imprinted / 2)
            : fmt::format("faces got {} triangles of those that they are copies of", made.imprinted));
  if (made.moved > 0)
    stage.note(fmt::format("{} moved onto periodic faces, or to their copies, by {:.3g} at most",
                           counted(made.moved, "vertex", "vertices"), made.largest_move));
}

}  // namespace

void check_periodic_options(const Options& options) {
  if (options.periodic.empty()) return;
  periods_asked("periodic", options.periodic);
  if (!traits_of(options.method).fills_complexes)
    throw OptionError("`periodic` goes with the methods octree-aft and recover only");
  if (options.layers.count > 0) throw OptionError("`periodic` and `layers` do not go together yet: leave out one");
}

std::optional<PeriodicDomain> made_periodic(const Domain& domain, Run& run) {
  if (run.options.periodic.empty()) return std::nullopt;
  return run.stage("periods", [&](const Stage& stage) -> std::optional<PeriodicDomain> {
    SurfaceMesh numbered = domain.surface;
    numbered.source.clear();
    Examined examined = examine_surface(numbered, false, stage.context());
    if (!examined.defects.clean()) return std::nullopt;
    const Domain clean = tidied(domain, std::move(examined.repaired.surface));
    SurfaceMesh surface = clean.surface;
    const AskedPeriods asked = periods_asked("periodic", run.options.periodic);
    const MadePeriodic made = asked.maps.empty() ? make_periodic(surface, asked.along, stage.context())
                                                 : make_periodic(surface, asked.maps, stage.context());
    tell(made, stage);
    Domain periodic = with_surface(clean, std::move(surface), made.origin);
    if (periodic.geometry)
      stage.note(
          "faces of a periodic cell are copies of each other, so the mesh follows the triangles of the CAD file, "
          "not its geometry");
    periodic.geometry.reset();
    return PeriodicDomain{std::move(periodic), made.cell};
  });
}

void pair_mid_nodes(TetMesh& mesh, const PeriodicCell& cell, const Stage& stage) {
  if (!cell.is_periodic() || mesh.order() == 1) return;
  stage.count("nodes of periodic faces straightened", static_cast<double>(bring_copies_behind_corners(cell, mesh)));
}

void pair_mid_nodes(TetMesh& mesh, Run& run) {
  if (mesh.periodic_nodes.empty()) return;
  run.stage("pairs", [&](const Stage& stage) {
    if (mesh.order() > 1) pair_nodes_behind_corners(mesh);
    stage.count("pairs of nodes", static_cast<double>(mesh.periodic_nodes.size()));
  });
}

void pair_nodes(const Prepared& input, TetMesh& mesh, Run& run) {
  const PeriodicCell& cell = input.cell;
  if (!cell.is_periodic()) return;
  run.stage("pairs", [&](const Stage& stage) {
    pair_nodes_on_faces(cell, mesh);
    std::vector<double> pairs(mesh.periods.size());
    for (const auto& pair : mesh.periodic_nodes) ++pairs[pair[0]];
    for (std::size_t k = 0; k < pairs.size(); ++k)
      stage.count(fmt::format("pairs of nodes along {}", cell.name_of_period(cell.periods_there()[k])), pairs[k]);
    unite_patches(cell, mesh);
  });
}

}  // namespace octafront
