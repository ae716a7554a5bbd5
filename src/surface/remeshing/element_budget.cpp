#include "surface/remeshing/element_budget.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

namespace octafront::surface {

double ElementBudget::expected(const SizeField& sizes) {
  if (!expected_) expected_.emplace(surface_);
  return (*expected_)(sizes);
}

SizeField ElementBudget::affordable(const SizeField& finer, const SizeField& first, int round) {
  if (!is_limited()) return finer;
  if (!expected_) expected_.emplace(surface_);
  const WithinCount met = within_count(finer, first, *expected_, most_, stage_.context());
  if (met.floor == 0) return finer;
  if (!is_spent()) spent_in_round_ = round;
  asked_ = std::max(asked_, met.asked);
  floor_ = met.floor;
  return met.sizes;
}

void ElementBudget::note(std::size_t far, double farthest, double deviation) const {
  std::string left, by;
  if (far > 0) {
    left =
        fmt::format(", and {} places lie farther than {:.4g} from the input, up to {:.4g}", far, deviation, farthest);
    by = fmt::format("`max_deviation` {:.4g} or ", deviation);
  }
  stage_.note(
      fmt::format("this surface asks for {:.2g} million elements, and the automatic size has a budget of {:.2g} "
                  "million: it stops at {:.4g}{}. For more ask for it, e.g. with {}`automatic_factor` 0.7",
                  asked_ / 1e6, most_ / 1e6, floor_, left, by));
}

}  // namespace octafront::surface
