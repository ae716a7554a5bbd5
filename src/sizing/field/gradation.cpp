// Exact gradation of a trilinear field.
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
// Three steps. A shortest-path sweep over the corners, along the edges of leaves, gives values that are too large by up
// to that factor. (Diagonals as well bring it nearer, but cost more than they save below.) Then leaves are visited from
// small to large sizes, in groups of about one size, and where (*) fails the highest of the four values are cut off at
// the level at which it holds; a few rounds suffice, since every cut is made by smaller values, which are settled
// before. Leaves of a group are cut at the same time, none sees what others cut, and the least that any leaves a corner
// holds: so threads share them, and their number is not seen. What is left (below kTolerance) is removed by shrinking
// all differences by one factor. (Stopping corners exactly, in the order of their values, while a level rises needs no
// last step, but each corner has to be asked several times: twenty times slower.)

#include "sizing/field/gradation.h"

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/core/shared_value.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

namespace octafront {

namespace {

/// Keeps (*) true in spite of rounding.
constexpr double kSafety = 1 - 1e-9;
/// Slopes that exceed the gradation by less are left to the last step, which takes as much off all differences of size.
constexpr double kTolerance = 1e-3;
/// Rounds end when nothing exceeds it; this bound is never met in practice, and what exceeds it then is shrunk away
/// too.
constexpr int kMostRounds = 60;
/// Hanging corners of one leaf that share a free corner can move each other in circles; after these passes over a group
/// all that lies behind a hanging corner is cut at the level.
constexpr int kGentlePasses = 12;
/// Passes over a group end when nothing in it exceeds the gradation; what this bound leaves is left to the next round.
constexpr int kMostPasses = 30;
/// Leaves of which the smallest corners differ by less are one group: about one leaf lies between its ends.
constexpr double kRatioInGroup = 1.1;
constexpr std::uint32_t kColours = 4;
constexpr std::size_t kCornersAtOnce = 512, kLeavesAtOnce = 32, kMarksAtOnce = 16384;

/// A free corner is to be no higher.
struct Cut {
  std::uint32_t corner;
  double value, source;
};

/// Shortest paths with sources everywhere; hanging corners take part like others here.
class PathSweep {
 public:
  PathSweep(const Octree& tree, const OctreeCorners& corners, double slope, std::span<double> value,
            std::span<double> source)
      : tree_(tree), corners_(corners), slope_(slope), value_(value), source_(source) {}

  /// Each corner that was lowered lowers its neighbours in turn, until none is left: in any order the least sums
  /// remain.
  void run(const RunContext& context) {
    const RawVector<double> caps = parallel_copy(value_);
    Lowered lowered = parallel_collect<std::uint32_t, Lowered>(
        value_.size(), kCornersAtOnce, [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& out) {
          for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c) {
            bool limits = false;
            for_each_limited(c, [&](std::uint32_t, double) { limits = true; });
            if (limits) out.push_back(c);
          }
        });
    RawVector<std::uint8_t> waits = parallel_filled(value_.size(), std::uint8_t{0});
    while (!lowered.empty()) {
      context.check();
      lowered = lower_neighbours_of(lowered, waits);
      parallel_for(lowered.size(), [&](std::size_t i) { waits[lowered[i]] = 0; });
    }
    take_sources(caps);
  }

 private:
  using Lowered = RawVector<std::uint32_t>;

  /// Calls visit(corner, value) for each corner that an edge of a leaf joins to `from` and that its value limits.
  template <class Visit>
  void for_each_limited(std::uint32_t from, Visit&& visit) {
    for (const std::uint32_t i : corners_.leaves[from]) {
      const std::uint32_t leaf = i / 8, k = i % 8;
      const double rise = slope_ / (1u << tree_.leaf(leaf).level());
      for (std::uint32_t d = 1; d < 8; d *= 2) {
        const std::uint32_t to = corners_.of_leaf[leaf][k ^ d];
        const double v = SharedValue(value_[from]).load() + rise;
        if (v < SharedValue(value_[to]).load()) visit(to, v);
      }
    }
  }

  /// Returns those that it lowers, each once. `waits`: whether a corner is among them.
  Lowered lower_neighbours_of(const Lowered& corners, RawVector<std::uint8_t>& waits) {
    return parallel_collect<std::uint32_t, Lowered>(
        corners.size(), kCornersAtOnce, [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& out) {
          for (std::size_t i = begin; i < end; ++i)
            for_each_limited(corners[i], [&](std::uint32_t to, double v) {
              SharedValue(value_[to]).lower_to(v);
              if (!SharedValue(waits[to]).exchange(1)) out.push_back(to);
            });
        });
  }

