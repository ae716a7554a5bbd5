#include "base/core/disjoint_sets.h"
#include "base/core/random.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"
#include "base/mesh/surface_topology.h"
#include "soup/cells/side_graph.h"
#include "soup/mend/caps.h"
#include "soup/mend/mend_steps.h"

#include <algorithm>
#include <map>
#include <set>

namespace octafront::mend {
namespace {

/// A copy moves by a part of the shortest edge beside it at most, and half as far again where it still touches.
constexpr double kStep = 0.2;
constexpr int kSeparateRounds = 30;

/// A vertex of one fan: where it was, which way it goes, how far.
struct Copy {
  VertexIndex vertex;
  Vec3 from, way, base;  ///< `base`: the way that it should go
  double step;
  std::uint32_t of;  ///< so many copies
};

/// A direction that all of the vectors point along, or the best that is found; `reach` says how well: the least cosine.
struct Way {
  Vec3 to;
  double reach;
};
Way common_way(const std::vector<Vec3>& vectors) {
  Way way{};
  for (const Vec3 v : vectors) way.to += v;
  way.to = normalized(way.to);
  // Turns towards the worst vector gain less and less: what is not found by then hardly exists.
  constexpr int kTries = 40;
  constexpr double kEnough = 0.15, kTurn = 0.3;
  for (int i = 0;; ++i) {
    const Vec3 worst = *std::min_element(vectors.begin(), vectors.end(),
                                         [&](Vec3 a, Vec3 b) { return dot(a, way.to) < dot(b, way.to); });
    way.reach = dot(worst, way.to);
    if (way.reach > kEnough || i == kTries) return way;
    way.to = normalized(way.to + kTurn * worst);
  }
}

/// Where the tip of a fan goes: behind all of its triangles or in front of them, whichever leads away from the other
/// fans and into its own; `away` points so. Zero where there is no such way.
Vec3 way_of_tip(const std::vector<Vec3>& normals, Vec3 away) {
  std::vector<Vec3> backward;
  for (const Vec3 n : normals) backward.push_back(-n);
  const Way behind = common_way(backward), front = common_way(normals);
  if (behind.reach <= 0 && front.reach <= 0) return {};
  if (behind.reach <= 0 || front.reach <= 0) return behind.reach > 0 ? behind.to : front.to;
  return dot(behind.to, away) >= dot(front.to, away) ? behind.to : front.to;
}

/// The fans of triangles around vertices, apart where they hang together through the inside only in the vertex.
class Fans {
 public:
  Fans(const SurfaceMesh& surface, const RunContext& context)
      : triangles_(surface.triangles), fan_(3 * triangles_.size()) {
    const cells::SideGraph graph = cells::make_side_graph(surface.points, triangles_, context);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t other = triangle_of(graph.next[behind(t)][i]);
        for (const VertexIndex v : {triangles_[t][i], triangles_[t][(i + 1) % 3]})
          fan_.join(corner(t, v), corner(other, v));
      }
  }

  /// The fans of vertices with more than one, as corners 3 t + i.
  std::map<VertexIndex, std::vector<std::vector<std::uint32_t>>> shared() {
    std::map<VertexIndex, std::vector<std::vector<std::uint32_t>>> all;
    std::vector<std::uint32_t> first(vertices(), kNone);
    for (std::uint32_t c = 0; c < 3 * triangles_.size(); ++c) {
      std::uint32_t& f = first[vertex(c)];
      if (f == kNone) f = fan_.find(c);
      if (f != fan_.find(c)) all[vertex(c)];
    }
    std::map<std::uint32_t, std::size_t> number;  // of a fan among those of its vertex
    for (std::uint32_t c = 0; c < 3 * triangles_.size(); ++c) {
      const auto at = all.find(vertex(c));
      if (at == all.end()) continue;
      const auto [place, is_new] = number.try_emplace(fan_.find(c), at->second.size());
      if (is_new) at->second.emplace_back();
      at->second[place->second].push_back(c);
    }
    return all;
  }

 private:
  VertexIndex vertex(std::uint32_t c) const { return triangles_[c / 3][c % 3]; }
  std::uint32_t corner(std::uint32_t t, VertexIndex v) const {
    const Triangle& c = triangles_[t];
    return 3 * t + static_cast<std::uint32_t>(std::find(c.begin(), c.end(), v) - c.begin());
  }
  std::size_t vertices() const {
    VertexIndex most = 0;
    for (const Triangle& t : triangles_) most = std::max({most, t[0], t[1], t[2]});
    return most + std::size_t{1};
  }

