// Exact gradation of a trilinear field by a front that rises like water.
//
// Along x the derivative of a trilinear function does not depend on x and is bilinear in y and z; so |grad h|^2 is
// convex along each axis and takes its largest value over a leaf at one of the eight corners. There the gradient is
// that of the three edges that meet at the corner. The field is therefore gradation-Lipschitz exactly when for every
// corner c of every leaf of side s, with its three neighbours n_i in the leaf,
//
//     sum_i (h(n_i) - h(c))^2 <= g^2 s^2.                                                   (*)
//
// (Bounds on single edges do not give that: three edges of slope g at one corner have a gradient of sqrt(3) g.)
//
// Which values to lower where (*) fails is a choice; ours treats all alike. Let a level t rise from 0, and all corners
// with it, each until it is stopped for good: by its cap, or because a constraint (*) that it takes part in would break
// if it rose further. At any time min(h, t) obeys (*), so the end result does. Corners stop in the order of their
// values: this is Dijkstra's algorithm with (*) in place of edge lengths. In one constraint the corners that still rise
// are at t and the others at their values, hanging corners are combinations of both, hence (*) is a quadratic
// inequality in t. Its larger root can grow while corners stop (a neighbour that stopped early leaves the others more
// room), so it is computed anew when a corner's turn comes.

#include "sizing/gradation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace octafront {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Keeps (*) true in spite of rounding.
constexpr double kSafety = 1 - 1e-9;

class RisingFront {
 public:
  RisingFront(const Octree& tree, const OctreeCorners& corners, const std::vector<double>& caps, double gradation,
              double ceiling)
      : tree_(tree),
        corners_(corners),
        caps_(caps),
        slope_(gradation * kSafety),
        ceiling_(ceiling),
        value_(corners.size(), ceiling),
        stopped_(corners.size(), 0) {
    collect_leaves();
  }

  std::vector<double> run(const RunContext& context) {
    for (std::uint32_t c = 0; c < corners_.size(); ++c) {
      if (!corners_.hangs(c) && caps_[c] < ceiling_) propose(c, caps_[c]);
    }
    for (std::size_t steps = 0; !heap_.empty(); ++steps) {
      if (steps % 4096 == 0) context.check();
      const Proposal p = heap_.top();
      heap_.pop();
      if (stopped_[p.corner] || p.level > value_[p.corner]) continue;
      level_ = std::max(level_, p.level);
      if (p.level < caps_[p.corner]) {
        const double room = std::min({room_of(p.corner), caps_[p.corner], ceiling_});
        if (room > p.level * (1 + 1e-12)) {
          value_[p.corner] = ceiling_;
          propose(p.corner, room);
          continue;
        }
      }
      stop(p.corner);
    }
    for (std::uint32_t c = 0; c < corners_.size(); ++c) {
      if (corners_.hangs(c)) value_[c] = interpolated(c);
    }
    return std::move(value_);
  }

 private:
  struct Proposal {
    double level;
    std::uint32_t corner;
    bool operator<(const Proposal& b) const { return level != b.level ? level > b.level : corner > b.corner; }
  };
  /// h of a leaf's corner as a function of the level: fixed + rising * t.
  struct Line {
    double fixed, rising;
  };

  template <class Visit>
  void for_each_share(std::uint32_t corner, Visit&& visit) const {
    if (!corners_.hangs(corner)) return visit(corner, 1.0);
    for (const OctreeCorners::Share& s : corners_.shares_of(corner)) visit(s.corner, s.weight);
  }

  /// leaves_[first_leaf_[c] ... first_leaf_[c + 1]): the leaves whose corners depend on the free corner c.
  void collect_leaves() {
    std::vector<std::uint32_t> last(corners_.size(), ~0u);
    first_leaf_.assign(corners_.size() + 1, 0);
    const auto visit_pairs = [&](auto&& visit) {
      std::fill(last.begin(), last.end(), ~0u);
      for (std::uint32_t l = 0; l < tree_.size(); ++l) {
        for (const std::uint32_t corner : corners_.of_leaf[l]) {
          for_each_share(corner, [&](std::uint32_t free, double) {
            if (last[free] == l) return;
            last[free] = l;
            visit(free, l);
          });
        }
      }
    };
    visit_pairs([&](std::uint32_t free, std::uint32_t) { ++first_leaf_[free + 1]; });
    for (std::size_t c = 0; c < corners_.size(); ++c) first_leaf_[c + 1] += first_leaf_[c];
    leaves_.resize(first_leaf_.back());
    std::vector<std::uint32_t> next(first_leaf_.begin(), first_leaf_.end() - 1);
    visit_pairs([&](std::uint32_t free, std::uint32_t l) { leaves_[next[free]++] = l; });
  }

