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
// small to large sizes, and where (*) fails the highest of the four values are cut off at the level at which it holds;
// a few rounds suffice, since every cut is made by smaller values, which are settled before. What is left (below
// kTolerance) is removed by shrinking all differences by one factor. (Stopping corners exactly, in the order of their
// values, while a level rises needs no last step, but each corner has to be asked several times: twenty times slower.)

#include "sizing/field/gradation.h"

#include "base/core/groups.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace octafront {

namespace {

/// Keeps (*) true in spite of rounding.
constexpr double kSafety = 1 - 1e-9;
/// Slopes that exceed the gradation by less are left to the last step, which takes as much off all differences of size.
constexpr double kTolerance = 1e-3;
/// Rounds end when nothing exceeds it; this bound is never met in practice, and what exceeds it then is shrunk away
/// too.
constexpr int kMostRounds = 60;
/// Hanging corners of one leaf that share a free corner can move each other in circles; after these rounds all that
/// lies behind a hanging corner is cut at the level.
constexpr int kGentleRounds = 6;

class Grader {
 public:
  Grader(const Octree& tree, const OctreeCorners& corners, const GradedCorners& caps, double gradation, double ceiling)
      : tree_(tree), corners_(corners), slope_(gradation * kSafety), value_(caps.value), source_(caps.source) {
    for (std::size_t c = 0; c < value_.size(); ++c)
      if (!(value_[c] < ceiling)) value_[c] = source_[c] = ceiling;
  }

  GradedCorners run(const RunContext& context) {
    sweep_shortest_paths(context);
    order_leaves();
    collect_dependents();
    dirty_.assign(tree_.size(), 1);
    for (int round = 1; round <= kMostRounds; ++round) {
      context.check();
      if (!cut_steep_leaves(round)) break;
    }
    shrink();
    GradedCorners result{std::vector<double>(value_.size()), std::vector<double>(value_.size())};
    parallel_for(value_.size(), [&](std::size_t i) {
      const auto c = static_cast<std::uint32_t>(i);
      result.value[c] = at(value_, c);
      result.source[c] = std::min(at(source_, c), result.value[c]);
    });
    return result;
  }

 private:
  double at(const std::vector<double>& of_free, std::uint32_t corner) const {
    if (!corners_.hangs(corner)) return of_free[corner];
    double sum = 0;
    for (const OctreeCorners::Share& s : corners_.shares_of(corner)) sum += s.weight * of_free[s.corner];
    return sum;
  }
  double at(std::uint32_t corner) const { return at(value_, corner); }

  // --- shortest paths: Dijkstra with sources everywhere; hanging corners take part like others here

  struct Label {
    double value;
    std::uint32_t corner;
    bool operator<(const Label& b) const { return value != b.value ? value > b.value : corner > b.corner; }
  };

  void collect_leaves() {
    leaves_ = group_by_owner(corners_.size(), static_cast<std::uint32_t>(8 * tree_.size()),
                             [&](std::uint32_t i) { return corners_.of_leaf[i / 8][i % 8]; });
  }

  /// Calls visit(corner, value) for each corner that an edge of a leaf joins to `from` and that its value limits.
  template <class Visit>
  void for_each_limited(std::uint32_t from, Visit&& visit) const {
    for (const std::uint32_t i : leaves_[from]) {
      const std::uint32_t leaf = i / 8, k = i % 8;
      const double rise = slope_ / (1u << tree_.leaf(leaf).level());
      for (std::uint32_t d = 1; d < 8; d *= 2) {
        const std::uint32_t to = corners_.of_leaf[leaf][k ^ d];
        const double v = value_[from] + rise;
        if (v < value_[to]) visit(to, v);
      }
    }
  }

  void sweep_shortest_paths(const RunContext& context) {
    collect_leaves();
    constexpr std::size_t kRange = 4096;
    auto start = parallel_collect<Label>(value_.size(), kRange,
                                         [&](std::size_t begin, std::size_t end, std::vector<Label>& out) {
                                           for (auto c = static_cast<std::uint32_t>(begin); c < end; ++c) {
                                             bool limits = false;
                                             for_each_limited(c, [&](std::uint32_t, double) { limits = true; });
                                             if (limits) out.push_back({value_[c], c});
                                           }
                                         });
    std::priority_queue<Label> heap(std::less<Label>(), std::move(start));
    for (std::size_t steps = 0; !heap.empty(); ++steps) {
      if (steps % 4096 == 0) context.check();
      const Label label = heap.top();
      heap.pop();
      if (label.value > value_[label.corner]) continue;
      for_each_limited(label.corner, [&](std::uint32_t to, double v) {
        value_[to] = v;
        source_[to] = source_[label.corner];
        heap.push({v, to});
      });
    }
  }

  // --- cuts

  /// Leaves in the order of their smallest corner.
  void order_leaves() {
    std::vector<std::pair<double, std::uint32_t>> order(tree_.size());
    plain_.resize(tree_.size());
    parallel_for(tree_.size(), [&](std::size_t l) {
      const auto& corners = corners_.of_leaf[l];
      double least = value_[corners[0]];
      for (const std::uint32_t c : corners) least = std::min(least, value_[c]);
      order[l] = {least, static_cast<std::uint32_t>(l)};
      plain_[l] = std::none_of(corners.begin(), corners.end(), [&](std::uint32_t c) { return corners_.hangs(c); });
    });
    parallel_sort(order);
    order_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) order_[i] = order[i].second;
  }

  double bound_of(std::uint32_t leaf) const { return slope_ / (1u << tree_.leaf(leaf).level()); }

  void collect_dependents() {
    dependents_ = {corners_.size(), [&](const auto& add) {
                     for (std::uint32_t c = 0; c < corners_.size(); ++c)
                       for (const OctreeCorners::Share& s : corners_.shares_of(c)) add(s.corner, c);
                   }};
  }