  const std::vector<Triangle>& triangles_;
  DisjointSets fan_;
};

using Fan = std::vector<std::uint32_t>;

/// Cuts the tips of fans off, where no way leads them apart.
class TipCutter {
 public:
  TipCutter(SurfaceMesh& surface, double most) : surface_(surface), most_(most) {}

  /// Leaves one fan at the vertex, if some fan can stay whole such that the cuts of the others meet nothing.
  bool cut(VertexIndex v, const std::vector<Fan>& fans) {
    double reach = most_;
    for (const Fan& fan : fans)
      for (const std::uint32_t c : fan)
        for (const int j : {1, 2}) reach = std::min(reach, kStep * distance(at(v), at(corner(c, j))));
    for (std::size_t kept = 0; kept < fans.size(); ++kept) {
      std::vector<Triangle> made, whole;
      const std::size_t points = surface_.points.size();
      for (std::size_t f = 0; f < fans.size(); ++f) {
        if (f == kept) {
          for (const std::uint32_t c : fans[f]) whole.push_back(surface_.triangles[c / 3]);
        } else {
          // Two fans may have a spoke in common.
          add_blunt(v, fans[f], reach * (1 - 0.5 * static_cast<double>(f) / static_cast<double>(fans.size())), made);
        }
      }
      std::vector<Triangle> local = made;
      local.insert(local.end(), whole.begin(), whole.end());
      if (are_apart(local)) {
        put(fans, kept, made);
        return true;
      }
      surface_.points.resize(points);
    }
    return false;
  }

 private:
  Vec3 at(VertexIndex v) const { return surface_.points[v]; }
  VertexIndex corner(std::uint32_t c, int next) const {
    return surface_.triangles[c / 3][(c % 3 + static_cast<std::uint32_t>(next)) % 3];
  }

  /// The fan with a polygon around its tip in place of it.
  void add_blunt(VertexIndex v, const Fan& fan, double reach, std::vector<Triangle>& made) {
    std::map<VertexIndex, VertexIndex> next, cut;  // along the rim; on the spoke to a vertex of the rim
    for (const std::uint32_t c : fan) {
      next[corner(c, 1)] = corner(c, 2);
      for (const VertexIndex w : {corner(c, 1), corner(c, 2)}) {
        const auto [place, is_new] = cut.try_emplace(w, static_cast<VertexIndex>(surface_.points.size()));
        if (is_new) surface_.points.push_back(at(v) + (reach / distance(at(v), at(w))) * (at(w) - at(v)));
      }
    }
    for (const auto& [a, b] : next) {
      made.push_back({cut[a], a, b});
      made.push_back({cut[a], b, cut[b]});
    }
    std::vector<VertexIndex> rim;
    std::vector<Vec3> polygon;
    for (VertexIndex w = next.begin()->first; rim.size() < next.size(); w = next[w]) {
      rim.push_back(cut[w]);
      polygon.push_back(at(cut[w]));
    }
    for (const auto& [i, j, k] : triangulate_polygon(polygon, std::vector<Vec3>(polygon.size()),
                                                     [](std::uint32_t, std::uint32_t) { return false; }))
      made.push_back({rim[i], rim[j], rim[k]});
  }

  bool are_apart(const std::vector<Triangle>& local) const {
    std::vector<Vec3> points;
    std::map<VertexIndex, VertexIndex> number;
    std::vector<Triangle> triangles = local;
    for (Triangle& t : triangles)
      for (VertexIndex& v : t) {
        const auto [place, is_new] = number.try_emplace(v, static_cast<VertexIndex>(points.size()));
        if (is_new) points.push_back(at(v));
        v = place->second;
      }
    for (const Triangle& t : triangles)
      if (collinear(points[t[0]], points[t[1]], points[t[2]])) return false;
    return self_intersections(points, triangles, 1).empty();
  }

  /// The triangles made, in the places of those that were there, and behind.
  void put(const std::vector<Fan>& fans, std::size_t kept, const std::vector<Triangle>& made) {
    std::vector<std::uint32_t> places;
    for (std::size_t f = 0; f < fans.size(); ++f)
      if (f != kept)
        for (const std::uint32_t c : fans[f]) places.push_back(c / 3);
    const std::uint32_t like = places.front();
    for (std::size_t i = 0; i < made.size(); ++i) {
      if (i < places.size()) {
        surface_.triangles[places[i]] = made[i];
        continue;
      }
      surface_.triangles.push_back(made[i]);
      if (!surface_.patch.empty()) surface_.patch.push_back(surface_.patch[like]);
      if (!surface_.source.empty()) surface_.source.push_back(surface_.source[like]);
    }
  }

