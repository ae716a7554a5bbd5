#include "adapt/carry/regions.h"

#include <algorithm>
#include <numeric>

#include <fmt/core.h>

namespace octafront::adapt {
namespace {

std::uint32_t regions_in(const TetMesh& mesh) {
  std::uint32_t count = 1;
  for (const std::uint32_t r : mesh.region) count = std::max(count, r + 1);
  return count;
}

/// One per region; none: one of them has no name, or the name of another.
std::vector<std::string> region_names_of(const TetMesh& mesh) {
  std::vector<std::string> names(mesh.region_names);
  names.resize(regions_in(mesh));
  std::vector<std::string> sorted(names);
  std::sort(sorted.begin(), sorted.end());
  const bool is_unique = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  return is_unique && !sorted.front().empty() ? names : std::vector<std::string>();
}

}  // namespace

MatchedRegions::MatchedRegions(const TetMesh& before, const TetMesh& now) : before_(before), now_(now) {
  old_.resize(regions_in(before)), new_.resize(regions_in(now));
  std::iota(old_.begin(), old_.end(), 0u), std::iota(new_.begin(), new_.end(), 0u);
  count_ = static_cast<std::uint32_t>(old_.size());
  is_matched = old_.size() == new_.size();
  const std::vector<std::string> old_names = region_names_of(before), new_names = region_names_of(now);
  // Of one region each, whatever they are called, there is no doubt.
  if (is_matched && count_ > 1 && !old_names.empty() && !new_names.empty())
    for (std::size_t r = 0; r < new_.size() && is_matched; ++r) {
      const auto at = std::find(old_names.begin(), old_names.end(), new_names[r]);
      is_matched = at != old_names.end();
      new_[r] = static_cast<std::uint32_t>(at - old_names.begin());
    }
  if (is_matched) return;
  note = fmt::format(
      "the regions of the old mesh ({}) and of the new one ({}) are not the same ones, by name or number: both are "
      "taken "
      "as one body each, and what is carried may cross from one region to another",
      old_.size(), new_.size());
  std::fill(old_.begin(), old_.end(), 0u), std::fill(new_.begin(), new_.end(), 0u);
  count_ = 1;
}

}  // namespace octafront::adapt
