#include "adapt/schedule/sheet_passes.h"

#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>

namespace octafront::adapt {
namespace {

/// How far new vertices look for the ground, in edge lengths: the sagitta of half a circle.
constexpr double kReachOfSheet = 0.5;
/// A new triangle has at least this part of the worst score of those before, or this score.
constexpr double kLeastOfSheetSplit = 0.2, kLeastOfSheetCollapse = 0.3;
/// No triangle turns by more (cosine) against the one before.
constexpr double kLeastTurnOfSheet = 0.5;
/// Splits that leave shorter edges than this wait until the place is connected better; much longer ones less.
constexpr double kShortestOfSheetSplit = 0.55, kMuchTooLongOfSheet = 1.5;
/// Swaps and moves must gain at least this part of the worst score; less is not worth it.
constexpr double kLeastGainOfSheet = 1.02;
/// Moves leave no score below this, or below the worst one there was.
constexpr double kGuardOfSheetMove = 0.6;
/// Good enough to be let be.
constexpr double kGoodOfSheet = 0.98;
constexpr int kTriesOfSheetMove = 3;
constexpr int kCheckSheetEvery = 1024;
/// What is nearer than this part of the tolerance to the given surface lies on it.
constexpr double kThereOfSheet = 1e-3;

Vec3 normal_of(const TriangleCorners& c) {
  return double_area_normal(c[0], c[1], c[2]);
}

bool turns_little(const TriangleCorners& before, const TriangleCorners& after) {
  const Vec3 had = normal_of(before), has = normal_of(after);
  return dot(had, has) > kLeastTurnOfSheet * length(had) * length(has);
}

/// What all passes share.
class SheetPass {
 public:
  SheetPass(Sheet& sheet, const SheetGuide& guide) : sheet_(sheet), guide_(guide.guide), outer_(guide.outer) {}

 protected:
  Wall wall_of(std::uint32_t part) const { return (part + 1) | (outer_ ? kOuter : 0); }
  void tick() {
    if (++steps_ % kCheckSheetEvery == 0) guide_.context.check();
  }
  static bool are_frozen(const Vertex& a, const Vertex& b) { return a.frozen && b.frozen; }

  struct LongOrShort {
    double length;
    Edge edge;
  };
  /// Edges at active vertices whose length `is_wanted`.
  template <class IsWanted>
  std::vector<LongOrShort> edges_that(const IsWanted& is_wanted) const {
    std::vector<LongOrShort> found;
    FlatSet<Edge> seen;
    for (std::uint32_t t = 0; t < sheet_.slots(); ++t) {
      if (!sheet_.alive(t)) continue;
      const Triangle& c = sheet_.corners(t);
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge e = sorted_edge(c[i], c[(i + 1) % 3]);
        const Vertex &a = sheet_.vertices[e[0]], &b = sheet_.vertices[e[1]];
        if (!(a.active || b.active) || are_frozen(a, b) || !seen.insert(e)) continue;
        if (const double l = sheet_.edge_length(e[0], e[1]); is_wanted(l)) found.push_back({l, e});
      }
    }
    return found;
  }

  /// Where the ground wants a vertex at p, on a line or on the part of triangles whose normals add up to this.
  std::optional<Vec3> home(Vec3 p, const std::optional<std::uint32_t>& path, std::uint32_t part, Vec3 normal,
                           double reach) const {
    return path ? guide_.ground.on_line(p, *path, reach) : guide_.ground.on_surface(p, part, outer_, normal, reach);
  }

  /// Whether these triangles may take the place of others; no part vanishes.
  bool keeps_true(std::span<const std::uint32_t> old, std::span<const Sheet::Face> fresh) const {
    std::vector<WallTriangle> before, after;
    for (const std::uint32_t t : old) before.push_back({sheet_.places(sheet_.corners(t)), wall_of(sheet_.part(t))});
    for (const Sheet::Face& f : fresh) after.push_back({sheet_.places(f.corners), wall_of(f.part)});
    return keep_walls_true(guide_, before, after);
  }

