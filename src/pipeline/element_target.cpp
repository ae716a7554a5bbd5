#include "pipeline/methods.h"
#include "pipeline/stages.h"
#include "sizing/make_size_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <fmt/core.h>

namespace octafront {

namespace {

// The prediction misses when a model is mostly surface; then what came out says by how much to scale.
constexpr double kElementsTolerance = 0.12;  // tighter than the 15 % promised: improvement still changes the count
constexpr int kElementsAttempts = 5;
// By how much to scale the first sizes next, by the counts of the last two meshes. The count falls with the third power
// of the sizes where the volume decides, more slowly where gradation or details of the surface do.
class CountSearch {
 public:
  explicit CountSearch(std::int64_t wanted) : wanted_(std::log(static_cast<double>(wanted))) {}

  double next_factor(std::size_t made) {
    const double count = std::log(static_cast<double>(made));
    if (last_count_ && scale_ != last_scale_)
      slope_ = std::clamp((count - *last_count_) / (scale_ - last_scale_), -4.0, -1.5);
    last_count_ = count;
    last_scale_ = scale_;
    scale_ += (wanted_ - count) / slope_;
    return std::exp(scale_);
  }

 private:
  double wanted_, scale_ = 0, last_scale_ = 0, slope_ = -3;
  std::optional<double> last_count_;
};

double miss(const SizeOptions& options, std::size_t tets) {
  return std::abs(std::log(static_cast<double>(tets) / static_cast<double>(options.elements.value_or(1))));
}

bool meets_target(const SizeOptions& options, std::size_t tets) {
  if (!options.elements) return true;
  const double ratio = static_cast<double>(tets) / static_cast<double>(*options.elements);
  return std::abs(ratio - 1) <= kElementsTolerance;
}

void note_missed_target(const SizeOptions& options, std::size_t made, const char* what_decides, StageReport& stage) {
  if (meets_target(options, made)) return;
  stage.notes.push_back(
      fmt::format("{} elements were wanted; the {} do not allow it: {} made", *options.elements, what_decides, made));
}

/// The stages from here on made what was not kept.
void rename_earlier(Report& report, std::size_t first_stage) {
  for (std::size_t s = first_stage; s < report.stages.size(); ++s) {
    if (!report.stages[s].name.ends_with("(earlier try)")) report.stages[s].name += " (earlier try)";
  }
}

}  // namespace

Filled fill_to_target(const Prepared& input, SizeField sizes, Run& run) {
  const SizeOptions& wanted = run.options.size;
  const bool can_scale = wanted.elements && !keeps_surface(run.options);
  const double first_factor = traits_of(run.options.method).size_factor;
  if (can_scale && first_factor != 1) sizes = scaled(sizes, first_factor, run.context());
  const std::size_t first_stage = run.report.stages.size();
  CountSearch search(wanted.elements.value_or(1));
  Filled best = fill(input, sizes, run);
  std::size_t made = best.mesh.tets.size();
  for (int attempt = 1; can_scale && attempt < kElementsAttempts && !meets_target(wanted, made); ++attempt) {
    const double factor = search.next_factor(made);
    rename_earlier(run.report, first_stage);
    Filled next = fill(input, scaled(sizes, factor, run.context()), run);
    run.report.stages.back().notes.push_back(
        fmt::format("the mesh before had {} elements where {} were wanted: all sizes scaled by {:.4g}", made,
                    *wanted.elements, factor));
    made = next.mesh.tets.size();
    // The lattice doubles its cells: counts may jump over the target, and an earlier mesh may be the better one.
    if (miss(wanted, made) < miss(wanted, best.mesh.tets.size())) best = std::move(next);
  }
  note_missed_target(wanted, best.mesh.tets.size(), can_scale ? "features and size limits" : "kept triangles",
                     run.report.stages.back());
  return best;
}

}  // namespace octafront