  SurfaceMesh& surface_;
  double most_;
};

class Separation {
 public:
  Separation(SurfaceMesh& surface, double most, const RunContext& context)
      : surface_(surface), most_(most), context_(context) {}

  Separated result() {
    Separated done;
    const SurfaceMesh before = surface_;
    while (halve_contact_edges()) {
    }
    cut_tips(done);
    for (const auto& [v, fans] : Fans(surface_, context_).shared()) make_copies(v, fans);
    find_ways();
    done.done = move_apart();
    if (!done.done) {
      surface_ = before;
      return {{}, {}, false};
    }
    for (const Copy& c : copies_) {
      if (done.places.empty() || done.places.back() != c.from) {
        done.places.push_back(c.from);
        done.moves.push_back(0);
      }
      done.moves.back() = std::max(done.moves.back(), length(c.way) * c.step);
    }
    return done;
  }

 private:
  /// An edge of four triangles may have one fan at either end: only a vertex in its middle can be drawn apart. One edge
  /// of a triangle at a time.
  bool halve_contact_edges() {
    const EdgeTable table = make_edge_table(surface_.points.size(), surface_.triangles, context_);
    std::vector<char> taken(surface_.triangles.size(), 0);
    bool waits = false;
    for (std::size_t e = 0; e < table.size(); ++e) {
      const auto uses = table.uses(e);
      if (uses.size() <= 2 || halved_.contains(table.edges[e])) continue;
      if (std::any_of(uses.begin(), uses.end(), [&](HalfEdge h) { return taken[h / 3]; })) {
        waits = true;
        continue;
      }
      const auto [a, b] = table.edges[e];
      const auto middle = static_cast<VertexIndex>(surface_.points.size());
      surface_.points.push_back(0.5 * (surface_.points[a] + surface_.points[b]));
      for (const HalfEdge h : uses) {
        taken[h / 3] = 1;
        halve(h, middle);
      }
      halved_.insert({a, middle});
      halved_.insert({b, middle});
    }
    return waits;
  }

  void halve(HalfEdge h, VertexIndex middle) {
    const std::uint32_t t = h / 3;
    Triangle other = surface_.triangles[t];
    other[h % 3] = middle;
    surface_.triangles[t][next_of(h) % 3] = middle;
    surface_.triangles.push_back(other);
    if (!surface_.patch.empty()) surface_.patch.push_back(surface_.patch[t]);
    if (!surface_.source.empty()) surface_.source.push_back(surface_.source[t]);
  }

  std::vector<Vec3> normals_of(const Fan& fan) const {
    std::vector<Vec3> normals;
    for (const std::uint32_t c : fan) {
      const auto [i, j, k] = surface_.triangles[c / 3];
      normals.push_back(unit_normal(surface_.points[i], surface_.points[j], surface_.points[k]));
    }
    return normals;
  }

  /// In the mean, the unit vectors into the fan's triangles.
  Vec3 middle_of(const Fan& fan) const {
    Vec3 sum;
    for (const std::uint32_t c : fan) {
      const Triangle& t = surface_.triangles[c / 3];
      const Vec3 p = surface_.points[t[c % 3]], q = surface_.points[t[(c % 3 + 1) % 3]],
                 r = surface_.points[t[(c % 3 + 2) % 3]];
      sum += normalized(0.5 * (q + r) - p);
    }
    return sum / static_cast<double>(fan.size());
  }

  /// Where fewer than all but one fan have a way of their own. Neighbours of what was cut wait for the next round.
  void cut_tips(Separated& done) {
    for (int round = 0; round < kSeparateRounds && cut_some_tips(done); ++round) {
    }
  }

  bool cut_some_tips(Separated& done) {
    TipCutter cutter(surface_, most_);
    std::vector<char> cut_already(surface_.triangles.size(), 0);
    bool any = false;
    for (const auto& [v, fans] : Fans(surface_, context_).shared()) {
      const auto movable = std::count_if(fans.begin(), fans.end(),
                                         [&](const Fan& fan) { return way_of_tip(normals_of(fan), {}) != Vec3{}; });
      if (movable + 1 >= static_cast<std::ptrdiff_t>(fans.size())) continue;
      bool waits = false;
      for (const Fan& fan : fans)
        for (const std::uint32_t c : fan) waits = waits || cut_already[c / 3];
      any = any || waits;
      if (waits || !cutter.cut(v, fans)) continue;
      for (const Fan& fan : fans)
        for (const std::uint32_t c : fan) cut_already[c / 3] = 1;
      any = true;
      done.places.push_back(surface_.points[v]);
      done.moves.push_back(most_);
    }
    return any;
  }

