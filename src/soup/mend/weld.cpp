#include "base/core/disjoint_sets.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "soup/mend/mend_steps.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace octafront::mend {
namespace {

using tidy::Draft;

/// How far the ends of edges that fit may be from each other, as a part of the shorter edge: of edges that share a
/// vertex already, which enclose an angle below 30 degrees then, and of others.
constexpr double kNearShared = 0.5, kNear = 0.75;
/// What is joined in one round brings other edges together: few rounds do.
constexpr int kWeldRounds = 8;

struct OpenEdge {
  VertexIndex from, to;
  std::uint32_t triangle;
};

std::vector<OpenEdge> open_edges(Draft& draft) {
  const EdgeTable& table = draft.edges();
  std::vector<OpenEdge> open;
  for (std::size_t e = 0; e < table.size(); ++e)
    if (const auto uses = table.uses(e); uses.size() == 1)
      open.push_back({start_of(draft.mesh.triangles, uses[0]), end_of(draft.mesh.triangles, uses[0]), uses[0] / 3});
  return open;
}

/// A tree over edges, as triangles without area.
TriangleTree tree_of(const Draft& draft, const std::vector<OpenEdge>& open) {
  std::vector<Triangle> flat;
  for (const OpenEdge& e : open) flat.push_back({e.from, e.to, e.to});
  return {draft.mesh.points, flat};
}

/// Two open edges that may be one.
struct Pair {
  double apart;
  std::uint32_t e, f;
  bool opposite;  ///< the one runs against the other
};

/// Vertices that become one, with the triangles at each.
class Clusters {
 public:
  Clusters(const Draft& draft, double tolerance)
      : draft_(draft), tolerance_(tolerance), sets_(draft.mesh.points.size()) {
    members_.resize(draft.mesh.points.size());
    triangles_at_.resize(draft.mesh.points.size());
    for (std::uint32_t t = 0; t < draft.mesh.triangles.size(); ++t)
      for (const VertexIndex v : draft.mesh.triangles[t]) triangles_at_[v].push_back(t);
  }

  VertexIndex find(VertexIndex v) { return sets_.find(v); }

  bool may_join(VertexIndex a, VertexIndex b) {
    a = find(a);
    b = find(b);
    if (a == b) return true;
    Box3 box;
    for (const VertexIndex c : {a, b}) for_each_member(c, [&](VertexIndex v) { box.add(draft_.mesh.points[v]); });
    if (box.diagonal() > 2 * tolerance_) return false;
    bool collapses = false;
    for_each_member(a, [&](VertexIndex v) {
      for (const std::uint32_t t : triangles_at_[v])
        for (const VertexIndex w : draft_.mesh.triangles[t]) collapses = collapses || find(w) == b;
    });
    return !collapses;
  }

  void join(VertexIndex a, VertexIndex b) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    sets_.join(a, b);
    const VertexIndex kept = find(a), gone = kept == a ? b : a;
    members_[kept].push_back(gone);
    members_[kept].insert(members_[kept].end(), members_[gone].begin(), members_[gone].end());
    members_[gone].clear();
  }

  /// Triangles refer to the least vertex of each cluster, which goes to the middle of it.
  void apply(Draft& draft, Welded& welded) {
    for (VertexIndex v = 0; v < members_.size(); ++v) {
      if (members_[v].empty()) continue;
      Vec3 sum;
      for_each_member(v, [&](VertexIndex w) { sum += draft.mesh.points[w]; });
      const Vec3 middle = sum / static_cast<double>(1 + members_[v].size());
      for_each_member(v, [&](VertexIndex w) {
        welded.largest_move = std::max(welded.largest_move, distance(middle, draft.mesh.points[w]));
      });
      draft.mesh.points[v] = middle;
      welded.joined += members_[v].size();
      welded.places.push_back(middle);
    }
    for (Triangle& t : draft.mesh.triangles)
      for (VertexIndex& v : t) v = find(v);
    draft.known_edges.reset();
  }

 private:
  template <class Visit>
  void for_each_member(VertexIndex cluster, const Visit& visit) const {
    visit(cluster);
    for (const VertexIndex v : members_[cluster]) visit(v);
  }

  const Draft& draft_;
  double tolerance_;
  DisjointSets sets_;
  std::vector<std::vector<VertexIndex>> members_;  ///< of the least one of each cluster; the others
  std::vector<std::vector<std::uint32_t>> triangles_at_;
};

