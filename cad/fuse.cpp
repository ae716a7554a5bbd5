#include "cells.h"
#include "measure.h"
#include "pipe.h"
#include "read.h"
#include "steps.h"
#include "topology.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Solids that share less than this part of the smaller one touch, as inexactly as they were made: what they share is
/// thinner than what any mesh shows.
constexpr double kTouching = 1e-4;
/// So do fits: what they share is a layer thinner than this part of what the smaller one is thick.
constexpr double kFit = 0.01;
/// Pairs that a message lists.
constexpr std::size_t kMostPairs = 10;

using Cluster = std::vector<std::size_t>;

/// Solids whose boxes touch, directly or through others.
std::vector<Cluster> clusters_of(const Part& part) {
  const std::size_t n = part.solids.size();
  std::vector<Box3> boxes;
  Box3 all;
  for (const Body& body : part.solids) boxes.push_back(quick_box(body.solid)), all.add(boxes.back());
  const double reach = 1e-7 * all.diagonal();
  std::vector<std::size_t> root(n);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 1; k < n; ++k) {
      const double near = reach + tolerance_of(part.solids[i].solid) + tolerance_of(part.solids[k].solid);
      const Box3 wide{boxes[i].lo - Vec3{near, near, near}, boxes[i].hi + Vec3{near, near, near}};
      if (wide.overlaps(boxes[k])) root[std::max(find(i), find(k))] = std::min(find(i), find(k));
    }
  std::vector<Cluster> by_root(n), out;
  for (std::size_t i = 0; i < n; ++i) by_root[find(i)].push_back(i);
  for (Cluster& cluster : by_root)
    if (cluster.size() > 1) out.push_back(std::move(cluster));
  return out;
}

std::string name_of(const Part& part, std::size_t solid) {
  const std::string& name = part.solids[solid].labels.name;
  return name.empty() ? fmt::format("solid {}", solid + 1) : name;
}

/// Solids that have space in common, by their numbers in the part.
struct Pair {
  std::size_t a, b;
  double volume = 0, depth = 0, part_of_smaller = 0;
};

/// Of a layer, or of a solid as a whole.
double thickness_of(double volume, double area) {
  return area > 0 ? 2 * volume / area : 0;
}

std::string in_words(const Part& part, const std::vector<Pair>& pairs) {
  std::string words;
  for (std::size_t i = 0; i < std::min(kMostPairs, pairs.size()); ++i)
    words += fmt::format("{}{} and {} overlap in {:.3g} mm^3", i == 0 ? "" : ", ", in_words(part, pairs[i].a),
                         in_words(part, pairs[i].b), pairs[i].volume / std::pow(part.per_millimetre, 3));
  if (pairs.size() > kMostPairs) words += fmt::format(" and {} more pairs", pairs.size() - kMostPairs);
  return words;
}

/// The cells of a cluster, and who gets them.
class Shares {
 public:
  Shares(Part& part, const Cluster& cluster, const Cells& cells, const Arguments& asked)
      : part_(part),
        cluster_(cluster),
        cells_(cells),
        overlap_(asked.overlap),
        tolerance_(asked.tolerance * part.per_millimetre) {
    find_pairs();
  }

  /// Enters the solids; those that are new go to `added`. A solid of which nothing is left is null.
  void give(std::vector<Body>& added) {
    if (!real_.empty() && overlap_ == Overlap::kRefuse)
      throw Refusal(in_words(part_, real_) +
                    ". `overlap` first or later gives what they share to one of them, new makes regions of it");
    if (!real_.empty() && overlap_ == Overlap::kTell) return leave();
    refuse_crumbs();
    std::map<std::vector<std::size_t>, std::vector<const Cell*>> shares;
    for (const Cell& cell : cells_.cells) shares[takers_of(cell)].push_back(&cell);
    for (std::size_t i = 0; i < cluster_.size(); ++i)
      if (!shares.contains({i})) vanish(i);
    for (const auto& [takers, cells] : shares) {
      if (takers.size() == 1)
        part_.solids[cluster_[takers[0]]].solid = united(cells);
      else
        added.push_back({united(cells), {name_of_all(takers), {}, {}}});
    }
    for (const auto& [before, after] : cells_.faces) pass_labels(before, after, part_.face_labels);
    tell();
    enter(tiny_);
    enter(real_);
  }

