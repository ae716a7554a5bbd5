#include "base/core/disjoint_sets.h"
#include "soup/mend/caps.h"

#include <algorithm>
#include <map>
#include <unordered_set>

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

namespace {

/// What hangs together by edges of two triangles.
struct Piece {
  bool is_open = false, is_joined = false, has_inner_vertex = false;
  int loops = 0;

  bool is_fin() const { return is_open && !has_inner_vertex && (is_joined || loops == 1); }
};

class PiecesOfSoup {
 public:
  PiecesOfSoup(std::span<const Triangle> triangles, const EdgeTable& table, const std::vector<Loop>& loops)
      : sets_(triangles.size()), pieces_(triangles.size()) {
    for (std::size_t e = 0; e < table.size(); ++e)
      if (const auto uses = table.uses(e); uses.size() == 2) sets_.join(uses[0] / 3, uses[1] / 3);
    for (std::size_t e = 0; e < table.size(); ++e) note_rim(table, e);
    for (const Loop& loop : loops) ++piece_of(loop.triangles.front()).loops;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (const VertexIndex v : triangles[t])
        if (!on_rim_.contains(key(t, v))) piece_of(t).has_inner_vertex = true;
  }

  Piece& piece_of(std::uint32_t triangle) { return pieces_[sets_.find(triangle)]; }

 private:
  void note_rim(const EdgeTable& table, std::size_t edge) {
    const auto uses = table.uses(edge);
    if (uses.size() == 2) return;
    for (const HalfEdge h : uses) {
      Piece& piece = piece_of(h / 3);
      (uses.size() == 1 ? piece.is_open : piece.is_joined) = true;
      for (const VertexIndex v : table.edges[edge]) on_rim_.insert(key(h / 3, v));
    }
  }

  std::uint64_t key(std::uint32_t triangle, VertexIndex v) {
    return (static_cast<std::uint64_t>(sets_.find(triangle)) << 32) | v;
  }

  DisjointSets sets_;
  std::vector<Piece> pieces_;                 ///< at the first triangle of each
  std::unordered_set<std::uint64_t> on_rim_;  ///< vertices of each piece, see key()
};

}  // namespace

std::vector<char> triangles_of_fins(std::span<const Triangle> triangles, const EdgeTable& table,
                                    const std::vector<Loop>& loops) {
  PiecesOfSoup pieces(triangles, table, loops);
  std::vector<char> is_of_fin(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) is_of_fin[t] = pieces.piece_of(t).is_fin();
  return is_of_fin;
}

}  // namespace octafront::mend