class Welder {
 public:
  Welder(Draft& draft, double tolerance) : draft_(draft), tolerance_(tolerance) {}

  Welded result() {
    for (int round = 0; round < kWeldRounds; ++round) {
      const bool fitted = join_edges(), joined = join_vertices(), divided = divide_edges();
      if (!fitted && !joined && !divided) break;
    }
    return std::move(welded_);
  }

 private:
  Vec3 at(VertexIndex v) const { return draft_.mesh.points[v]; }
  double length_of(const OpenEdge& e) const { return distance(at(e.from), at(e.to)); }

  /// How far the ends of two edges are apart, the better way round.
  Pair fit(std::uint32_t i, std::uint32_t j, const OpenEdge& e, const OpenEdge& f) const {
    const double opposite = std::max(distance(at(e.from), at(f.to)), distance(at(e.to), at(f.from)));
    const double along = std::max(distance(at(e.from), at(f.from)), distance(at(e.to), at(f.to)));
    return {std::min(opposite, along), i, j, opposite <= along};
  }

  std::vector<Pair> pairs(const std::vector<OpenEdge>& open) const {
    const TriangleTree tree = tree_of(draft_, open);
    std::vector<Pair> found;
    for (std::uint32_t i = 0; i < open.size(); ++i) {
      if (i % 4096 == 0) draft_.context.check();
      const OpenEdge& e = open[i];
      const double reach = std::min(tolerance_, kNear * length_of(e));
      tree.for_each_box_near(Box3{at(e.from), at(e.from)}.grown(reach), [&](std::uint32_t j, const TriangleCorners&) {
        const OpenEdge& f = open[j];
        if (j == i || e.triangle == f.triangle) return true;
        const bool shares = e.from == f.from || e.from == f.to || e.to == f.from || e.to == f.to;
        const Pair pair = fit(std::min(i, j), std::max(i, j), open[std::min(i, j)], open[std::max(i, j)]);
        const double shorter = std::min(length_of(e), length_of(f));
        if (pair.apart <= std::min(tolerance_, (shares ? kNearShared : kNear) * shorter)) found.push_back(pair);
        return true;
      });
    }
    const auto key = [](const Pair& p) { return std::tuple(p.apart, p.e, p.f); };
    std::sort(found.begin(), found.end(), [&](const Pair& p, const Pair& q) { return key(p) < key(q); });
    found.erase(std::unique(found.begin(), found.end(), [&](const Pair& p, const Pair& q) { return key(p) == key(q); }),
                found.end());
    return found;
  }

  /// The nearest first, each edge once.
  bool join_edges() {
    const std::vector<OpenEdge> open = open_edges(draft_);
    const std::vector<Pair> all = pairs(open);
    if (all.empty()) return false;
    Clusters clusters(draft_, tolerance_);
    std::vector<char> taken(open.size(), 0);
    bool any = false;
    for (const Pair& pair : all) {
      if (taken[pair.e] || taken[pair.f]) continue;
      const OpenEdge &e = open[pair.e], &f = open[pair.f];
      const VertexIndex first = pair.opposite ? f.to : f.from, second = pair.opposite ? f.from : f.to;
      if (!clusters.may_join(e.from, first) || !clusters.may_join(e.to, second)) continue;
      any = any || clusters.find(e.from) != clusters.find(first) || clusters.find(e.to) != clusters.find(second);
      clusters.join(e.from, first);
      if (clusters.may_join(e.to, second)) clusters.join(e.to, second);
      taken[pair.e] = taken[pair.f] = 1;
    }
    if (any) clusters.apply(draft_, welded_);
    return any;
  }