  /// Lowers a free corner; the leaves that see it have to be looked at (again).
  void lower(std::uint32_t corner, double value, double source) {
    value_[corner] = value;
    source_[corner] = source;
    const auto mark = [&](std::uint32_t c) {
      for (const std::uint32_t i : leaves_[c]) dirty_[i / 8] = 1;
    };
    mark(corner);
    for (const std::uint32_t c : dependents_[corner]) mark(c);
  }

  static double squared_slope(const std::array<double, 8>& h, int c) {
    const double x = h[c ^ 1] - h[c], y = h[c ^ 2] - h[c], z = h[c ^ 4] - h[c];
    return x * x + y * y + z * z;
  }

  std::array<double, 8> values_of(std::uint32_t leaf) const {
    std::array<double, 8> h;
    const auto& corner = corners_.of_leaf[leaf];
    for (int k = 0; k < 8; ++k) h[k] = plain_[leaf] ? value_[corner[k]] : at(corner[k]);
    return h;
  }

  double tolerated(std::uint32_t leaf) const {
    const double bound = bound_of(leaf);
    return bound * bound * (1 + kTolerance) * (1 + kTolerance);
  }

  bool is_steep(std::uint32_t leaf) const {
    const std::array<double, 8> h = values_of(leaf);
    for (int c = 0; c < 8; ++c)
      if (squared_slope(h, c) > tolerated(leaf)) return true;
    return false;
  }

  /// Leaves that are not steep as the round begins need a look only if a cut touches them, which marks them.
  void forget_gentle_leaves() {
    parallel_for(tree_.size(), [this](std::size_t l) {
      if (dirty_[l] && !is_steep(static_cast<std::uint32_t>(l))) dirty_[l] = 0;
    });
  }

  /// True if anything was cut.
  bool cut_steep_leaves(int round) {
    forget_gentle_leaves();
    bool any = false;
    for (const std::uint32_t leaf : order_) {
      if (!dirty_[leaf]) continue;
      dirty_[leaf] = 0;
      std::array<double, 8> h = values_of(leaf);
      for (int c = 0; c < 8; ++c) {
        if (squared_slope(h, c) <= tolerated(leaf)) continue;
        any = true;
        cut(leaf, c, level_of_cut(h, c, bound_of(leaf)), round, h);
        h = values_of(leaf);
      }
    }
    return any;
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

  void cut(std::uint32_t leaf, int c, double level, int round, const std::array<double, 8>& h) {
    int lowest = c;
    for (const int k : {c ^ 1, c ^ 2, c ^ 4})
      if (h[k] < h[lowest]) lowest = k;
    const double source = at(source_, corners_.of_leaf[leaf][lowest]);
    for (const int k : {c, c ^ 1, c ^ 2, c ^ 4}) {
      if (h[k] <= level) continue;
      const std::uint32_t corner = corners_.of_leaf[leaf][k];
      if (!corners_.hangs(corner)) {
        lower(corner, level, source);
        continue;
      }
      // The shares above the level give way in proportion to what they are above it.
      double above = 0;
      for (const auto& s : corners_.shares_of(corner)) above += s.weight * std::max(0.0, value_[s.corner] - level);
      const double part = round > kGentleRounds ? 1.0 : std::min(1.0, (at(corner) - level) / above);
      for (const auto& s : corners_.shares_of(corner)) {
        if (value_[s.corner] <= level) continue;
        lower(s.corner, value_[s.corner] - part * (value_[s.corner] - level), source);
      }
    }
  }

  /// Takes out of all differences what still exceeds the slope.
  void shrink() {
    std::vector<double> steepness(tree_.size());
    parallel_for(tree_.size(), [&](std::size_t l) {
      const auto leaf = static_cast<std::uint32_t>(l);
      const std::array<double, 8> h = values_of(leaf);
      const double bound = bound_of(leaf);
      for (int c = 0; c < 8; ++c) steepness[l] = std::max(steepness[l], squared_slope(h, c) / (bound * bound));
    });
    const double steepest = std::max(1.0, *std::max_element(steepness.begin(), steepness.end()));
    if (steepest == 1) return;
    const double least = *std::min_element(value_.begin(), value_.end()), by = 1 / std::sqrt(steepest);
    for (double& v : value_) v = least + (v - least) * by;
  }

  const Octree& tree_;
  const OctreeCorners& corners_;
  double slope_;
  std::vector<double> value_;                ///< per corner; where free
  std::vector<double> source_;               ///< likewise: what the source asked for that limits it
  std::vector<std::uint8_t> plain_, dirty_;  ///< per leaf
  std::vector<std::uint32_t> order_;
  Groups<> leaves_;      ///< per corner, as 8 * leaf + which of its corners
  Groups<> dependents_;  ///< per free corner: the hanging corners that it is part of
};

}  // namespace

GradedCorners graded_corners(const Octree& tree, const OctreeCorners& corners, const GradedCorners& caps,
                             double gradation, double ceiling, const RunContext& context) {
  return Grader(tree, corners, caps, gradation, ceiling).run(context);
}

std::shared_ptr<OctreeField> graded_field(const RootCube& root, Octree tree, const OctreeCorners& corners,
                                          const std::vector<double>& caps, double gradation, double ceiling,
                                          const RunContext& context) {
  auto field = std::make_shared<OctreeField>();
  field->root = root;
  field->gradation = gradation;
  field->h = corners.at_leaves(graded_corners(tree, corners, {caps, caps}, gradation, ceiling, context).value);
  field->tree = std::move(tree);
  field->find_range();
  return field;
}

}  // namespace octafront
