#include "soup/mend/min_cut.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace octafront::mend {
namespace {

TEST(MinCut, CutsTheWeakestLink) {
  MinCut cut(4);  // a chain 0 - 1 - 2 - 3
  cut.add_node_cost(0, 100, 0);
  cut.add_node_cost(3, 0, 100);
  cut.add_edge(0, 1, 5);
  cut.add_edge(1, 2, 1);
  cut.add_edge(2, 3, 5);
  EXPECT_EQ(cut.on_source_side(), (std::vector<char>{1, 1, 0, 0}));
}

TEST(MinCut, NodesWithoutAReasonAreOnTheSideOfTheSink) {
  MinCut cut(2);
  cut.add_node_cost(0, 1, 0);
  EXPECT_EQ(cut.on_source_side(), (std::vector<char>{1, 0}));
}

struct Problem {
  std::vector<double> if_sink, if_source;
  struct Link {
    std::uint32_t a, b;
    double cost;
  };
  std::vector<Link> links;

  double cost_of(unsigned side) const {
    double cost = 0;
    for (std::size_t n = 0; n < if_sink.size(); ++n) cost += side >> n & 1u ? if_source[n] : if_sink[n];
    for (const Link& l : links) cost += (side >> l.a & 1u) != (side >> l.b & 1u) ? l.cost : 0;
    return cost;
  }
};

TEST(MinCut, FindsTheLeastOfAllCuts) {
  std::uint64_t state = 7;
  const auto random = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 40) / (1u << 24);
  };
  constexpr unsigned kNodes = 8;
  for (int round = 0; round < 50; ++round) {
    Problem p;
    MinCut cut(kNodes);
    for (std::uint32_t n = 0; n < kNodes; ++n) {
      p.if_sink.push_back(random());
      p.if_source.push_back(random());
      cut.add_node_cost(n, p.if_sink[n], p.if_source[n]);
    }
    for (int i = 0; i < 14; ++i) {
      const auto a = static_cast<std::uint32_t>(kNodes * random()), b = static_cast<std::uint32_t>(kNodes * random());
      p.links.push_back({a, b, 0.5 * random()});
      cut.add_edge(a, b, p.links.back().cost);
    }
    const std::vector<char> found = cut.on_source_side();
    unsigned side = 0;
    for (unsigned n = 0; n < kNodes; ++n) side |= static_cast<unsigned>(found[n]) << n;
    double least = p.cost_of(0);
    for (unsigned s = 1; s < 1u << kNodes; ++s) least = std::min(least, p.cost_of(s));
    EXPECT_NEAR(p.cost_of(side), least, 1e-9);
  }
}

}  // namespace
}  // namespace octafront::mend