  static std::vector<VertexIndex> vertices_of(const std::vector<OpenEdge>& open) {
    std::vector<VertexIndex> vertices;
    for (const OpenEdge& e : open) vertices.insert(vertices.end(), {e.from, e.to});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  /// Ends of edges that do not fit, where they are nearer to each other than to all else: the nearest first.
  bool join_vertices() {
    const std::vector<OpenEdge> open = open_edges(draft_);
    std::map<VertexIndex, double> room;  // the shortest open edge at each
    for (const OpenEdge& e : open)
      for (const VertexIndex v : {e.from, e.to}) {
        const auto at = room.try_emplace(v, length_of(e)).first;
        at->second = std::min(at->second, length_of(e));
      }
    const TriangleTree tree = tree_of(draft_, open);
    std::vector<std::tuple<double, VertexIndex, VertexIndex>> pairs;
    for (const auto& [v, of_v] : room) {
      const double reach = std::min(tolerance_, kNearShared * of_v);
      tree.for_each_box_near(Box3{at(v), at(v)}.grown(reach), [&, v = v](std::uint32_t i, const TriangleCorners&) {
        for (const VertexIndex w : {open[i].from, open[i].to})
          if (v < w && distance(at(v), at(w)) <= std::min(reach, kNearShared * room[w]))
            pairs.push_back({distance(at(v), at(w)), v, w});
        return true;
      });
    }
    if (pairs.empty()) return false;
    std::sort(pairs.begin(), pairs.end());
    Clusters clusters(draft_, tolerance_);
    bool any = false;
    for (const auto& [apart, v, w] : pairs) {
      if (clusters.find(v) == clusters.find(w) || !clusters.may_join(v, w)) continue;
      clusters.join(v, w);
      any = true;
    }
    if (any) clusters.apply(draft_, welded_);
    return any;
  }

  /// The vertices of open edges that lie beside each open edge, away from its ends.
  std::vector<std::vector<VertexIndex>> vertices_beside(const std::vector<OpenEdge>& open) const {
    const std::vector<VertexIndex> vertices = vertices_of(open);
    const TriangleTree tree = tree_of(draft_, open);
    std::vector<std::vector<VertexIndex>> beside(open.size());
    for (const VertexIndex v : vertices) {
      const Vec3 p = at(v);
      tree.for_each_box_near(Box3{p, p}.grown(tolerance_), [&](std::uint32_t i, const TriangleCorners&) {
        const OpenEdge& e = open[i];
        const Triangle& t = draft_.mesh.triangles[e.triangle];
        if (std::find(t.begin(), t.end(), v) != t.end()) return true;
        const Vec3 a = at(e.from), b = at(e.to), q = closest_point_on_segment(p, a, b);
        const double away = distance(p, q);
        const bool inner = q != a && q != b;
        // Farther from the ends than from the edge: else it is an end that does not fit.
        if (inner && away <= std::min(tolerance_, kNearShared * std::min(distance(q, a), distance(q, b))))
          beside[i].push_back(v);
        return true;
      });
    }
    return beside;
  }

  bool divide_edges() {
    const std::vector<OpenEdge> open = open_edges(draft_);
    auto beside = vertices_beside(open);
    std::vector<char> changed(draft_.mesh.triangles.size(), 0);
    bool any = false;
    for (std::size_t i = 0; i < open.size(); ++i) {
      // A triangle's other edges have their turn in the next round.
      if (beside[i].empty() || changed[open[i].triangle]) continue;
      changed[open[i].triangle] = 1;
      divide(open[i], beside[i]);
      any = true;
    }
    if (any) draft_.known_edges.reset();
    return any;
  }

  void divide(const OpenEdge& e, std::vector<VertexIndex>& between) {
    const Vec3 a = at(e.from), along = at(e.to) - a;
    std::sort(between.begin(), between.end(), [&](VertexIndex v, VertexIndex w) {
      return std::pair(dot(at(v) - a, along), v) < std::pair(dot(at(w) - a, along), w);
    });
    const Triangle t = draft_.mesh.triangles[e.triangle];
    const VertexIndex apex = *std::find_if(t.begin(), t.end(), [&](VertexIndex v) { return v != e.from && v != e.to; });
    VertexIndex last = e.from;
    for (const VertexIndex v : between) {
      welded_.largest_move =
          std::max(welded_.largest_move, distance(at(v), closest_point_on_segment(at(v), a, at(e.to))));
      welded_.places.push_back(at(v));
      ++welded_.divided;
      add(last, v, apex, e.triangle);
      last = v;
    }
    draft_.mesh.triangles[e.triangle] = {last, e.to, apex};
  }

  void add(VertexIndex a, VertexIndex b, VertexIndex c, std::uint32_t like) {
    draft_.mesh.triangles.push_back({a, b, c});
    draft_.face.push_back(draft_.face[like]);
    if (!draft_.mesh.patch.empty()) draft_.mesh.patch.push_back(draft_.mesh.patch[like]);
  }

  Draft& draft_;
  double tolerance_;
  Welded welded_;
};

}  // namespace

Welded weld_open_edges(Draft& draft, double tolerance) {
  return tolerance > 0 ? Welder(draft, tolerance).result() : Welded{};
}

}  // namespace octafront::mend
