#include "base/core/disjoint_sets.h"
#include "soup/mend/caps.h"

#include <unordered_set>

namespace octafront::mend {
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
