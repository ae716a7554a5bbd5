#include "soup/mend/caps.h"

#include <algorithm>
#include <map>

namespace octafront::mend {
namespace {

class Tracer {
 public:
  Tracer(std::span<const Triangle> triangles, const EdgeTable& table)
      : triangles_(triangles), table_(table), edge_of_(table.edge_of_half_edge()), next_(3 * triangles.size(), kNone) {}

  std::vector<Loop> loops() {
    link_by_fans();
    link_leftovers();
    std::vector<Loop> found;
    std::vector<char> seen(next_.size(), 0);
    for (HalfEdge h = 0; h < next_.size(); ++h) {
      if (!is_open(h) || seen[h]) continue;
      std::vector<HalfEdge> chain;
      HalfEdge g = h;
      for (; g != kNone && !seen[g]; g = next_[g]) {
        seen[g] = 1;
        chain.push_back(g);
      }
      if (g == h) add_simple_loops(chain, found);
    }
    return found;
  }

 private:
  bool is_open(HalfEdge h) const { return table_.uses(edge_of_[h]).size() == 1; }

  /// The open half-edge that leaves the end of h in the same fan of triangles.
  HalfEdge next_in_fan(HalfEdge h) const {
    HalfEdge g = next_of(h);
    while (!is_open(g)) {
      const auto uses = table_.uses(edge_of_[g]);
      if (uses.size() != 2) return kNone;
      const HalfEdge twin = uses[0] == g ? uses[1] : uses[0];
      if (start_of(triangles_, twin) == start_of(triangles_, g)) return kNone;
      g = next_of(twin);
      if (g == next_of(h)) return kNone;
    }
    return g;
  }

  void link_by_fans() {
    for (HalfEdge h = 0; h < next_.size(); ++h)
      if (is_open(h)) next_[h] = next_in_fan(h);
  }

  /// Chains that end at one vertex go on where others begin there.
  void link_leftovers() {
    std::vector<char> reached(next_.size(), 0);
    for (const HalfEdge n : next_)
      if (n != kNone) reached[n] = 1;
    std::map<VertexIndex, std::vector<HalfEdge>> beginning;
    for (HalfEdge h = 0; h < next_.size(); ++h)
      if (is_open(h) && !reached[h]) beginning[start_of(triangles_, h)].push_back(h);
    for (HalfEdge h = 0; h < next_.size(); ++h) {
      if (!is_open(h) || next_[h] != kNone) continue;
      const auto at = beginning.find(end_of(triangles_, h));
      if (at == beginning.end() || at->second.empty()) continue;
      next_[h] = at->second.front();
      at->second.erase(at->second.begin());
    }
  }

  /// Where a chain comes back to a vertex, a loop of its own ends.
  void add_simple_loops(const std::vector<HalfEdge>& chain, std::vector<Loop>& found) const {
    std::vector<HalfEdge> open;
    std::map<VertexIndex, std::size_t> place;  // in `open`, of the half-edge that begins there
    for (const HalfEdge h : chain) {
      const auto [at, is_new] = place.try_emplace(start_of(triangles_, h), open.size());
      if (!is_new) {
        const std::size_t first = at->second;
        add_loop({open.begin() + static_cast<std::ptrdiff_t>(first), open.end()}, found);
        for (std::size_t i = first; i < open.size(); ++i) place.erase(start_of(triangles_, open[i]));
        open.resize(first);
        place[start_of(triangles_, h)] = open.size();
      }
      open.push_back(h);
    }
    add_loop(open, found);
  }

  void add_loop(const std::vector<HalfEdge>& rim, std::vector<Loop>& found) const {
    if (rim.size() < 3) return;
    Loop loop;
    for (auto h = rim.rbegin(); h != rim.rend(); ++h) {
      loop.vertices.push_back(end_of(triangles_, *h));
      loop.triangles.push_back(*h / 3);
    }
    found.push_back(std::move(loop));
  }

  std::span<const Triangle> triangles_;
  const EdgeTable& table_;
  RawVector<std::uint32_t> edge_of_;
  std::vector<HalfEdge> next_;
};

}  // namespace

std::vector<Loop> find_loops(std::span<const Triangle> triangles, const EdgeTable& table) {
  return Tracer(triangles, table).loops();
}

}  // namespace octafront::mend