 private:
  void find_pairs() {
    struct Shared {
      double volume = 0, area = 0;
    };
    std::map<std::pair<std::size_t, std::size_t>, Shared> shared;
    for (const Cell& cell : cells_.cells) {
      const double area = cell.owners.size() > 1 ? area_of(cell.solid) : 0;
      for (std::size_t i = 0; i < cell.owners.size(); ++i)
        for (std::size_t k = i + 1; k < cell.owners.size(); ++k) {
          Shared& of_pair = shared[{cell.owners[i], cell.owners[k]}];
          of_pair.volume += cell.volume, of_pair.area += area;
        }
    }
    for (const auto& [pair, what] : shared) {
      const std::size_t a = cluster_[pair.first], b = cluster_[pair.second];
      const auto [smaller, volume] = smaller_of(a, b);
      const double depth = thickness_of(what.volume, what.area);
      const Pair found{a, b, what.volume, depth, what.volume / volume};
      (touches(found, thickness_of(volume, area_of(part_.solids[smaller].solid))) ? tiny_ : real_).push_back(found);
    }
    for (std::vector<Pair>* pairs : {&real_, &tiny_})
      std::stable_sort(pairs->begin(), pairs->end(), [](const Pair& x, const Pair& y) { return x.volume > y.volume; });
  }

  /// And its volume.
  std::pair<std::size_t, double> smaller_of(std::size_t a, std::size_t b) const {
    const double of_a = volume_of(part_.solids[a].solid), of_b = volume_of(part_.solids[b].solid);
    return of_a <= of_b ? std::pair(a, of_a) : std::pair(b, of_b);
  }

  /// Who says who gets what solids share means fits, too.
  bool touches(const Pair& pair, double thickness) const {
    const bool is_asked = overlap_ != Overlap::kRefuse && overlap_ != Overlap::kTell;
    return pair.part_of_smaller <= kTouching || (!is_asked && pair.depth <= std::max(tolerance_, kFit * thickness));
  }

  bool is_real(const Cell& cell) const {
    const auto owns = [&](std::size_t solid) {
      return std::any_of(cell.owners.begin(), cell.owners.end(), [&](std::size_t i) { return cluster_[i] == solid; });
    };
    return std::any_of(real_.begin(), real_.end(), [&](const Pair& p) { return owns(p.a) && owns(p.b); });
  }

  /// One of its owners, or several for a region of their own.
  std::vector<std::size_t> takers_of(const Cell& cell) const {
    if (cell.owners.size() == 1 || (overlap_ == Overlap::kNew && is_real(cell))) return cell.owners;
    return {overlap_ == Overlap::kFirst ? cell.owners.front() : cell.owners.back()};
  }

  /// Between faces that are tangent along a line there is no room for elements, however small: without the line itself
  /// their triangles cross.
  void refuse_crumbs() const {
    const std::vector<Crumbs> all = crumbs_of(cells_);
    if (all.empty() || overlap_ == Overlap::kTell) return;
    std::string pairs;
    for (std::size_t i = 0; i < std::min(kMostPairs, all.size()); ++i)
      pairs += fmt::format("{}{} and {}", i == 0 ? "" : ", ", in_words(part_, solid_of(all[i].a)),
                           in_words(part_, solid_of(all[i].b)));
    if (all.size() > kMostPairs) pairs += fmt::format(" and {} more pairs", all.size() - kMostPairs);
    throw Refusal(fmt::format(
        "{} touch along lines where their faces are tangent, as a ball and its groove do, of which "
        "OpenCASCADE finds crumbs only, the first near ({:.6g}, {:.6g}, {:.6g}): what lies between is thinner "
        "than any element. Leave a gap there, or leave some of them out",
        pairs, all[0].at.x, all[0].at.y, all[0].at.z));
  }

  std::size_t solid_of(std::size_t cell) const { return cluster_[cells_.cells[cell].owners[0]]; }

