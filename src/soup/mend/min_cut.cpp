#include "soup/mend/min_cut.h"

#include <algorithm>
#include <limits>

namespace octafront::mend {
namespace {

constexpr std::uint32_t kNoLevel = 0xffffffffu;
/// Capacities below this part of the greatest are rounding.
constexpr double kRounding = 1e-12;

}  // namespace

void MinCut::add_arcs(std::uint32_t a, std::uint32_t b, double there, double back) {
  arcs_at_[a].push_back(static_cast<std::uint32_t>(arcs_.size()));
  arcs_.push_back({b, there});
  arcs_at_[b].push_back(static_cast<std::uint32_t>(arcs_.size()));
  arcs_.push_back({a, back});
}

void MinCut::add_node_cost(std::uint32_t node, double if_sink, double if_source) {
  if (if_sink > 0) add_arcs(source(), node, if_sink, 0);
  if (if_source > 0) add_arcs(node, sink(), if_source, 0);
}

void MinCut::add_edge(std::uint32_t a, std::uint32_t b, double cost) {
  if (a != b && cost > 0) add_arcs(a, b, cost, cost);
}

bool MinCut::find_levels() {
  level_.assign(arcs_at_.size(), kNoLevel);
  std::vector<std::uint32_t> queue{source()};
  level_[source()] = 0;
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (const std::uint32_t arc : arcs_at_[queue[i]]) {
      const auto& [to, left] = arcs_[arc];
      if (left <= 0 || level_[to] != kNoLevel) continue;
      level_[to] = level_[queue[i]] + 1;
      queue.push_back(to);
    }
  return level_[sink()] != kNoLevel;
}

/// Pushes what one way from source to sink along rising levels can take; 0: there is none left.
double MinCut::push() {
  std::vector<std::uint32_t> way;
  std::uint32_t at = source();
  while (at != sink()) {
    bool on = false;
    for (std::uint32_t& i = next_[at]; i < arcs_at_[at].size(); ++i) {
      const std::uint32_t arc = arcs_at_[at][i];
      if (arcs_[arc].left <= 0 || level_[arcs_[arc].to] != level_[at] + 1) continue;
      way.push_back(arc);
      at = arcs_[arc].to;
      on = true;
      break;
    }
    if (on) continue;
    if (way.empty()) return 0;
    at = arcs_[way.back() ^ 1u].to;
    way.pop_back();
    ++next_[at];
  }
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t arc : way) least = std::min(least, arcs_[arc].left);
  for (const std::uint32_t arc : way) {
    arcs_[arc].left -= least;
    arcs_[arc ^ 1u].left += least;
  }
  return least;
}

std::vector<char> MinCut::on_source_side() {
  double greatest = 0;
  for (const Arc& arc : arcs_) greatest = std::max(greatest, arc.left);
  for (Arc& arc : arcs_)
    if (arc.left < kRounding * greatest) arc.left = 0;
  while (find_levels()) {
    next_.assign(arcs_at_.size(), 0);
    while (push() > 0) {
    }
  }
  std::vector<char> side;
  for (std::size_t n = 0; n + 2 < arcs_at_.size(); ++n) side.push_back(level_[n] != kNoLevel);
  return side;
}

}  // namespace octafront::mend