  /// A corner has the source of the one that lowered it, which has its own from another: of those from which its value
  /// comes the least one, and the first of these.
  void take_sources(const RawVector<double>& caps) {
    RawVector<std::uint32_t> from(value_.size()), next(value_.size());
    parallel_for(value_.size(), [&](std::size_t c) {
      from[c] = static_cast<std::uint32_t>(c);
      if (value_[c] < caps[c]) from[c] = lowered_by(static_cast<std::uint32_t>(c));
    });
    for (bool moved = true; moved; from.swap(next)) {
      std::atomic<bool> any{false};
      parallel_ranges(from.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
        bool here = false;
        for (std::size_t c = begin; c < end; ++c) {
          next[c] = from[from[c]];
          here = here || next[c] != from[c];
        }
        if (here) any = true;
      });
      moved = any;
    }
    // Where paths begin sources stay.
    parallel_for(value_.size(), [&](std::size_t c) {
      if (from[c] != c) source_[c] = source_[from[c]];
    });
  }

  std::uint32_t lowered_by(std::uint32_t corner) const {
    std::uint32_t best = corner;
    for (const std::uint32_t i : corners_.leaves[corner]) {
      const std::uint32_t leaf = i / 8, k = i % 8;
      const double rise = slope_ / (1u << tree_.leaf(leaf).level());
      for (std::uint32_t d = 1; d < 8; d *= 2) {
        const std::uint32_t by = corners_.of_leaf[leaf][k ^ d];
        if (value_[by] + rise != value_[corner]) continue;
        if (best == corner || std::pair(value_[by], by) < std::pair(value_[best], best)) best = by;
      }
    }
    return best;
  }

  const Octree& tree_;
  const OctreeCorners& corners_;
  double slope_;
  std::span<double> value_, source_;
};

class Grader {
 public:
  Grader(const Octree& tree, const OctreeCorners& corners, GradedCorners caps, double gradation, double ceiling)
      : tree_(tree),
        corners_(corners),
        slope_(gradation * kSafety),
        value_(std::move(caps.value)),
        source_(std::move(caps.source)) {
    parallel_for(value_.size(), [&](std::size_t c) {
      if (!(value_[c] < ceiling)) value_[c] = source_[c] = ceiling;
    });
  }

  GradedCorners run(const RunContext& context) {
    PathSweep(tree_, corners_, slope_, value_, source_).run(context);
    order_leaves();
    collect_dependents();
    dirty_ = parallel_filled(tree_.size(), std::uint8_t{1});
    for (int round = 1; round <= kMostRounds; ++round) {
      context.check();
      if (!cut_steep_leaves()) break;
    }
    shrink();
    GradedCorners result{RawVector<double>(value_.size()), RawVector<double>(value_.size())};
    parallel_for(value_.size(), [&](std::size_t i) {
      const auto c = static_cast<std::uint32_t>(i);
      result.value[c] = at(value_, c);
      result.source[c] = std::min(at(source_, c), result.value[c]);
    });
    return result;
  }

 private:
  /// `of_free(corner)`: what free corners have.
  template <class OfFree>
  double at_corner(std::uint32_t corner, const OfFree& of_free) const {
    if (!corners_.hangs(corner)) return of_free(corner);
    double sum = 0;
    for (const OctreeCorners::Share& s : corners_.shares_of(corner)) sum += s.weight * of_free(s.corner);
    return sum;
  }
  double at(const RawVector<double>& of_free, std::uint32_t corner) const {
    return at_corner(corner, [&](std::uint32_t c) { return of_free[c]; });
  }