  void leave() {
    part_.notes.push_back(in_words(part_, real_));
    part_.fused = false;
    enter(real_);
  }

  void enter(const std::vector<Pair>& pairs) {
    for (const Pair& p : pairs)
      part_.shared.push_back(
          {{static_cast<std::uint32_t>(std::min(p.a, p.b)), static_cast<std::uint32_t>(std::max(p.a, p.b))},
           p.volume,
           p.depth});
  }

  void vanish(std::size_t i) {
    const std::size_t solid = cluster_[i];
    if (overlap_ != Overlap::kNew)
      throw Refusal(fmt::format("nothing is left of {}: {} ones lie over all of it; take another `overlap`",
                                cad::in_words(part_, solid), overlap_ == Overlap::kFirst ? "earlier" : "later"));
    part_.solids[solid].solid.Nullify();
  }

  std::string name_of_all(const std::vector<std::size_t>& owners) const {
    std::string names;
    for (const std::size_t i : owners) {
      if (!names.empty()) names += '&';
      names += name_of(part_, cluster_[i]);
    }
    return names;
  }

  void tell() {
    if (!real_.empty())
      part_.notes.push_back(in_words(part_, real_) + (overlap_ == Overlap::kFirst   ? ": the first one has it"
                                                      : overlap_ == Overlap::kLater ? ": the later one has it"
                                                                                    : ": regions of their own"));
    if (!tiny_.empty())
      part_.notes.push_back(fmt::format(
          "{}: so little, {:.2g} of the smaller solid and {:.2g} mm deep at most, is how they touch, and "
          "the {} one has it",
          in_words(part_, tiny_), worst_of_tiny(&Pair::part_of_smaller),
          worst_of_tiny(&Pair::depth) / part_.per_millimetre, overlap_ == Overlap::kFirst ? "first" : "later"));
  }

  double worst_of_tiny(double Pair::*what) const {
    double worst = 0;
    for (const Pair& pair : tiny_) worst = std::max(worst, pair.*what);
    return worst;
  }

  Part& part_;
  const Cluster& cluster_;
  const Cells& cells_;
  const Overlap overlap_;
  const double tolerance_;
  std::vector<Pair> real_, tiny_;
};

/// Solids without a name are called by their numbers, which must not change when some go.
void take_all(Part& part, std::vector<Body> added) {
  const auto is_gone = [](const Body& body) { return body.solid.IsNull(); };
  if (std::any_of(part.solids.begin(), part.solids.end(), is_gone))
    for (std::size_t i = 0; i < part.solids.size(); ++i) part.solids[i].labels.name = name_of(part, i);
  std::vector<std::uint32_t> now(part.solids.size(), kNone);
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (!is_gone(part.solids[i])) now[i] = kept++;
  for (SharedSpace& space : part.shared)
    for (std::uint32_t& solid : space.solids) solid = now[solid];
  std::erase_if(part.shared, [](const SharedSpace& space) { return std::ranges::count(space.solids, kNone) > 0; });
  std::erase_if(part.solids, is_gone);
  for (Body& body : added) part.solids.push_back(std::move(body));
  number_names(part);
}

}  // namespace

void fuse(Part& part, const Arguments& asked) {
  std::vector<Body> added;
  for (const Cluster& cluster : clusters_of(part)) {
    const std::string what = fmt::format("{} solids from {} on", cluster.size(), in_words(part, cluster[0]));
    send_progress("fusing", what);
    std::vector<TopoDS_Shape> solids;
    for (const std::size_t i : cluster) solids.push_back(part.solids[i].solid);
    std::optional<Cells> cells = cells_of(solids, false);
    if (!cells) {
      send_progress("fusing", what + ", as solids that only touch");
      cells = cells_of(solids, true);
    }
    if (cells) {
      Shares(part, cluster, *cells, asked).give(added);
    } else {
      part.fused = false;
      part.notes.push_back(
          fmt::format("{} could not be given common faces without a change of volume, and stay separate", what));
    }
  }
  take_all(part, std::move(added));
}

}  // namespace octafront::cad
