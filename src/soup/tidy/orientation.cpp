#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <utility>

namespace octafront::tidy {
namespace {

/// Per half-edge the other one of its edge, whichever way that runs; kNone where an edge has not two.
std::vector<HalfEdge> half_edges_across(const EdgeTable& table) {
  std::vector<HalfEdge> across(table.half_edges.size(), kNone);
  parallel_for(table.size(), [&](std::size_t e) {
    const auto uses = table.uses(e);
    if (uses.size() != 2) return;
    across[uses[0]] = uses[1];
    across[uses[1]] = uses[0] / 3 == uses[1] / 3 ? uses[1] : uses[0];
  });
  return across;
}

/// Walks over one piece from its first triangle and decides for each triangle whether it must turn to agree with that.
class PieceWalk {
 public:
  explicit PieceWalk(Draft& draft)
      : triangles_(draft.mesh.triangles),
        context_(draft.context),
        across_(half_edges_across(draft.edges())),
        turn_(triangles_.size(), 0) {}

  const std::vector<std::uint32_t>& members() const { return members_; }
  bool turns(std::uint32_t t) const { return turn_[t]; }

  /// Returns whether all agree.
  bool run(std::uint32_t seed, std::uint32_t piece, std::vector<std::uint32_t>& piece_of) {
    members_.assign(1, seed);
    piece_of[seed] = piece;
    bool agree = true;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (k % 4096 == 0) context_.check();
      const std::uint32_t t = members_[k];
      for (std::uint32_t i = 0; i < 3; ++i) {
        const HalfEdge other = across_[3 * t + i];
        if (other == kNone) continue;
        const std::uint32_t neighbour = other / 3;
        const bool along = start_of(triangles_, 3 * t + i) == start_of(triangles_, other);
        const char turn = static_cast<char>(turn_[t] != along);
        if (piece_of[neighbour] == kNone) {
          piece_of[neighbour] = piece;
          turn_[neighbour] = turn;
          members_.push_back(neighbour);
        } else if (turn_[neighbour] != turn) {
          agree = false;
        }
      }
    }
    return agree;
  }

 private:
  const std::vector<Triangle>& triangles_;
  const RunContext& context_;
  const std::vector<HalfEdge> across_;
  std::vector<char> turn_;
  std::vector<std::uint32_t> members_;
};

/// Whether the two faces of each edge agree as they are.
bool agree_as_they_are(std::span<const Triangle> triangles, const EdgeTable& table) {
  return parallel_find(table.size(), [&](std::size_t e) {
           const auto uses = table.uses(e);
           return uses.size() == 2 && start_of(triangles, uses[0]) == start_of(triangles, uses[1]);
         }) == table.size();
}

Pieces pieces_without_turning(std::size_t triangles, const EdgeTable& table) {
  DisjointSets joined(triangles);
  parallel_for(table.size(), [&](std::size_t e) {
    if (table.uses(e).size() == 2) joined.join_shared(table.uses(e)[0] / 3, table.uses(e)[1] / 3);
  });
  const auto first_of = [&](std::size_t t) { return joined.find_shared(static_cast<std::uint32_t>(t)); };
  Pieces pieces;
  std::vector<std::uint32_t>& piece = pieces.piece_of_triangle;
  piece.resize(triangles);
  const std::size_t count = parallel_number(
      triangles, [&](std::size_t t) { return first_of(t) == t; },
      [&](std::size_t t, std::size_t number) { piece[t] = static_cast<std::uint32_t>(number); });
  parallel_for(triangles, [&](std::size_t t) {
    if (const std::uint32_t first = first_of(t); first != t) piece[t] = piece[first];
  });
  pieces.orientable.assign(count, 1);
  return pieces;
}

}  // namespace

Pieces orient_pieces(Draft& draft) {
  std::vector<Triangle>& triangles = draft.mesh.triangles;
  if (agree_as_they_are(triangles, draft.edges())) return pieces_without_turning(triangles.size(), draft.edges());
  PieceWalk walk(draft);
  Pieces pieces;
  pieces.piece_of_triangle.assign(triangles.size(), kNone);
  std::vector<std::uint32_t> to_turn;
  for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
    if (pieces.piece_of_triangle[seed] != kNone) continue;
    pieces.orientable.push_back(walk.run(seed, pieces.count(), pieces.piece_of_triangle));
    const auto& members = walk.members();
    const auto turning = static_cast<std::size_t>(
        std::count_if(members.begin(), members.end(), [&](std::uint32_t t) { return walk.turns(t); }));
    const bool turn_the_turning = 2 * turning <= members.size();
    for (const std::uint32_t t : members)
      if (walk.turns(t) == turn_the_turning) to_turn.push_back(t);
  }
  for (const std::uint32_t t : to_turn) {
    std::swap(triangles[t][1], triangles[t][2]);
    pieces.turned_faces.push_back(draft.face[t]);
  }
  pieces.turned = to_turn.size();
  if (pieces.turned > 0) draft.known_edges.reset();
  sort_unique(pieces.turned_faces);
  return pieces;
}

}  // namespace octafront::tidy
