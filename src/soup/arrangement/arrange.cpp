#include "soup/arrangement/arrange.h"

#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"
#include "base/core/renumber.h"
#include "base/core/wording.h"
#include "base/geometry/predicates.h"
#include "base/geometry/same_place.h"
#include "base/geometry/self_intersection.h"
#include "soup/arrangement/arranging.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <unordered_map>

#include <fmt/core.h>

namespace octafront {
namespace {

using arrangement::Divided;
using arrangement::PointTable;
using arrangement::Soup;

/// How many times rounding may make new crossings, and from which pass on what nearly meets is brought together, each
/// time from farther away: nearly all input ends in two or three passes.
constexpr int kMostPasses = 24, kFirstSnap = 1;
/// What is brought together may come near to others: so often in a pass.
constexpr int kMostSnaps = 4;
/// The first reach, of the diagonal, and what it grows by: up to 1e-6 in the last pass.
constexpr double kReach = 1e-13, kGrowth = 2;
/// What does not settle must not grow without end either.
constexpr std::size_t kMostGrowth = 8, kFewPairs = 100;

/// Merges equal points, drops triangles without area; returns how many these were.
std::uint64_t tidy(Soup& soup) {
  const std::vector<std::uint32_t> first = first_at_place(soup.points);
  std::uint64_t flat = 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    Triangle t = soup.triangles[i];
    for (VertexIndex& v : t) v = first[v];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0] ||
        collinear(soup.points[t[0]], soup.points[t[1]], soup.points[t[2]])) {
      ++flat;
      continue;
    }
    soup.triangles[kept] = t;
    if (kept != i) soup.origins[kept] = std::move(soup.origins[i]);
    ++kept;
  }
  soup.triangles.resize(kept);
  soup.origins.resize(kept);
  return flat;
}

/// In order, and each way as often as it is left when opposite ones cancel; of one that cancels altogether both stay,
/// for what lies there shall be known.
void settle(std::vector<Origin>& origins) {
  std::sort(origins.begin(), origins.end(), [](const Origin& a, const Origin& b) {
    return std::pair(a.triangle, a.reversed) < std::pair(b.triangle, b.reversed);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0, end = 0; i < origins.size(); i = end) {
    const std::uint32_t triangle = origins[i].triangle;
    std::size_t ways[2] = {0, 0};
    for (end = i; end < origins.size() && origins[end].triangle == triangle; ++end) ++ways[origins[end].reversed];
    const std::size_t both = std::min(ways[0], ways[1]), left = ways[0] == ways[1] ? 1 : 0;
    for (const bool reversed : {false, true})
      for (std::size_t k = both - left; k < ways[reversed]; ++k) origins[kept++] = {triangle, reversed};
  }
  origins.resize(kept);
}

/// Of triangles on the same corners one stays, with the origins of all.
void merge_equal(Soup& soup) {
  const auto corners = [&](std::uint32_t t) {
    Triangle sorted = soup.triangles[t];
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  const auto is_even = [&](std::uint32_t t) {
    const auto [a, b, c] = soup.triangles[t];
    return (a < b) == (b < c) ? a < b : c < a;
  };
  std::vector<std::pair<Triangle, std::uint32_t>> order;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) order.emplace_back(corners(t), t);
  std::sort(order.begin(), order.end());
  std::vector<char> gone(order.size(), 0);
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (order[i].first != order[first].first) first = i;
    if (i == first) continue;
    const std::uint32_t kept = order[first].second, t = order[i].second;
    const bool turned = is_even(kept) != is_even(t);
    for (const Origin& o : soup.origins[t]) soup.origins[kept].push_back({o.triangle, o.reversed != turned});
    gone[t] = 1;
  }
  std::size_t left = 0;
  for (std::uint32_t t = 0; t < gone.size(); ++t) {
    if (gone[t]) continue;
    soup.triangles[left] = soup.triangles[t];
    if (left != t) soup.origins[left] = std::move(soup.origins[t]);
    settle(soup.origins[left++]);
  }
  soup.triangles.resize(left);
  soup.origins.resize(left);
}

/// Origins of a pass in terms of the input; several ways to one face add up to its own, or to none in all.
std::vector<Origin> composed(const std::vector<Origin>& of_pass, const Soup& before) {
  std::vector<Origin> all;
  for (const Origin& o : of_pass)
    for (const Origin& p : before.origins[o.triangle]) all.push_back({p.triangle, p.reversed != o.reversed});
  settle(all);
  return all;
}