  /// Leaves in the order of their smallest corner, in groups; in a group by colour and along the curve.
  void order_leaves() {
    struct Place {
      double least;
      std::uint32_t leaf;
      auto operator<=>(const Place&) const = default;
    };
    RawVector<Place> order(tree_.size());
    plain_.resize(tree_.size());
    parallel_for(tree_.size(), [&](std::size_t l) {
      const auto& corners = corners_.of_leaf[l];
      double least = value_[corners[0]];
      for (const std::uint32_t c : corners) least = std::min(least, value_[c]);
      order[l] = {least, static_cast<std::uint32_t>(l)};
      plain_[l] = std::none_of(corners.begin(), corners.end(), [&](std::uint32_t c) { return corners_.hangs(c); });
    });
    parallel_sort(order);
    std::vector<std::uint32_t> group_ends;
    for (auto begin = order.begin(); begin != order.end();) {
      begin = std::lower_bound(begin + 1, order.end(), Place{begin->least * kRatioInGroup, 0});
      group_ends.push_back(static_cast<std::uint32_t>(begin - order.begin()));
    }
    RawVector<std::uint32_t> group_of(tree_.size());
    parallel_ranges(order.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
      auto group = std::upper_bound(group_ends.begin(), group_ends.end(), begin);
      for (std::size_t i = begin; i < end; ++i) {
        if (i == *group) ++group;
        group_of[order[i].leaf] = static_cast<std::uint32_t>(group - group_ends.begin());
      }
    });
    in_turn_ = group_by_owner(kColours * group_ends.size(), static_cast<std::uint32_t>(tree_.size()),
                              [&](std::uint32_t l) { return kColours * group_of[l] + colour_of(l); });
    rank_.resize(tree_.size());
    parallel_for(tree_.size(), [&](std::size_t i) { rank_[in_turn_.items()[i]] = static_cast<std::uint32_t>(i); });
  }

  double bound_of(std::uint32_t leaf) const { return slope_ / (1u << tree_.leaf(leaf).level()); }

  void collect_dependents() {
    RawVector<std::uint32_t> hanging(corners_.shares.size());  // whose the shares are
    parallel_for(corners_.size(), [&](std::size_t c) {
      std::fill(hanging.begin() + corners_.first_share[c], hanging.begin() + corners_.first_share[c + 1],
                static_cast<std::uint32_t>(c));
    });
    dependents_ = group_by_owner(corners_.size(), static_cast<std::uint32_t>(hanging.size()),
                                 [&](std::uint32_t i) { return corners_.shares[i].corner; });
    parallel_for(dependents_.size(), [&](std::size_t c) {
      for (std::uint32_t& i : dependents_[c]) i = hanging[i];
    });
  }

  /// The leaves that see a corner have to be looked at (again).
  void mark(std::uint32_t corner) {
    for (const std::uint32_t i : corners_.leaves[corner]) SharedValue(dirty_[rank_[i / 8]]).store(1);
  }

  /// At each corner of a leaf. Both ends of an edge rise as much, one up and one down.
  static std::array<double, 8> squared_slopes(const std::array<double, 8>& h) {
    std::array<double, 8> x, y, z, slopes;
    for (std::size_t c = 0; c < 8; c += 2) x[c] = x[c + 1] = squared(h[c + 1] - h[c]);
    for (const std::size_t c : {0, 1, 4, 5}) y[c] = y[c + 2] = squared(h[c + 2] - h[c]);
    for (std::size_t c = 0; c < 4; ++c) z[c] = z[c + 4] = squared(h[c + 4] - h[c]);
    for (std::size_t c = 0; c < 8; ++c) slopes[c] = x[c] + y[c] + z[c];
    return slopes;
  }
  static double squared(double x) { return x * x; }
  double steepest_in(std::uint32_t leaf) const {
    const std::array<double, 8> slopes = squared_slopes(values_of(leaf));
    return *std::ranges::max_element(slopes);
  }

  template <class OfFree>
  std::array<double, 8> values_of(std::uint32_t leaf, const OfFree& of_free) const {
    std::array<double, 8> h;
    const auto& corner = corners_.of_leaf[leaf];
    for (int k = 0; k < 8; ++k) h[k] = plain_[leaf] ? of_free(corner[k]) : at_corner(corner[k], of_free);
    return h;
  }
  std::array<double, 8> values_of(std::uint32_t leaf) const {
    return values_of(leaf, [&](std::uint32_t c) { return value_[c]; });
  }

  double tolerated(std::uint32_t leaf) const {
    const double bound = bound_of(leaf);
    return bound * bound * (1 + kTolerance) * (1 + kTolerance);
  }

  bool is_steep(std::uint32_t leaf) const { return steepest_in(leaf) > tolerated(leaf); }

  /// Leaves that are not steep as the round begins need a look only if a cut touches them, which marks them.
  void forget_gentle_leaves() {
    parallel_for(tree_.size(), [this](std::size_t i) {
      if (dirty_[i] && !is_steep(in_turn_.items()[i])) dirty_[i] = 0;
    });
  }

  /// True if anything was cut.
  bool cut_steep_leaves() {
    forget_gentle_leaves();
    bool any = false;
    for (std::size_t first = 0; first < in_turn_.size(); first += kColours)
      for (int pass = 1; pass <= kMostPasses; ++pass) {
        if (!cut_in_group(first, pass <= kGentlePasses)) break;
        any = true;
      }
    return any;
  }

  /// `first`: its leaves of the first colour.
  bool cut_in_group(std::size_t first, bool gently) {
    bool any = false;
    for (std::size_t turn = first; turn < first + kColours; ++turn) {
      const auto cuts = cuts_of(dirty_in(turn), gently);
      make(cuts);
      any = any || !cuts.empty();
    }
    return any;
  }

  /// Of eight children two are of one colour, which share a corner alone.
  std::uint32_t colour_of(std::uint32_t leaf) const {
    const int child = tree_.leaf(leaf).child_number();
    return static_cast<std::uint32_t>(std::min(child, 7 - child));
  }

  /// The dirty leaves of a group and colour, which are no more so.
  RawVector<std::uint32_t> dirty_in(std::size_t turn) {
    const std::uint8_t* first = dirty_.data() + in_turn_.first(turn);
    return parallel_collect<std::uint32_t, RawVector<std::uint32_t>>(
        in_turn_[turn].size(), kMarksAtOnce,
        [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
          const auto next = [&](const std::uint8_t* from) {
            return static_cast<const std::uint8_t*>(std::memchr(from, 1, static_cast<std::size_t>(first + end - from)));
          };
          for (const std::uint8_t* at = next(first + begin); at != nullptr; at = next(at + 1)) {
            found.push_back(in_turn_.items()[static_cast<std::size_t>(at - dirty_.data())]);
            dirty_[static_cast<std::size_t>(at - dirty_.data())] = 0;
          }
        });
  }

  /// What these leaves ask of their corners.
  RawVector<Cut> cuts_of(const RawVector<std::uint32_t>& leaves, bool gently) const {
    return parallel_collect<Cut, RawVector<Cut>>(leaves.size(), kLeavesAtOnce,
                                                 [&](std::size_t begin, std::size_t end, std::vector<Cut>& cuts) {
                                                   for (std::size_t i = begin; i < end; ++i)
                                                     collect_cuts(leaves[i], gently, cuts);
                                                 });
  }

  /// Of the cuts of a corner the lowest holds; of several such, the least source.
  void make(const RawVector<Cut>& cuts) {
    if (cuts.empty()) return;
    parallel_for(cuts.size(), [&](std::size_t i) { SharedValue(value_[cuts[i].corner]).lower_to(cuts[i].value); });
    const auto for_each_that_holds = [&](const auto& visit) {
      parallel_for(cuts.size(), [&](std::size_t i) {
        if (cuts[i].value == value_[cuts[i].corner]) visit(cuts[i]);
      });
    };
    for_each_that_holds([&](const Cut& cut) { SharedValue(source_[cut.corner]).store(HUGE_VAL); });
    for_each_that_holds([&](const Cut& cut) {
      SharedValue(source_[cut.corner]).lower_to(cut.source);
      mark(cut.corner);
      for (const std::uint32_t c : dependents_[cut.corner]) mark(c);
    });
  }

  /// A leaf sees its own cuts, behind those that there are.
  void collect_cuts(std::uint32_t leaf, bool gently, std::vector<Cut>& cuts) const {
    const std::size_t first = cuts.size();
    const auto now = [&](std::uint32_t corner) {
      for (std::size_t i = cuts.size(); i-- > first;)
        if (cuts[i].corner == corner) return cuts[i].value;
      return value_[corner];
    };
    std::array<double, 8> h = values_of(leaf), slopes = squared_slopes(h);
    const double most = tolerated(leaf);
    for (int c = 0; c < 8; ++c) {
      if (slopes[static_cast<std::size_t>(c)] <= most) continue;
      cut(leaf, c, level_of_cut(h, c, bound_of(leaf)), h, now, gently, cuts);
      h = values_of(leaf, now);
      slopes = squared_slopes(h);
    }
  }

  /// The level at which (*) holds with equality once the values above it are cut off there.
  static double level_of_cut(const std::array<double, 8>& h, int c, double bound) {
    std::array<double, 4> v{h[c], h[c ^ 1], h[c ^ 2], h[c ^ 4]};
    std::array<double, 4> sorted = v;
    std::sort(sorted.begin(), sorted.end());
    for (int top = 3; top > 0; --top) {
      // Values from sorted[top] on are at the level t, the others below it: a t^2 + 2 b t + rest = 0.
      double a = 0, b = 0, rest = -bound * bound;
      const bool center_rises = v[0] >= sorted[top];
      for (int i = 1; i < 4; ++i) {
        const bool rises = v[i] >= sorted[top];
        const double fixed = (rises ? 0 : v[i]) - (center_rises ? 0 : v[0]);
        const double rising = double(rises) - double(center_rises);
        a += rising * rising;
        b += rising * fixed;
        rest += fixed * fixed;
      }
      if (a == 0) continue;
      const double root = b * b - a * rest;
      const double t = root < 0 ? -1 : (std::sqrt(root) - b) / a;
      if (t >= sorted[top - 1]) return t;
    }
    return sorted[0];
  }

  template <class Now>
  void cut(std::uint32_t leaf, int c, double level, const std::array<double, 8>& h, const Now& now, bool gently,
           std::vector<Cut>& cuts) const {
    int lowest = c;
    for (const int k : {c ^ 1, c ^ 2, c ^ 4})
      if (h[k] < h[lowest]) lowest = k;
    const double source = at(source_, corners_.of_leaf[leaf][lowest]);
    for (const int k : {c, c ^ 1, c ^ 2, c ^ 4}) {
      if (h[k] <= level) continue;
      const std::uint32_t corner = corners_.of_leaf[leaf][k];
      if (!corners_.hangs(corner)) {
        cuts.push_back({corner, level, source});
        continue;
      }
      // The shares above the level give way in proportion to what they are above it.
      double above = 0;
      for (const auto& s : corners_.shares_of(corner)) above += s.weight * std::max(0.0, now(s.corner) - level);
      const double part = gently ? std::min(1.0, (at_corner(corner, now) - level) / above) : 1.0;
      for (const auto& s : corners_.shares_of(corner)) {
        const double value = now(s.corner);
        if (value > level) cuts.push_back({s.corner, value - part * (value - level), source});
      }
    }
  }

  /// Takes out of all differences what still exceeds the slope.
  void shrink() {
    const double steepest = parallel_max(tree_.size(), 1.0, [&](std::size_t l) {
      const auto leaf = static_cast<std::uint32_t>(l);
      const double bound = bound_of(leaf);
      return steepest_in(leaf) / (bound * bound);
    });
    if (steepest == 1) return;
    const double least = -parallel_max(value_.size(), -HUGE_VAL, [&](std::size_t c) { return -value_[c]; });
    const double by = 1 / std::sqrt(steepest);
    parallel_for(value_.size(), [&](std::size_t c) { value_[c] = least + (value_[c] - least) * by; });
  }

  const Octree& tree_;
  const OctreeCorners& corners_;
  double slope_;
  RawVector<double> value_;        ///< per corner; where free
  RawVector<double> source_;       ///< likewise: what the source asked for that limits it
  RawVector<std::uint8_t> plain_;  ///< per leaf
  Groups<> in_turn_;               ///< the leaves of each colour of each group
  RawVector<std::uint32_t> rank_;  ///< per leaf: where it is among these
  RawVector<std::uint8_t> dirty_;  ///< in that order
  Groups<> dependents_;            ///< per free corner: the hanging corners that it is part of
};

}  // namespace

GradedCorners graded_corners(const Octree& tree, const OctreeCorners& corners, GradedCorners caps, double gradation,
                             double ceiling, const RunContext& context) {
  return Grader(tree, corners, std::move(caps), gradation, ceiling).run(context);
}

std::shared_ptr<OctreeField> graded_field(const RootCube& root, Octree tree, const OctreeCorners& corners,
                                          std::span<const double> caps, double gradation, double ceiling,
                                          const RunContext& context) {
  auto field = std::make_shared<OctreeField>();
  field->root = root;
  field->gradation = gradation;
  field->h = corners.at_leaves(
      graded_corners(tree, corners, {parallel_copy(caps), parallel_copy(caps)}, gradation, ceiling, context).value);
  field->tree = std::move(tree);
  field->find_range();
  return field;
}

}  // namespace octafront