  Sheet& sheet_;
  const Guide& guide_;
  bool outer_;
  int steps_ = 0;
};

class SheetSplitter : SheetPass {
 public:
  using SheetPass::SheetPass;

  PassCount run() {
    PassCount count;
    std::vector<LongOrShort> edges = edges_that([](double l) { return l > kLongest; });
    std::sort(edges.begin(), edges.end(), [](const LongOrShort& a, const LongOrShort& b) {
      return a.length != b.length ? a.length > b.length : a.edge < b.edge;
    });
    for (const LongOrShort& e : edges) {
      tick();
      ++count.tried;
      count.done += split(e.edge[0], e.edge[1], e.length);
    }
    return count;
  }

 private:
  bool split(VertexIndex a, VertexIndex b, double length) {
    const std::vector<std::uint32_t> old = sheet_.around(a, b);
    if (old.empty()) return false;
    const std::uint32_t* line = sheet_.line(a, b);
    std::optional<std::uint32_t> path;
    if (line) path = *line;
    const Vec3 p = sheet_.point(a), q = sheet_.point(b), straight = 0.5 * (p + q);
    Vec3 normal{};
    for (const std::uint32_t t : old) {
      const Vec3 n = normal_of(sheet_.places(sheet_.corners(t)));
      normal += !outer_ && dot(n, normal) < 0 ? -normalized(n) : normalized(n);
    }
    const Vec3 to =
        home(straight, path, sheet_.part(old[0]), normal, kReachOfSheet * distance(p, q)).value_or(straight);
    Vertex made = between(sheet_.vertices[a], sheet_.vertices[b], 0.5);
    made.kind = path ? Kind::kCurve : Kind::kSurface;
    for (const double share : {1.0, 0.5, 0.0}) {
      if (share != 0 && to == straight) continue;
      made.at = straight + share * (to - straight);
      made.off = guide_.ground.given() && share != 1 && to != straight;
      guide_.ask(made);
      if (!is_fair(old, a, b, made, length)) continue;
      apply(old, a, b, made, path);
      return true;
    }
    return false;
  }

  bool is_fair(std::span<const std::uint32_t> old, VertexIndex a, VertexIndex b, const Vertex& made,
               double length) const {
    double shortest = kShortestOfSheetSplit;
    const double excess = std::max(length / kMuchTooLongOfSheet, 1.0);
    shortest /= excess * excess;
    for (const std::uint32_t t : old) {
      const Triangle& c = sheet_.corners(t);
      if (Sheet::length_between(made, sheet_.vertices[Sheet::apex(c, a, b)]) < shortest) return false;
      const double least = kLeastOfSheetSplit * sheet_.score(c);
      for (const VertexIndex gone : {a, b}) {
        std::array<const Vertex*, 3> corners{};
        TriangleCorners now = sheet_.places(c);
        for (std::size_t i = 0; i < 3; ++i) {
          corners[i] = c[i] == gone ? &made : &sheet_.vertices[c[i]];
          if (c[i] == gone) now[i] = made.at;
        }
        if (!(Sheet::score_of(corners) > least) || !turns_little(sheet_.places(c), now)) return false;
      }
    }
    return true;
  }

  void apply(std::span<const std::uint32_t> old, VertexIndex a, VertexIndex b, const Vertex& made,
             const std::optional<std::uint32_t>& path) {
    const VertexIndex v = sheet_.add(made);
    std::vector<Sheet::Face> fresh;
    for (const std::uint32_t t : old)
      for (const VertexIndex gone : {a, b}) {
        Triangle c = sheet_.corners(t);
        std::replace(c.begin(), c.end(), gone, v);
        fresh.push_back({c, sheet_.part(t)});
      }
    if (path) sheet_.line_edges.divide(a, b, v, *path);
    sheet_.replace(old, fresh);
  }
};

class SheetCollapser : SheetPass {
 public:
  using SheetPass::SheetPass;

