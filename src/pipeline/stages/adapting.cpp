
#include "pipeline/stages/adapting.h"

#include <octafront/error.h>
#include <octafront/repair.h>

#include "base/core/wording.h"
#include "base/mesh/known_surface.h"
#include "improve/schedule/without_bridges.h"
#include "pipeline/stages/stages.h"
#include "pipeline/stages/true_shape.h"
#include "sizing/field/affordable.h"
#include "sizing/sources/make_size_field.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

/// How far walls may stray where nothing is said, in parts of the diagonal: as for automatic sizes.
constexpr double kStrayOfAdapt = 0.004;

}  // namespace

MetricSummary summary_of(const adapt::MetricFit& fit) {
  return {fit.edges,      fit.fitting,     fit.shortest,     fit.longest,        fit.far,       fit.shortest_at,
          fit.longest_at, fit.quality_min, fit.quality_mean, fit.quality_min_at, fit.complexity};
}

std::optional<adapt::GivenSurface> given_surface(const Domain* surface, double diagonal, Run& run) {
  if (!surface) return std::nullopt;
  return run.stage("surface", [&](const Stage&) {
    // Lines within a face of CAD are few: what bends there is the triangulation.
    const Options options = surface->geometry ? options_for_geometry(*surface, run.options) : run.options;
    // In files of triangles each may have vertices of its own.
    SurfaceMesh tidy = surface->geometry ? surface->surface : repair_surface(surface->surface, run.context()).surface;
    return std::make_optional<adapt::GivenSurface>(std::move(tidy), surface->geometry.get(),
                                                   options.surface.angle_of_features(), kReachOfSurface * diagonal);
  });
}

adapt::AdaptRules rules_of(const Options& options, double diagonal, const adapt::GivenSurface* given) {
  adapt::AdaptRules rules;
  rules.feature_angle = options.surface.angle_of_features();
  rules.strict = options.surface.max_deviation.has_value();
  rules.tolerance = options.surface.max_deviation.value_or(kStrayOfAdapt * diagonal);
  rules.given = given;
  return rules;
}

SizeField sizes_for(const SurfaceMesh& surface, Run& run) {
  return run.stage("size field", [&](const Stage& stage) {
    SurfaceMesh boundary = surface;
    boundary.source.clear();
    note_misplaced_sizes(boundary, run.options.size, stage);
    const KnownSurface known(std::move(boundary), run.options.surface.angle_of_features());
    SizeOptions sizes = run.options.size;
    take_places_in_space(sizes);
    // What is to stay near to a curved surface needs elements as small as its curvature says, as in generate().
    if (const auto bound = run.options.surface.max_deviation; bound && *bound > 0 && !sizes.chord_error && !sizes.field)
      sizes.chord_error = *bound;
    return make_size_field(known, sizes, stage);
  });
}

void require_budget(double expected, const Stage& stage) {
  stage.count("expected elements", expected);
  require_affordable("what is asked for", expected, "ask for larger elements, or set `min_size`");
}

void divide_bridges(TetMesh& mesh, Run& run) {
  if (!run.options.improve.no_bridging) return;
  run.stage("bridges", [&](const Stage& stage) {
    const Bridges found = avoid_bridges(mesh, stage);
    stage.count("elements with all corners on walls", static_cast<double>(found.had));
    stage.count("new vertices", static_cast<double>(found.vertices));
    std::string text =
        fmt::format("{} elements had all corners on walls: {} vertices inside divide them", found.had, found.vertices);
    if (found.left > 0) text += fmt::format("; {} stay as they are, for their parts would be flat", found.left);
    if (found.had > 0) stage.note(std::move(text));
  });
}

void require_near(const adapt::GivenFit& made) {
  if (made.walls == 0 || made.own_walls < made.walls) return;
  throw InputError(
      fmt::format("the surface is near no wall of the mesh (as at {}): is it of the same part, in the same "
                  "unit and place? Near is within {:g} % of the diagonal, or half an edge",
                  at_point(made.own_wall_at), 100 * kReachOfSurface));
}

void tell_given(const adapt::GivenFit& made, const Stage& stage) {
  if (made.walls == 0) return;
  stage.count("wall triangles beside the surface", static_cast<double>(made.own_walls));
  stage.count("vertices held", static_cast<double>(made.held));
  if (made.own_walls > 0)
    stage.note(
        fmt::format("{} of {} wall triangles are farther from the surface than {:g} % of the diagonal and half an "
                    "edge, or turned away from it, as at {}: they stand for their own smooth surface",
                    made.own_walls, made.walls, 100 * kReachOfSurface, at_point(made.own_wall_at)));
  if (made.held > 0)
    stage.note(fmt::format("{} vertices stay beside the surface, as at {}: elements would be poor or turn inside out",
                           made.held, at_point(made.held_at)));
}

void tell_fit(const MetricSummary& fit, const Stage& stage) {
  stage.note(
      fmt::format("{:.2f} % of the edges fit (longest {:.2f}, shortest {:.2f} of what is wanted); quality in the "
                  "metric: least {:.3f} at {}, mean {:.3f}",
                  100.0 * static_cast<double>(fit.fitting) / static_cast<double>(std::max<std::uint64_t>(fit.edges, 1)),
                  fit.longest, fit.shortest, fit.quality_min, at_point(fit.quality_min_at), fit.quality_mean));
}

void tell_unmet(const MetricSummary& fit, const WallDeviation& deviation, bool has_surface, const Stage& stage) {
  if (fit.far > 0) {
    std::string text =
        fmt::format("{} of {} edges are not within half and twice of what is wanted", fit.far, fit.edges);
    if (fit.longest > 2) text += fmt::format("; the longest, {:.2f}, at {}", fit.longest, at_point(fit.longest_at));
    if (fit.shortest < 0.5)
      text += fmt::format("; the shortest, {:.2f}, at {}", fit.shortest, at_point(fit.shortest_at));
    stage.note(text +
               ": faces, curves and corners that must stay, and walls that curve more than the sizes follow, "
               "keep elements from them");
  }
  if (deviation.upper > deviation.bound)
    stage.note(
        fmt::format("walls are up to {:.3g} from the {} at {}, beyond the bound of {:.3g}: elements there could "
                    "not be made smaller",
                    deviation.upper, has_surface ? "given surface" : "smooth surface of the old ones",
                    at_point(deviation.place), deviation.bound));
}

}  // namespace octafront
