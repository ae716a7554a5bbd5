#include "adapt/cut/cutter.h"
#include "base/core/disjoint_sets.h"
#include "base/geometry/measures.h"
#include "base/mesh/adjacency.h"

#include <algorithm>
#include <map>
#include <utility>

namespace octafront::adapt {
namespace {

class Pieces {
 public:
  explicit Pieces(CutState& state)
      : state_(state),
        across_(half_face_neighbors(state.mesh.tets, state.mesh.points.size())),
        piece_(state.mesh.tets.size()) {
    DisjointSets sets(piece_.size());
    for (HalfFace h = 0; h < across_.size(); ++h)
      if (across_[h] != kNone && is_same(h / 4, across_[h] / 4)) sets.join(h / 4, across_[h] / 4);
    std::vector<std::uint32_t> number(piece_.size(), kNone);
    for (TetIndex t = 0; t < piece_.size(); ++t) {
      const auto root = static_cast<std::size_t>(sets.find(t));
      if (number[root] == kNone)
        number[root] = static_cast<std::uint32_t>(volume_.size()), volume_.push_back(0), some_.push_back(t);
      piece_[t] = number[root];
      volume_[piece_[t]] += volume_of_tet(t);
    }
  }

  void count(std::vector<LevelSetReport>& reports) const {
    for (const TetIndex t : some_)
      if (const std::uint32_t inside = state_.inside[t]; inside != kNone) ++reports[inside].pieces;
  }

  /// From the smallest on, so that two small ones beside each other go to what is large.
  void drop(double least, std::vector<LevelSetReport>& reports) {
    std::vector<std::uint32_t> small;
    for (std::uint32_t p = 0; p < volume_.size(); ++p)
      if (volume_[p] < least) small.push_back(p);
    std::sort(small.begin(), small.end(),
              [&](auto a, auto b) { return std::pair(volume_[a], a) < std::pair(volume_[b], b); });
    for (const std::uint32_t p : small) {
      const std::uint32_t before = state_.inside[some_[p]];
      if (!give_away(p)) continue;
      if (before != kNone) ++reports[before].dropped;
    }
  }

 private:
  bool is_same(TetIndex a, TetIndex b) const { return is_of_one_region(a, b) && state_.inside[a] == state_.inside[b]; }
  bool is_of_one_region(TetIndex a, TetIndex b) const {
    const auto& region = state_.mesh.region;
    return region.empty() || region[state_.old_tet[a]] == region[state_.old_tet[b]];
  }
  double volume_of_tet(TetIndex t) const {
    const auto& [a, b, c, d] = state_.mesh.tets[t];
    const auto& p = state_.mesh.points;
    return signed_volume(p[a], p[b], p[c], p[d]);
  }

  bool give_away(std::uint32_t p) {
    std::map<std::uint32_t, double> areas;
    std::vector<TetIndex> members;
    for (TetIndex t = 0; t < piece_.size(); ++t) {
      if (piece_[t] != p) continue;
      members.push_back(t);
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h)
        if (const HalfFace other = across_[h];
            other != kNone && is_of_one_region(t, other / 4) && state_.inside[other / 4] != state_.inside[t])
          areas[state_.inside[other / 4]] += triangle_area(state_.mesh.points, corners_of(state_.mesh.tets, h));
    }
    if (areas.empty()) return false;
    const auto most =
        std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    for (const TetIndex t : members) state_.inside[t] = most->first;
    return true;
  }

  CutState& state_;
  std::vector<HalfFace> across_;
  std::vector<std::uint32_t> piece_;
  std::vector<double> volume_;
  std::vector<TetIndex> some_;  ///< the first tet of each
};

}  // namespace

void drop_pieces(CutState& state, double least, std::vector<LevelSetReport>& reports) {
  Pieces pieces(state);
  pieces.count(reports);
  if (least > 0) pieces.drop(least, reports);
}

}  // namespace octafront::adapt