  PassCount run() {
    PassCount count;
    std::vector<LongOrShort> edges = edges_that([](double l) { return l < kShortest; });
    std::sort(edges.begin(), edges.end(), [](const LongOrShort& a, const LongOrShort& b) {
      return a.length != b.length ? a.length < b.length : a.edge < b.edge;
    });
    for (const LongOrShort& e : edges) {
      tick();
      const std::vector<std::uint32_t> ring = sheet_.around(e.edge[0], e.edge[1]);
      if (ring.empty() || !(sheet_.edge_length(e.edge[0], e.edge[1]) < kShortest)) continue;
      ++count.tried;
      count.done += collapse(e.edge[0], e.edge[1], ring) || collapse(e.edge[1], e.edge[0], ring);
    }
    return count;
  }

 private:
  bool may_go(VertexIndex u, VertexIndex w) const {
    const Vertex &from = sheet_.vertices[u], &to = sheet_.vertices[w];
    // Beyond a rim there may be an edge or a triangle as one that would come.
    if (from.frozen || from.kind == Kind::kFixed || to.rim) return false;
    if (from.kind == Kind::kCurve) return to.kind >= Kind::kCurve && sheet_.line(u, w);
    return true;
  }

  /// Only what both ends share with the edge's triangles lies beside both: else the surface would touch itself.
  bool keeps_manifold(VertexIndex u, VertexIndex w, std::span<const std::uint32_t> ring,
                      std::span<const Sheet::Face> fresh) const {
    const std::vector<VertexIndex> of_u = sheet_.neighbours(u), of_w = sheet_.neighbours(w);
    std::vector<VertexIndex> common, apexes;
    std::set_intersection(of_u.begin(), of_u.end(), of_w.begin(), of_w.end(), std::back_inserter(common));
    for (const std::uint32_t t : ring) apexes.push_back(Sheet::apex(sheet_.corners(t), u, w));
    std::sort(apexes.begin(), apexes.end());
    if (common != apexes) return false;
    for (const std::uint32_t t : sheet_.star(w))
      for (const Sheet::Face& f : fresh)
        if (face_key(f.corners) == face_key(sheet_.corners(t))) return false;
    // A line does not come twice to an edge.
    for (const VertexIndex v : common)
      if (sheet_.line(u, v) && sheet_.line(w, v)) return false;
    return true;
  }

  bool collapse(VertexIndex u, VertexIndex w, std::span<const std::uint32_t> ring) {
    if (!may_go(u, w)) return false;
    const std::vector<std::uint32_t> old = sheet_.star(u);
    std::vector<Sheet::Face> fresh;
    double had = 1;
    for (const std::uint32_t t : old) {
      had = std::min(had, sheet_.score(sheet_.corners(t)));
      if (std::find(ring.begin(), ring.end(), t) != ring.end()) continue;
      Triangle c = sheet_.corners(t);
      std::replace(c.begin(), c.end(), u, w);
      if (!turns_little(sheet_.places(sheet_.corners(t)), sheet_.places(c))) return false;
      fresh.push_back({c, sheet_.part(t)});
    }
    if (fresh.empty()) return false;
    const double least = std::min(had, kLeastOfSheetCollapse);
    for (const Sheet::Face& f : fresh) {
      if (!(sheet_.score(f.corners) >= least)) return false;
      for (const VertexIndex v : f.corners)
        if (v != w && sheet_.edge_length(v, w) > kLongest) return false;
    }
    if (!keeps_manifold(u, w, ring, fresh) || !keeps_true(old, fresh)) return false;
    if (sheet_.vertices[u].kind == Kind::kCurve) sheet_.line_edges.shorten(u, w, sheet_.neighbours(u));
    sheet_.replace(old, fresh);
    return true;
  }
};

class SheetSwapper : SheetPass {
 public:
  using SheetPass::SheetPass;

  PassCount run() {
    PassCount count;
    for (const LongOrShort& e : edges_that([](double) { return true; })) {
      tick();
      ++count.tried;
      count.done += swap(e.edge[0], e.edge[1]);
    }
    return count;
  }

