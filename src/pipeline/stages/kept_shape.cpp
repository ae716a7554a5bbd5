#include "pipeline/stages/kept_shape.h"

#include <octafront/error.h>

#include "base/mesh/complex.h"
#include "pipeline/stages/methods.h"
#include "sizing/field/change_size_field.h"
#include "sizing/field/expected_tets.h"
#include "sizing/sources/curvature.h"
#include "sizing/sources/model_extent.h"
#include "surface/remeshing/keep_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

/// What chords cut off falls with the square of their length: sizes are made smaller to come to this part of the bound,
/// but to no less than this part of themselves, so often.
constexpr double kAim = 0.5, kLeastScale = 0.4;
constexpr int kTries = 2;
/// Up to here a body gets its volume back by moves of vertices, of a tenth of their edges or so: smaller elements would
/// be many times as many.
constexpr double kGivenBack = 0.12;
/// Up to here the finished mesh gets it back, on a boundary that improvement may move.
constexpr double kOwed = 0.05;
/// Vertices that leave the surface, and chords between them, lie within so many bounds on deviation.
constexpr double kStray = 2;

bool is_off(double change) {
  return std::abs(change) > kVolumeKept;
}

/// By how much the box has moved at the worst of its sides.
double change_of_extent(const Box3& made, const Box3& input) {
  double most = 0;
  for (int axis = 0; axis < 3; ++axis)
    most = std::max({most, std::abs(made.lo[axis] - input.lo[axis]), std::abs(made.hi[axis] - input.hi[axis])});
  return most;
}

/// Whether it can be foreseen that no sizes within the budget keep the volume, as those of thousands of bodies.
bool is_hopeless(const Prepared& input, const SizeField& sizes, double budget, const Stage& stage) {
  if (!std::isfinite(budget)) return false;
  const double loss = predicted_volume_loss(input.surface, sizes, stage.context());
  if (loss <= kGivenBack) return false;
  const SizeField smaller = scaled(sizes, std::sqrt(kVolumeKept / loss), stage.context());
  if (expected_tets(smaller, input.surface.mesh()) <= budget) return false;
  stage.note(
      fmt::format("the input's triangles are kept: others would change the volume by about {:+.1f} %", -100 * loss));
  return true;
}

/// Whether the surface of a slender body has the volume again by moves of its vertices; it stays as it is then.
bool give_volume_back(Remeshed& made, const Prepared& input, const Run& run, const Stage& stage) {
  const auto change = [&](const SurfaceMesh& surface) {
    return change_of_volume(enclosed_volume(surface), run.report.input_volume);
  };
  // Opposite faces of a cell stay copies of each other.
  if (!run.options.periodic.empty()) return false;
  const double lost = change(made.surface);
  if (std::abs(lost) > kGivenBack || slenderness(input.surface.mesh()) < kSlender) return false;
  SurfaceMesh pressed = made.surface;
  const std::array<double, 1> wanted{run.report.input_volume};
  surface::keep_volumes_clean(pressed, made.features, wanted, {}, nullptr, stage.context());
  if (is_off(change(pressed))) return false;
  stage.note(fmt::format("the automatic sizes change the volume by {:+.1f} %: vertices were moved to give it back",
                         100 * lost));
  made.surface = std::move(pressed);
  return made.stays = true;
}

Remeshed input_that_stays(const Prepared& input, const SizeField& sizes) {
  Remeshed kept = input_as_it_is(input.surface, sizes);
  kept.stays = true;
  return kept;
}

/// Whether the volume may wait for the mesh: opposite faces of a cell stay copies of each other, and second order
/// follows the smooth surface.
bool may_owe_volume(const Prepared& input, const Options& options) {
  return has_automatic_sizes(options) && options.periodic.empty() && !is_complex(input.surface.mesh()) &&
         !keeps_surface(options) && !traits_of(options.method).makes_own_boundary();
}

}  // namespace