  /// The first fan of a vertex keeps it; all of them move.
  void make_copies(VertexIndex v, const std::vector<Fan>& fans) {
    for (std::size_t f = 0; f < fans.size(); ++f) {
      VertexIndex number = v;
      if (f > 0) {
        number = static_cast<VertexIndex>(surface_.points.size());
        surface_.points.push_back(Vec3(surface_.points[v]));
        for (const std::uint32_t c : fans[f]) surface_.triangles[c / 3][c % 3] = number;
      }
      copies_.push_back({number, surface_.points[number], {}, {}, most_, static_cast<std::uint32_t>(fans.size())});
      fans_.push_back(fans[f]);
    }
  }

  void find_ways() {
    copy_of_.assign(surface_.points.size(), kNone);
    for (std::uint32_t k = 0; k < copies_.size(); ++k) copy_of_[copies_[k].vertex] = k;
    for (std::size_t first = 0; first < copies_.size(); first += copies_[first].of) {
      Vec3 all;
      for (std::size_t k = first; k < first + copies_[first].of; ++k) all += middle_of(fans_[k]);
      for (std::size_t k = first; k < first + copies_[first].of; ++k) {
        const Vec3 away = 2 * middle_of(fans_[k]) - all;
        copies_[k].way = way_of_tip(normals_of(fans_[k]), away);
        // A fan that bends both ways has none that suits all its triangles.
        if (copies_[k].way == Vec3{} && length(away) > 0) copies_[k].way = normalized(away);
        copies_[k].base = copies_[k].way;
        for (const std::uint32_t c : fans_[k])
          for (const VertexIndex w : surface_.triangles[c / 3])
            if (w != copies_[k].vertex)
              copies_[k].step = std::min(copies_[k].step, kStep * distance(copies_[k].from, surface_.points[w]));
      }
    }
  }

  /// The triangles that may meet what moves.
  std::vector<Triangle> concerned() const {
    const TriangleTree tree(surface_);
    std::vector<char> marked(surface_.triangles.size(), 0);
    for (const Triangle& t : surface_.triangles) {
      if (std::none_of(t.begin(), t.end(), [&](VertexIndex v) { return copy_of_[v] != kNone; })) continue;
      Box3 box;
      for (const VertexIndex v : t) box.add(surface_.points[v]);
      tree.for_each_box_near(box.grown(most_), [&](std::uint32_t other, const TriangleCorners&) {
        marked[other] = 1;
        return true;
      });
    }
    std::vector<Triangle> all;
    for (std::size_t t = 0; t < marked.size(); ++t)
      if (marked[t]) all.push_back(surface_.triangles[t]);
    return all;
  }

  /// Whoever still meets something goes less far, and after a while other ways.
  bool move_apart() {
    if (copies_.empty()) return true;
    const std::vector<Triangle> near = concerned();
    Random random(1);
    for (int round = 0; round < kSeparateRounds; ++round) {
      for (const Copy& c : copies_) surface_.points[c.vertex] = c.from + c.step * c.way;
      const auto pairs = self_intersections(surface_.points, near, kMostPairs, context_);
      if (pairs.empty()) return true;
      std::vector<char> meets(copies_.size(), 0);
      for (const auto& pair : pairs)
        for (const std::uint32_t t : pair)
          for (const VertexIndex v : near[t])
            if (copy_of_[v] != kNone) meets[copy_of_[v]] = 1;
      for (std::size_t k = 0; k < copies_.size(); ++k) {
        if (!meets[k]) continue;
        if (round % 3 == 0) copies_[k].step *= 0.5;
        if (round >= 3) copies_[k].way = other_way(copies_[k].base, random);
      }
    }
    return false;
  }

  static Vec3 other_way(Vec3 base, Random& random) {
    const auto part = [&] { return 2 * random.unit() - 1; };
    const Vec3 turned = base + Vec3{part(), part(), part()};
    return length(turned) > 0 ? normalized(turned) : base;
  }

  static constexpr std::size_t kMostPairs = 1u << 20;

  SurfaceMesh& surface_;
  double most_;
  const RunContext& context_;
  std::set<Edge> halved_;               ///< halves of edges of more than two triangles
  std::vector<Copy> copies_;            ///< those of one vertex side by side
  std::vector<Fan> fans_;               ///< of the copies
  std::vector<std::uint32_t> copy_of_;  ///< per vertex
};

}  // namespace

Separated separate_contacts(SurfaceMesh& surface, double most, const RunContext& context) {
  if (is_closed_manifold(surface.triangles, surface.points.size())) return {};
  return Separation(surface, most, context).result();
}

}  // namespace octafront::mend