 private:
  bool swap(VertexIndex a, VertexIndex b) {
    if (sheet_.line(a, b)) return false;
    const std::vector<std::uint32_t> old = sheet_.around(a, b);
    if (old.size() != 2 || sheet_.part(old[0]) != sheet_.part(old[1])) return false;
    Triangle first = sheet_.corners(old[0]), second = sheet_.corners(old[1]);
    const double had = std::min(sheet_.score(first), sheet_.score(second));
    if (had >= kGoodOfSheet) return false;
    const VertexIndex p = Sheet::apex(first, a, b), q = Sheet::apex(second, a, b);
    while (first[0] != p) std::rotate(first.begin(), first.begin() + 1, first.end());
    while (second[0] != q) std::rotate(second.begin(), second.begin() + 1, second.end());
    if (p == q || first[1] != second[2] || first[2] != second[1]) return false;
    const std::array<Sheet::Face, 2> fresh{Sheet::Face{{q, first[2], p}, sheet_.part(old[0])},
                                           Sheet::Face{{p, first[1], q}, sheet_.part(old[0])}};
    if (!(std::min(sheet_.score(fresh[0].corners), sheet_.score(fresh[1].corners)) > kLeastGainOfSheet * had))
      return false;
    if (sheet_.edge_length(p, q) > std::max(kLongest, sheet_.edge_length(a, b)) || !sheet_.around(p, q).empty())
      return false;
    if (sheet_.vertices[p].rim && sheet_.vertices[q].rim) return false;  // they may share an edge beyond it
    for (const Sheet::Face& f : fresh)
      for (const Triangle& t : {first, second})
        if (!turns_little(sheet_.places(t), sheet_.places(f.corners))) return false;
    if (!keeps_true(old, fresh)) return false;
    sheet_.replace(old, fresh);
    return true;
  }
};

class SheetSmoother : SheetPass {
 public:
  using SheetPass::SheetPass;

  PassCount run() {
    PassCount count;
    for (VertexIndex v = 0; v < sheet_.vertices.size(); ++v) {
      const Vertex& at = sheet_.vertices[v];
      if (sheet_.star(v).empty() || at.frozen || !at.active) continue;
      tick();
      ++count.tried;
      count.done += at.off ? settle(v) : at.kind != Kind::kFixed && move(v);
    }
    return count;
  }

 private:
  struct Setting {
    std::optional<std::uint32_t> path;
    Vec3 normal{};
    double reach = 0;
    std::vector<Triangle> star;
    double had = 1, lack = 0;
  };
  /// False if the vertex is not where it can move.
  bool look_around(VertexIndex v, Setting& s) const {
    int ends = 0;
    for (const VertexIndex u : sheet_.neighbours(v)) {
      s.reach = std::max(s.reach, kReachOfSheet * distance(sheet_.point(u), sheet_.point(v)));
      if (const std::uint32_t* line = sheet_.line(u, v)) {
        if (s.path && *s.path != *line) return false;
        s.path = *line, ++ends;
      }
    }
    for (const std::uint32_t t : sheet_.star(v)) {
      s.star.push_back(sheet_.corners(t));
      const Vec3 n = normal_of(sheet_.places(s.star.back()));
      s.normal += !outer_ && dot(n, s.normal) < 0 ? -n : n;
      const double score = sheet_.score(s.star.back());
      s.had = std::min(s.had, score), s.lack += lack_of(score);
    }
    return sheet_.vertices[v].kind != Kind::kCurve || ends == 2;
  }
  static double lack_of(double score) { return 1 / (score + 1e-300) - 1; }

  std::optional<Vec3> snapped(VertexIndex v, Vec3 p, const Setting& s) const {
    if (sheet_.vertices[v].kind == Kind::kFixed) return guide_.ground.corner(sheet_.vertices[v].id);
    return home(p, s.path, sheet_.part(sheet_.star(v)[0]), s.normal, s.reach);
  }

