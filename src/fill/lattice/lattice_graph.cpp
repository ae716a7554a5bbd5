#include "fill/lattice/lattice_graph.h"

#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <utility>

namespace octafront {

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// Calls visit(i) for 0 <= i < n, in parallel; ends early if the run is cancelled.
template <class Visit>
void for_each_index(std::size_t n, const RunContext& context, const Visit& visit) {
  constexpr std::size_t kBlock = 1024;
  parallel_for((n + kBlock - 1) / kBlock, [&](std::size_t block) {
    if (context.cancelled()) return;
    for (std::size_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) visit(i);
  });
  context.check();
}

class LatticeGraphBuilder {
 public:
  LatticeGraphBuilder(const RootCube& root, const Octree& tree, const ImplicitDomain& domain, const RunContext& context)
      : root_(root), domain_(domain), context_(context) {
    collect(tree);
  }

  LatticeGraph run() {
    find_sides();
    std::erase_if(graph_.tets, [&](const auto& t) {
      return std::none_of(t.begin(), t.end(), [&](std::uint32_t i) { return graph_.side[i] > 0; });
    });
    find_cuts();
    return std::move(graph_);
  }

 private:
  void collect(const Octree& tree) {
    SiteTable table(2 * tree.size());
    for_each_lattice_tet(tree, [&](const std::array<LatticeSite, 4>& tet) {
      if (graph_.tets.size() % 65536 == 0) context_.check();
      auto& t = graph_.tets.emplace_back();
      for (int k = 0; k < 4; ++k) t[k] = table[tet[k]];
    });
    graph_.sites = table.sites();
    graph_.at.reserve(graph_.sites.size());
    for (const LatticeSite s : graph_.sites) graph_.at.push_back(position(root_, s));
  }

  /// Sites whose edges cannot reach the boundary lie on the side of their neighbours of that kind: one test for each
  /// connected set of them is enough.
  void find_sides() {
    const std::size_t n = graph_.sites.size();
    std::vector<double> reach(n, 0);
    for (const auto& t : graph_.tets)
      for (const auto& [i, j] : kTetEdges) {
        const double l = distance(graph_.at[t[i]], graph_.at[t[j]]);
        reach[t[i]] = std::max(reach[t[i]], l);
        reach[t[j]] = std::max(reach[t[j]], l);
      }
    std::vector<char> clear(n);
    // A little more than the longest edge: the length is rounded.
    for_each_index(n, context_, [&](std::size_t i) { clear[i] = domain_.is_clear(graph_.at[i], 1.001 * reach[i]); });
    DisjointSets sets(n);
    for (const auto& t : graph_.tets)
      for (const auto& [i, j] : kTetEdges)
        if (clear[t[i]] && clear[t[j]]) sets.join(t[i], t[j]);
    std::vector<std::uint32_t> speaker(n);
    for (std::uint32_t i = 0; i < n; ++i) speaker[i] = sets.find(i);
    graph_.side.assign(n, 0);
    for_each_index(n, context_, [&](std::size_t i) {
      if (speaker[i] == i) graph_.side[i] = static_cast<std::int8_t>(domain_.side(graph_.at[i]));
    });
    for (std::size_t i = 0; i < n; ++i) graph_.side[i] = graph_.side[speaker[i]];
  }

  void find_cuts() {
    std::vector<Pair> pairs;
    for (const auto& t : graph_.tets)
      for (const auto& [i, j] : kTetEdges)
        if (graph_.side[t[i]] * graph_.side[t[j]] < 0) pairs.push_back(std::minmax(t[i], t[j]));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    graph_.cuts.resize(pairs.size());
    for_each_index(pairs.size(), context_, [&](std::size_t i) {
      auto [in, out] = pairs[i];
      if (graph_.side[in] < 0) std::swap(in, out);
      graph_.cuts[i] = {in, out, domain_.crossing(graph_.at[in], graph_.at[out])};
    });
  }

  const RootCube& root_;
  const ImplicitDomain& domain_;
  const RunContext& context_;
  LatticeGraph graph_;
};

}  // namespace

std::uint32_t LatticeGraph::cut_between(std::uint32_t a, std::uint32_t b) const {
  const Pair key = std::minmax(a, b);
  const auto found = std::lower_bound(cuts.begin(), cuts.end(), key, [](const CutEdge& c, const Pair& k) {
    return Pair(std::minmax(c.inside, c.outside)) < k;
  });
  return static_cast<std::uint32_t>(found - cuts.begin());
}

LatticeGraph build_lattice_graph(const RootCube& root, const Octree& tree, const ImplicitDomain& domain,
                                 const RunContext& context) {
  return LatticeGraphBuilder(root, tree, domain, context).run();
}

}  // namespace octafront
