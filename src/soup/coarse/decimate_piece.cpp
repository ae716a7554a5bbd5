#include "soup/coarse/decimate_piece.h"

#include "base/geometry/live_triangles.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

namespace octafront {

namespace {

/// Passes, by parts of the bound on the deviation: first what costs least.
constexpr double kBounds[] = {0.25, 0.5, 1};
/// A pass is repeated while it removes more than this part of what it looks at.
constexpr double kWorthAnother = 0.05;
/// Least cosine between a triangle before and after one collapse.
constexpr double kLeastTurn = 0.5;
/// Triangles may get this shape (1: regular), or stay as poor as they are.
constexpr double kShape = 0.3;
/// How many edges of a vertex are tried.
constexpr int kMostTries = 3;
/// A sheet of so few triangles, as regions of a voxel have, keeps them: any less would be flat.
constexpr std::uint32_t kFewOfSheet = 20;

/// 1 for a regular triangle, 0 for one without area.
double shape_of(const TriangleCorners& t, double double_area) {
  constexpr double kRegular = 3.4641016151377544;  // of double area over the sum of squared edges
  return kRegular * double_area /
         (squared_distance(t[0], t[1]) + squared_distance(t[1], t[2]) + squared_distance(t[2], t[0]));
}

struct Neighbour {
  VertexIndex v;
  std::uint32_t sheet;
  int triangles;
  bool between_sheets;
  bool by_line() const { return triangles != 2 || between_sheets; }
};

/// The triangles at a vertex, as corners (three times a triangle and which of its corners), and what they lead to.
struct Star {
  std::vector<std::uint32_t> corners;
  std::vector<Neighbour> neighbours;

  const Neighbour* find(VertexIndex v) const {
    const auto n = std::ranges::find(neighbours, v, &Neighbour::v);
    return n == neighbours.end() ? nullptr : &*n;
  }
  void add(VertexIndex v, std::uint32_t sheet) {
    const auto n = std::ranges::find(neighbours, v, &Neighbour::v);
    if (n == neighbours.end()) {
      neighbours.push_back({v, sheet, 1, false});
    } else {
      ++n->triangles;
      n->between_sheets = n->between_sheets || n->sheet != sheet;
    }
  }
};

class Decimator {
 public:
  Decimator(Piece& piece, const DecimationLimits& limits, Crossings crossings, const RunContext& context)
      : piece_(piece),
        limits_(limits),
        context_(context),
        first_(piece.points.size(), kNone),
        next_(3 * piece.triangles.size()),
        is_fresh_(piece.points.size()) {
    count_by_sheet();
    if (crossings == Crossings::kTested) live_.emplace(piece);
    for (std::uint32_t c = 0; c < next_.size(); ++c) {
      VertexIndex& first = first_[piece_.triangles[c / 3][c % 3]];
      next_[c] = first;
      first = c;
    }
  }

  void run() {
    std::vector<VertexIndex> left;
    for (VertexIndex v = 0; v < piece_.points.size(); ++v)
      if (piece_.is_wanted[v] && !piece_.is_at_rim[v] && piece_.role[v] != VertexRole::kFixed) left.push_back(v);
    for (const double bound : kBounds) {
      bound_ = bound * limits_.deviation * bound * limits_.deviation;
      std::ranges::fill(is_fresh_, 1);
      while (pass(left) > kWorthAnother * static_cast<double>(left.size())) context_.check();
    }
  }

 private:
  struct Way {
    double cost;
    VertexIndex to;
    Vec3 at;
  };

  /// What lies outside of the piece does not count, so that none is left with fewer.
  void count_by_sheet() {
    std::vector<std::uint32_t> names = piece_.sheet;
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    of_sheet_.assign(names.size(), 0);
    for (std::uint32_t& s : piece_.sheet) {
      s = static_cast<std::uint32_t>(std::ranges::lower_bound(names, s) - names.begin());
      ++of_sheet_[s];
    }
  }