  /// Its neighbours' mean, those count more whose edges are too long; on a line its two neighbours there.
  Vec3 aim(VertexIndex v, const Setting& s) const {
    Vec3 sum{};
    double weights = 0;
    for (const VertexIndex u : sheet_.neighbours(v)) {
      if (s.path && !sheet_.line(u, v)) continue;
      const double l = sheet_.edge_length(u, v);
      sum += l * sheet_.point(u), weights += l;
    }
    return weights > 0 ? sum / weights : sheet_.point(v);
  }

  bool move(VertexIndex v) {
    Setting s;
    if (!look_around(v, s) || s.had >= kGoodOfSheet) return false;
    const Vec3 from = sheet_.point(v), to = aim(v, s);
    for (double share = 1, k = 0; k < kTriesOfSheetMove; ++k, share *= 0.5) {
      const auto at = snapped(v, from + share * (to - from), s);
      if (at && try_at(v, *at, s, std::min(s.had, kGuardOfSheetMove), s.lack / kLeastGainOfSheet, true)) return true;
    }
    return false;
  }

  bool settle(VertexIndex v) {
    Setting s;
    const bool can = look_around(v, s);
    const Vec3 from = sheet_.point(v);
    const auto to = can || sheet_.vertices[v].kind == Kind::kFixed ? snapped(v, from, s) : std::nullopt;
    if (!to || distance(*to, from) <= kThereOfSheet * guide_.tolerance) {
      sheet_.vertices[v].off = false;
      return false;
    }
    for (const double share : {1.0, 0.5, 0.25})
      if (try_at(v, from + share * (*to - from), s, kLeastOfSheetSplit * s.had, HUGE_VAL, false)) {
        sheet_.vertices[v].off = share != 1;
        return true;
      }
    return false;
  }

  /// Moves it there if no score is below `least`, and what triangles lack together below `most`.
  bool try_at(VertexIndex v, Vec3 at, const Setting& s, double least, double most, bool truly) {
    const Vertex from = sheet_.vertices[v];
    std::vector<TriangleCorners> before;
    for (const Triangle& t : s.star) before.push_back(sheet_.places(t));
    sheet_.vertices[v].at = at;
    guide_.ask(sheet_.vertices[v]);
    double lack = 0;
    bool is_good = true;
    for (std::size_t k = 0; k < s.star.size() && is_good; ++k) {
      const double score = sheet_.score(s.star[k]);
      lack += lack_of(score);
      is_good = score >= least && turns_little(before[k], sheet_.places(s.star[k]));
    }
    is_good = is_good && lack < most && (!truly || stays_true(v, before));
    if (!is_good) {
      sheet_.vertices[v] = from;
      return false;
    }
    for (const VertexIndex u : sheet_.neighbours(v)) sheet_.touch(u);
    return true;
  }

  bool stays_true(VertexIndex v, std::span<const TriangleCorners> before) const {
    const std::vector<std::uint32_t>& star = sheet_.star(v);
    for (std::size_t k = 0; k < star.size(); ++k) {
      const std::array<TriangleCorners, 1> had{before[k]}, has{sheet_.places(sheet_.corners(star[k]))};
      if (!keeps_walls_true(guide_, had, has, wall_of(sheet_.part(star[k])))) return false;
    }
    return true;
  }
};

}  // namespace

PassCount split_long_edges(Sheet& sheet, const SheetGuide& guide) {
  return SheetSplitter(sheet, guide).run();
}
PassCount collapse_short_edges(Sheet& sheet, const SheetGuide& guide) {
  return SheetCollapser(sheet, guide).run();
}
PassCount swap_edges(Sheet& sheet, const SheetGuide& guide) {
  return SheetSwapper(sheet, guide).run();
}
PassCount smooth_vertices(Sheet& sheet, const SheetGuide& guide) {
  return SheetSmoother(sheet, guide).run();
}

}  // namespace octafront::adapt