  double interpolated(std::uint32_t corner) const {
    double sum = 0;
    for (const OctreeCorners::Share& s : corners_.shares_of(corner)) sum += s.weight * value_[s.corner];
    return sum;
  }

  void propose(std::uint32_t corner, double level) {
    if (stopped_[corner] || !(level < value_[corner])) return;
    value_[corner] = level;
    heap_.push({level, corner});
  }

  /// The level at which the constraint of corner c of a leaf becomes an equality.
  static double level_of_equality(const std::array<Line, 8>& h, int c, double bound) {
    double a = 0, b = 0, rest = -bound * bound;
    for (int axis = 1; axis < 8; axis *= 2) {
      const double fixed = h[c ^ axis].fixed - h[c].fixed, rising = h[c ^ axis].rising - h[c].rising;
      a += rising * rising;
      b += rising * fixed;
      rest += fixed * fixed;
    }
    if (a == 0) return kInfinity;
    return (std::sqrt(std::max(0.0, b * b - a * rest)) - b) / a;
  }

  /// For each corner of the leaf: the level at which the first of the constraints that it is part of binds. False if
  /// nothing in the leaf rises any more.
  bool rooms_in(std::uint32_t leaf, std::array<double, 8>& room) const {
    std::array<Line, 8> h;
    bool rising = false;
    for (int k = 0; k < 8; ++k) {
      h[k] = {0, 0};
      for_each_share(corners_.of_leaf[leaf][k], [&](std::uint32_t free, double weight) {
        (stopped_[free] ? h[k].fixed : h[k].rising) += stopped_[free] ? weight * value_[free] : weight;
      });
      rising = rising || h[k].rising > 0;
    }
    if (!rising) return false;
    room.fill(kInfinity);
    const double bound = slope_ / (1u << tree_.leaf(leaf).level());
    for (int c = 0; c < 8; ++c) {
      const double t = std::max(level_, level_of_equality(h, c, bound));
      for (const int k : {c, c ^ 1, c ^ 2, c ^ 4}) room[k] = std::min(room[k], t);
    }
    return true;
  }

  double room_of(std::uint32_t corner) const {
    double least = kInfinity;
    std::array<double, 8> room;
    for (std::uint32_t i = first_leaf_[corner]; i < first_leaf_[corner + 1]; ++i) {
      if (!rooms_in(leaves_[i], room)) continue;
      for (int k = 0; k < 8; ++k) {
        for_each_share(corners_.of_leaf[leaves_[i]][k], [&](std::uint32_t free, double) {
          if (free == corner) least = std::min(least, room[k]);
        });
      }
    }
    return least;
  }

  void stop(std::uint32_t corner) {
    stopped_[corner] = 1;
    std::array<double, 8> room;
    for (std::uint32_t i = first_leaf_[corner]; i < first_leaf_[corner + 1]; ++i) {
      if (!rooms_in(leaves_[i], room)) continue;
      for (int k = 0; k < 8; ++k) {
        for_each_share(corners_.of_leaf[leaves_[i]][k], [&](std::uint32_t free, double) { propose(free, room[k]); });
      }
    }
  }

  const Octree& tree_;
  const OctreeCorners& corners_;
  const std::vector<double>& caps_;
  double slope_, ceiling_, level_ = 0;
  std::vector<double> value_;  ///< the final value, or the lowest proposal so far
  std::vector<std::uint8_t> stopped_;
  std::vector<std::uint32_t> first_leaf_, leaves_;
  std::priority_queue<Proposal> heap_;
};

}  // namespace

std::vector<double> graded_corner_values(const Octree& tree, const OctreeCorners& corners,
                                         const std::vector<double>& caps, double gradation, double ceiling,
                                         const RunContext& context) {
  return RisingFront(tree, corners, caps, gradation, ceiling).run(context);
}

}  // namespace octafront