  double pass(std::vector<VertexIndex>& left) {
    double removed = 0;
    for (const VertexIndex v : left)
      if (std::exchange(is_fresh_[v], 0) != 0 && remove(v)) ++removed;
    std::erase_if(left, [&](VertexIndex v) { return first_[v] == kNone; });
    return removed;
  }

  void gather(VertexIndex v, Star& star) {
    star.corners.clear(), star.neighbours.clear();
    std::uint32_t* link = &first_[v];
    while (*link != kNone) {
      const std::uint32_t c = *link, t = c / 3;
      if (piece_.is_removed(t)) {
        *link = next_[c];
        continue;
      }
      star.corners.push_back(c);
      star.add(corner(c, 1), piece_.sheet[t]), star.add(corner(c, 2), piece_.sheet[t]);
      link = &next_[c];
    }
  }

  /// The corner `steps` behind c in its triangle.
  VertexIndex corner(std::uint32_t c, std::uint32_t steps) const {
    return piece_.triangles[c / 3][(c % 3 + steps) % 3];
  }

  bool remove(VertexIndex v) {
    gather(v, star_);
    if (std::ranges::any_of(star_.corners,
                            [&](std::uint32_t c) { return of_sheet_[piece_.sheet[c / 3]] <= kFewOfSheet; }))
      return false;
    find_ways(v);
    for (std::size_t i = 0; i < std::min<std::size_t>(kMostTries, ways_.size()); ++i) {
      std::partial_sort(ways_.begin() + static_cast<std::ptrdiff_t>(i),
                        ways_.begin() + static_cast<std::ptrdiff_t>(i) + 1, ways_.end(),
                        [](const Way& a, const Way& b) { return std::tie(a.cost, a.to) < std::tie(b.cost, b.to); });
      if (!may_collapse(v, ways_[i])) continue;
      collapse(v, ways_[i]);
      return true;
    }
    return false;
  }

  void find_ways(VertexIndex v) {
    ways_.clear();
    const bool on_line = piece_.role[v] == VertexRole::kOnLine;
    for (const Neighbour& n : star_.neighbours) {
      if (on_line && !n.by_line()) continue;
      Quadric both = piece_.quadric[v];
      both += piece_.quadric[n.v];
      Way way{0, n.v, piece_.points[n.v]};
      if (moves_along(v, n)) way.at = place_between(v, n.v, both);
      way.cost = both.mean(way.at - piece_.origin);
      if (way.cost <= bound_) ways_.push_back(way);
    }
  }

  /// Whether the neighbour may go to meet the vertex.
  bool moves_along(VertexIndex v, const Neighbour& n) const {
    return piece_.role[n.v] == piece_.role[v] && !piece_.is_at_rim[n.v];
  }

  /// The best place for both: on what is flat the neighbour's own, so that it stays flat.
  Vec3 place_between(VertexIndex v, VertexIndex w, const Quadric& both) const {
    constexpr double kFlat = 1e-10;  // squared parts of the edge: as flat as sums of rounded numbers tell
    const Vec3 p = piece_.points[v], q = piece_.points[w], middle = (p + q) * 0.5;
    const double edge = squared_distance(p, q);
    // A line in a plane, as on the box of an image, stays in it to the last bit.
    if (piece_.role[v] == VertexRole::kOnLine) return q + (p - q) * both.least_along(q - piece_.origin, p - q);
    if (both.mean(q - piece_.origin) <= kFlat * edge) return q;
    const Vec3 best = both.least(middle - piece_.origin) + piece_.origin;
    return squared_distance(best, middle) <= edge ? best : middle;
  }

  bool may_collapse(VertexIndex v, const Way& way) {
    changed_.clear(), made_.clear();
    if (!list_changed(star_, way.to, way.to, way.at)) return false;
    gather(way.to, other_);
    if (way.at != piece_.points[way.to] && !list_changed(other_, v, way.to, way.at)) return false;
    return keeps_topology(v, way.to) && (!live_ || crosses_nothing());
  }