bool owes_volume(const Prepared& input, const Remeshed& boundary, const Run& run) {
  return may_owe_volume(input, run.options) && !input.geometry && !boundary.stays &&
         is_off(change_of_volume(enclosed_volume(boundary.surface), run.report.input_volume));
}

double change_of_volume(double made, double input) {
  return made / input - 1;
}

Remeshed remeshed_in_shape(const Prepared& input, const SizeField& sizes, const Run& run, const Stage& stage,
                           const std::function<Remeshed(const SizeField&)>& remesh, double budget) {
  if (!has_automatic_sizes(run.options) || is_complex(input.surface.mesh())) return remesh(sizes);
  if (is_hopeless(input, sizes, budget, stage)) return input_that_stays(input, sizes);
  Remeshed made = remesh(sizes);
  const auto change = [&] { return change_of_volume(enclosed_volume(made.surface), run.report.input_volume); };
  // The mesh gets it back, or chords of true geometry are said.
  if (std::abs(change()) <= kOwed && may_owe_volume(input, run.options)) return made;
  if (is_off(change()) && give_volume_back(made, input, run, stage)) return made;
  double scale = 1;
  for (int k = 0; k < kTries && is_off(change()); ++k) {
    scale *= std::max(kLeastScale, std::sqrt(kAim * kVolumeKept / std::abs(change())));
    const SizeField smaller = scaled(sizes, scale, stage.context());
    if (std::isfinite(budget) && expected_tets(smaller, input.surface.mesh()) > budget) break;
    stage.note(fmt::format("the automatic sizes change the volume by {:+.1f} %: made again by {:.2g} of them",
                           100 * change(), scale));
    made = remesh(smaller);
  }
  if (!is_off(change())) return made;
  stage.note(fmt::format("the input's triangles are kept: others change the volume by {:+.1f} %", 100 * change()));
  return input_that_stays(input, sizes);
}

void improve_in_shape(const Prepared& input, Filled& filled, Run& run) {
  if (is_complex(input.surface.mesh())) return improve_elements(input, filled, run, run.options.improve);
  ImproveOptions staying = run.options.improve;
  staying.move_boundary = false;
  if (filled.boundary.stays) return improve_elements(input, filled, run, staying);
  const Remeshed boundary = filled.boundary;
  const double before = enclosed_volume(boundary.surface);
  improve_elements(input, filled, run, run.options.improve);
  const double change = change_of_volume(enclosed_volume(filled.boundary.surface), before);
  if (!is_off(change)) return;
  run.report.stages.back().name += " (earlier try)";
  run.report.stages.back().notes.push_back(
      fmt::format("this changed the volume by {:+.1f} %: done again on a boundary that stays", 100 * change));
  filled = fill_surface(input, boundary, run);
  improve_elements(input, filled, run, staying);
}

void check_shape(const Prepared& input, const Filled& filled, Run& run) {
  if (keeps_surface(run.options) || traits_of(run.options.method).makes_own_boundary()) return;
  const SurfaceMesh &before = input.surface.mesh(), &after = filled.boundary.surface;
  if (is_complex(before) || !has_automatic_sizes(run.options)) return;
  const double change = change_of_volume(enclosed_volume(after), run.report.input_volume);
  if (std::abs(change) > kGivenBack)
    throw MeshingError(
        fmt::format("the mesh has {:.4g} % of the input's volume. Give a size, or keep the surface's own "
                    "triangles by `keep`",
                    100 * (1 + change)));
  const double stray = change_of_extent(bounding_box(after.points), bounding_box(before.points));
  const double bound = *true_to_input(before, run.options).max_deviation;
  if (bound > 0 && stray > kStray * bound)
    throw MeshingError(
        fmt::format("the mesh reaches {:.4g} beyond the input or ends as much before it. Give a size, or "
                    "keep the surface's own triangles by `keep`",
                    stray));
}

}  // namespace octafront
