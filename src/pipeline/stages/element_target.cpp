#include "base/core/elementary.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/stages.h"
#include "sizing/field/change_size_field.h"
#include "sizing/sources/budget.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/core.h>

namespace octafront {

namespace {

// Sizes that miss the number are scaled, by what came out, and tried again.
constexpr double kElementsPromised = 0.15;
constexpr double kElementsTolerance = 0.12;  // tighter, for improvement still changes the count
constexpr int kElementsAttempts = 5, kSurfaceAttempts = 7;

bool meets(double wanted, double count) {
  return std::abs(count / wanted - 1) <= kElementsTolerance;
}

/// The stages from here on made what was not kept.
void rename_earlier(Report& report, std::size_t first_stage) {
  for (std::size_t s = first_stage; s < report.stages.size(); ++s) {
    if (!report.stages[s].name.ends_with("(earlier try)")) report.stages[s].name += " (earlier try)";
  }
}

/// What sizes came to.
template <class Result>
struct TriedSizes {
  SizeField sizes;
  Result made;
  double expected;  ///< elements, by the prediction
  double count;     ///< elements, by the search
};

/// make(sizes), again with scaled sizes until the elements meet the number wanted or cannot; the best try counts. The
/// tries, `attempts` at most, began at `first_stage` of the report; `counted` is the word for what count(made) leaves.
template <class Make, class Count>
auto meet_target(const SizeField& sizes, Run& run, std::size_t first_stage, int attempts, const char* counted,
                 Make&& make, Count&& count) {
  const auto attempt = [&](const SizeField& by) {
    auto made = make(by);
    const double elements = count(made);
    return TriedSizes<decltype(made)>{by, std::move(made), run.report.expected_tets, elements};
  };
  auto best = attempt(sizes);
  if (!run.options.size.elements || keeps_surface(run.options)) return best;
  const auto wanted = static_cast<double>(*run.options.size.elements);
  CountSearch search(wanted);
  double last = best.count;
  search.came_out(last);
  for (int tries = 1; tries < attempts && !meets(wanted, last) && !search.stands_still(); ++tries) {
    search.step();
    rename_earlier(run.report, first_stage);
    auto next = attempt(scaled(sizes, search.factor(), run.context()));
    run.report.stages.back().notes.push_back(
        fmt::format("the sizes before had {:.0f} elements {} where {} were wanted: all sizes scaled by {:.4g}", last,
                    counted, *run.options.size.elements, search.factor()));
    last = next.count;
    search.came_out(last);
    // The lattice doubles its cells: counts may jump over the target, and an earlier try may be the better one.
    if (search.is_best()) best = std::move(next);
  }
  run.report.expected_tets = best.expected;
  return best;
}

void note_missed_target(double count, const char* counted, Run& run) {
  const auto& wanted = run.options.size.elements;
  if (!wanted || std::abs(count / static_cast<double>(*wanted) - 1) <= kElementsPromised) return;
  Finding found;
  found.code = "elements-missed";
  found.text = fmt::format(
      "{} elements were wanted; {:.0f} {}: {}", *wanted, count, counted,
      keeps_surface(run.options)
          ? "the kept triangles do not allow it"
          : "no factor on the sizes that was tried came nearer, for features, details of the surface and limits on the "
            "size decide there. `min_size`, fewer of these, or another number help");
  found.values = {{"wanted", static_cast<double>(*wanted)}, {"elements", count}};
  run.report.stages.back().note(std::move(found));
}

TriedSizes<Remeshed> surface_to_target(const Prepared& input, SizeField sizes, Run& run) {
  if (run.options.size.elements && !keeps_surface(run.options)) {
    const double factor = elementary::cbrt(traits_of(run.options.method).tets_per_expected);
    if (factor != 1) sizes = scaled(sizes, factor, run.context());
  }
  return meet_target(
      sizes, run, run.report.stages.size(), kSurfaceAttempts, "expected",
      [&](const SizeField& by) { return triangulate(input, by, run); },
      [&](const Remeshed&) { return run.report.expected_tets; });
}

}  // namespace

Remeshed triangulate_to_target(const Prepared& input, const SizeField& sizes, Run& run) {
  TriedSizes<Remeshed> best = surface_to_target(input, sizes, run);
  note_missed_target(best.expected, "expected", run);
  return std::move(best.made);
}

// The prediction knows of strips and bounds on deviation once there is a surface, which takes a part of the time that
// the volume takes: it is made to meet the number first, and the mesh then seldom misses it.
Filled fill_to_target(const Prepared& input, const SizeField& sizes, Run& run) {
  const std::size_t first_stage = run.report.stages.size();
  std::optional<TriedSizes<Remeshed>> surface;
  if (!traits_of(run.options.method).makes_own_boundary()) surface = surface_to_target(input, sizes, run);
  std::optional<Remeshed> first;
  if (surface) first = std::move(surface->made);
  const auto make = [&](const SizeField& by) {
    if (!first) return fill(input, by, run);
    Remeshed boundary = std::move(*first);
    first.reset();
    return fill_surface(input, std::move(boundary), run);
  };
  auto best = meet_target(surface ? surface->sizes : sizes, run, first_stage, kElementsAttempts, "in the mesh", make,
                          [&](const Filled& made) {
                            return static_cast<double>(element_count(made, run)) + layer_tets(made, run.options.layers);
                          });
  return std::move(best.made);
}

void note_missed_elements(const Filled& filled, Run& run) {
  note_missed_target(static_cast<double>(element_count(filled, run)), "made", run);
}

}  // namespace octafront