class Arranger {
 public:
  Arranger(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles, const RunContext& context)
      : context_(context), inputs_(points.size()) {
    soup_.points = points;
    soup_.triangles = triangles;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) soup_.origins.push_back({{t, false}});
    Box3 box;
    for (const Vec3 p : points) box.add(p);
    diagonal_ = box.diagonal();
  }

  Arrangement result() {
    result_.degenerate = tidy(soup_);
    for (;; ++result_.passes) {
      auto pairs = self_intersections(soup_.points, soup_.triangles, kAll, context_);
      for (int k = 0; k < kMostSnaps && result_.passes >= kFirstSnap && !pairs.empty(); ++k) {
        bring_together(pairs);
        pairs = self_intersections(soup_.points, soup_.triangles, kAll, context_);
      }
      if (result_.passes == 0) result_.crossing_pairs = pairs.size();
      if (pairs.empty()) return finished();
      least_pairs_ = std::min(least_pairs_, pairs.size());
      const bool grows = first_pass_ > 0 && (soup_.triangles.size() > kMostGrowth * first_pass_ ||
                                             pairs.size() > kMostGrowth * (least_pairs_ + kFewPairs));
      if (result_.passes == kMostPasses || grows) give_up(pairs);
      pass(pairs);
      if (result_.passes == 0) first_pass_ = soup_.triangles.size();
    }
  }

 private:
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  void pass(const std::vector<std::array<std::uint32_t, 2>>& pairs) {
    PointTable table(soup_.points);
    Divided divided = arrangement::divide(table, soup_.triangles, pairs, context_);
    Soup next;
    next.points = soup_.points;
    std::unordered_map<std::uint32_t, VertexIndex> number;
    for (Triangle& t : divided.triangles)
      for (VertexIndex& v : t) {
        if (v < table.inputs()) continue;
        const auto [at, is_new] = number.try_emplace(v, static_cast<VertexIndex>(next.points.size()));
        if (is_new) next.points.push_back(table.place(v).at);
        v = at->second;
      }
    next.triangles = std::move(divided.triangles);
    for (const std::vector<Origin>& of_pass : divided.origins) next.origins.push_back(composed(of_pass, soup_));
    soup_ = std::move(next);
    tidy(soup_);
  }

  void bring_together(const std::vector<std::array<std::uint32_t, 2>>& pairs) {
    const double reach = kReach * elementary::pow(kGrowth, result_.passes - kFirstSnap) * diagonal_;
    result_.largest_move = std::max(result_.largest_move, arrangement::snap(soup_, pairs, reach));
    tidy(soup_);
    merge_equal(soup_);
  }

  Arrangement finished() {
    std::vector<std::uint32_t> order(soup_.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    const auto first_origin = [&](std::uint32_t t) { return soup_.origins[t].front().triangle; };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return first_origin(a) < first_origin(b); });
    // Points of earlier passes that nothing uses any more; the input's stay.
    drop_unused_points(soup_.points, soup_.triangles, inputs_);
    for (const std::uint32_t t : order) {
      Triangle triangle = soup_.triangles[t];
      const bool turn = soup_.origins[t].front().reversed;
      if (turn) std::swap(triangle[1], triangle[2]);
      result_.triangles.push_back(triangle);
      result_.first_origin.push_back(static_cast<std::uint32_t>(result_.origins.size()));
      for (const Origin& o : soup_.origins[t]) result_.origins.push_back({o.triangle, o.reversed != turn});
    }
    result_.first_origin.push_back(static_cast<std::uint32_t>(result_.origins.size()));
    result_.points = std::move(soup_.points);
    result_.new_points = result_.points.size() - inputs_;
    return std::move(result_);
  }

  [[noreturn]] void give_up(const std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    std::string places;
    for (std::size_t i = 0; i < std::min<std::size_t>(pairs.size(), 3); ++i) {
      const Vec3 p = soup_.points[soup_.triangles[pairs[i][0]][0]];
      places +=
          fmt::format("\n  faces {} and {} near ({:.9g}, {:.9g}, {:.9g})", soup_.origins[pairs[i][0]].front().triangle,
                      soup_.origins[pairs[i][1]].front().triangle, p.x, p.y, p.z);
    }
    throw InputError(
        fmt::format("{} of faces cross again and again when their crossings are rounded to doubles; give "
                    "detail that fine away before:{}",
                    counted(pairs.size(), "pair"), places));
  }

  const RunContext& context_;
  std::size_t inputs_;
  double diagonal_ = 0;
  std::size_t first_pass_ = 0;      ///< triangles behind it
  std::size_t least_pairs_ = kAll;  ///< so far
  Soup soup_;
  Arrangement result_;
};

}  // namespace

Arrangement arrange(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                    const RunContext& context) {
  return Arranger(points, triangles, context).result();
}

}  // namespace octafront