  /// The links of both ends meet in that of the edge alone (T. Dey and others, "Topology preserving edge contraction",
  /// 1999), those of lines too.
  bool keeps_topology(VertexIndex v, VertexIndex w) {
    apexes_.clear();
    for (const std::uint32_t c : star_.corners) {
      if (corner(c, 1) == w) apexes_.push_back(corner(c, 2));
      if (corner(c, 2) == w) apexes_.push_back(corner(c, 1));
    }
    const auto is_apex = [&](VertexIndex a) { return std::ranges::find(apexes_, a) != apexes_.end(); };
    for (const Neighbour& n : star_.neighbours) {
      if (n.v == w) continue;
      const bool by_line = piece_.role[v] == VertexRole::kOnLine && n.by_line();
      if (other_.find(n.v) != nullptr && (by_line || !is_apex(n.v))) return false;
    }
    return std::ranges::none_of(star_.corners,
                                [&](std::uint32_t c) { return is_apex(corner(c, 1)) && is_apex(corner(c, 2)); });
  }

  /// Lists the triangles of a star but those with `gone`, its vertex become `id`, `at` a new place. False: one loses
  /// its sense or its shape, or gets longer edges than it may.
  bool list_changed(const Star& star, VertexIndex gone, VertexIndex id, Vec3 at) {
    for (const std::uint32_t c : star.corners) {
      const VertexIndex a = corner(c, 1), b = corner(c, 2);
      if (a == gone || b == gone) continue;
      const Vec3 p = piece_.points[a], q = piece_.points[b], was = piece_.points[corner(c, 0)];
      const double longest = limits_.edge * limits_.edge;
      if (squared_distance(at, p) > longest || squared_distance(at, q) > longest) return false;
      const Vec3 before = cross(p - was, q - was), after = cross(p - at, q - at);
      const double area = length(after), area_before = length(before);
      if (!(dot(before, after) > kLeastTurn * area * area_before)) return false;
      const TriangleCorners made{at, p, q};
      const double shape = shape_of(made, area);
      if (shape < kShape && shape < shape_of({was, p, q}, area_before)) return false;
      changed_.push_back(c / 3);
      made_.push_back({{id, a, b}, made});
    }
    return true;
  }

  bool crosses_nothing() {
    std::vector<std::uint32_t> given_up = changed_;
    for (const std::uint32_t c : star_.corners) given_up.push_back(c / 3);
    return live_->crossings_among(made_, given_up, 1) == 0;
  }

  void collapse(VertexIndex v, const Way& way) {
    const VertexIndex w = way.to;
    piece_.points[w] = way.at;
    piece_.quadric[w] += piece_.quadric[v];
    for (const std::uint32_t c : star_.corners) {
      const std::uint32_t t = c / 3;
      if (corner(c, 1) == w || corner(c, 2) == w) {
        piece_.triangles[t][0] = kNone;
        --of_sheet_[piece_.sheet[t]];
        continue;
      }
      piece_.triangles[t][c % 3] = w;
      next_[c] = first_[w];
      first_[w] = c;
    }
    first_[v] = kNone;
    for (const IdTriangle& t : made_)
      for (const VertexIndex a : t.ids) is_fresh_[a] = 1;
    if (live_) live_->note_changed(changed_);
  }

  Piece& piece_;
  const DecimationLimits& limits_;
  const RunContext& context_;
  std::vector<std::uint32_t> first_, next_;   ///< the corners at a vertex, a list each
  std::vector<std::uint32_t> of_sheet_;       ///< triangles
  std::vector<std::uint8_t> is_fresh_;        ///< something has changed since it was last tried
  std::optional<LiveTriangles<Piece>> live_;  ///< where crossings are tested
  double bound_ = 0;                          ///< squared
  Star star_, other_;
  std::vector<Way> ways_;
  std::vector<VertexIndex> apexes_;
  std::vector<std::uint32_t> changed_;  ///< triangles
  std::vector<IdTriangle> made_;        ///< what they become
};

}  // namespace

void decimate(Piece& piece, const DecimationLimits& limits, Crossings crossings, const RunContext& context) {
  Decimator(piece, limits, crossings, context).run();
}

}  // namespace octafront
