#include "cad/shapes/collapse.h"

#include "base/geometry/measures.h"
#include "cad/shapes/groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace octafront::cad {

namespace {

/// Faces that look away from each other more than this (the cosine of their normals' angle) bound a thin solid, or a
/// gap; they stay apart.
constexpr double kLookAway = -0.5;
/// Faces are parallel on both sides of a step: the cosine.
constexpr double kParallel = 0.985;
/// So often is the whole done again at most; it ends long before, when nothing changes.
constexpr int kRounds = 10;
/// Faces that would not vanish as a whole are left out, and all is done again: so often at most, then nothing is done.
constexpr int kRuns = 4;

using Segment = std::array<VertexIndex, 2>;  ///< ascending

Segment segment(VertexIndex a, VertexIndex b) {
  return {std::min(a, b), std::max(a, b)};
}

bool has(const Triangle& t, VertexIndex v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

class Collapse {
 public:
  Collapse(CadModel& model, double tiny, std::vector<bool> is_narrow, const std::vector<bool>& is_spared)
      : model_(model), tiny_(tiny), to_(model.points.size()), is_narrow_(std::move(is_narrow)) {
    std::iota(to_.begin(), to_.end(), VertexIndex{0});
    at_tiny_.assign(model.points.size(), 0);
    for (std::size_t e = 0; e < model.edges.size(); ++e) lay_out(model.edges[e], is_spared);
    is_live_.assign(model.triangles.size(), 1);
    around_.resize(model.points.size()), origins_.resize(model.points.size()), rank_.resize(model.points.size(), 0);
    for (std::uint32_t t = 0; t < model.triangles.size(); ++t) {
      const Triangle& corners = model.triangles[t];
      normal_.push_back(side_of_solid(t) * unit_normal_of(corners));
      for (const VertexIndex v : corners) {
        around_[v].push_back(t);
        if (!is_narrow_[face(t)]) rank_[v] = std::max(rank_[v], model.faces[face(t)].area);
      }
    }
  }

  Collapsed run() {
    Collapsed made;
    const std::vector<char> had = faces_with_triangles();
    for (int round = 0; round < kRounds && (collapse_edges(false) + collapse_edges(true) + turn_caps()) > 0; ++round) {
    }
    for (const CadEdge& edge : model_.edges)
      made.edges += edge.length < tiny_ && last_of(edge.vertices.front()) == last_of(edge.vertices.back()) &&
                    edge.vertices.front() != edge.vertices.back();
    take_triangles();
    take_edges();
    const std::vector<char> has_now = faces_with_triangles();
    for (std::uint32_t f = 0; f < had.size(); ++f)
      if (had[f] && !has_now[f]) made.faces.push_back(f);
    return made;
  }

 private:
  struct Split {
    Segment of;
    VertexIndex by;
  };

  std::uint32_t face(std::uint32_t t) const { return model_.face_of[t]; }
  Vec3 unit_normal_of(const Triangle& t) const {
    return unit_normal(model_.points[t[0]], model_.points[t[1]], model_.points[t[2]]);
  }
  /// Normals of triangles look out of the solid behind them, else of the one in front.
  double side_of_solid(std::uint32_t t) const { return model_.faces[face(t)].sides[1] != kNone ? 1 : -1; }

  void lay_out(const CadEdge& edge, const std::vector<bool>& is_spared) {
    const bool stays = std::any_of(edge.faces.begin(), edge.faces.end(), [&](std::uint32_t f) { return is_spared[f]; });
    const bool is_tiny = !stays && edge.length < tiny_ && edge.vertices.front() != edge.vertices.back();
    for (std::size_t k = 0; is_tiny && k < edge.vertices.size(); ++k) at_tiny_[edge.vertices[k]] = 1;
    for (std::size_t k = 0; k + 1 < edge.vertices.size(); ++k)
      (is_tiny ? tiny_segments_ : long_segments_).insert(segment(edge.vertices[k], edge.vertices[k + 1]));
  }

  std::vector<char> faces_with_triangles() const {
    std::vector<char> with(model_.faces.size(), 0);
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) with[model_.face_of[t]] |= is_live_[t];
    return with;
  }

  VertexIndex last_of(VertexIndex v) const {
    while (to_[v] != v) v = to_[v];
    return v;
  }

  /// Short edges across narrow faces, and those of tiny edges, the shortest first.
  std::vector<Segment> candidates() const {
    std::set<std::pair<double, Segment>> found;
    for (std::uint32_t t = 0; t < model_.triangles.size(); ++t) {
      if (!is_live_[t]) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Segment s = segment(model_.triangles[t][k], model_.triangles[t][(k + 1) % 3]);
        const bool crosses = is_narrow_[face(t)] && !long_segments_.contains(s);
        if (!crosses && !(at_tiny_[s[0]] && at_tiny_[s[1]] && tiny_segments_.contains(s))) continue;
        if (const double l = distance(model_.points[s[0]], model_.points[s[1]]); l < tiny_) found.insert({l, s});
      }
    }
    std::vector<Segment> in_order;
    for (const auto& [length, s] : found) in_order.push_back(s);
    return in_order;
  }

  /// Onto the larger of the faces; with `either_way` onto the other where that cannot be.
  std::size_t collapse_edges(bool either_way) {
    std::size_t done = 0;
    for (const auto& [a, b] : candidates()) {
      if (to_[a] != a || to_[b] != b) continue;
      const bool keeps_b = rank_[b] >= rank_[a];
      const auto [gone, kept] = keeps_b ? std::pair(a, b) : std::pair(b, a);
      done += collapse(gone, kept) || (either_way && collapse(kept, gone));
    }
    return done;
  }

  bool collapse(VertexIndex gone, VertexIndex kept) {
    if (!stays_near(gone, kept) || !keeps_topology(gone, kept) || !turns_little(gone, kept) || closes(gone, kept))
      return false;
    for (const std::uint32_t t : around_[gone]) {
      Triangle& corners = model_.triangles[t];
      if (has(corners, kept)) {
        is_live_[t] = 0;
        for (const VertexIndex v : corners)
          if (v != gone) std::erase(around_[v], t);
        continue;
      }
      std::replace(corners.begin(), corners.end(), gone, kept);
      around_[kept].push_back(t);
    }
    around_[gone].clear();
    rename_segments(gone, kept);
    to_[gone] = kept;
    rank_[kept] = std::max(rank_[kept], rank_[gone]);
    at_tiny_[kept] |= at_tiny_[gone];
    origins_[kept].push_back(model_.points[gone]);
    origins_[kept].insert(origins_[kept].end(), origins_[gone].begin(), origins_[gone].end());
    return true;
  }

  /// Segments of edges that end in a vertex, as it is called now.
  void rename_segments(VertexIndex gone, VertexIndex kept) {
    for (const std::uint32_t t : around_[kept])
      for (const VertexIndex v : model_.triangles[t])
        for (std::set<Segment>* all : {&tiny_segments_, &long_segments_})
          if (v != kept && all->erase(segment(gone, v)) > 0) all->insert(segment(kept, v));
  }

  bool stays_near(VertexIndex gone, VertexIndex kept) const {
    const Vec3 p = model_.points[kept];
    const auto is_near = [&](Vec3 q) { return distance(p, q) < tiny_; };
    return is_near(model_.points[gone]) && std::all_of(origins_[gone].begin(), origins_[gone].end(), is_near);
  }

  /// No vertex but those of the triangles at the edge is beside both of its ends.
  bool keeps_topology(VertexIndex a, VertexIndex b) const {
    std::set<VertexIndex> beside_a, opposite;
    for (const std::uint32_t t : around_[a]) {
      const bool at_edge = has(model_.triangles[t], b);
      for (const VertexIndex v : model_.triangles[t])
        if (v != a && v != b) beside_a.insert(v), at_edge ? void(opposite.insert(v)) : void();
    }
    std::set<VertexIndex> of_both;
    for (const std::uint32_t t : around_[b])
      for (const VertexIndex v : model_.triangles[t])
        if (v != a && v != b && beside_a.contains(v)) of_both.insert(v);
    return of_both == opposite && !opposite.empty();
  }

  bool turns_little(VertexIndex gone, VertexIndex kept) const {
    return std::all_of(around_[gone].begin(), around_[gone].end(), [&](std::uint32_t t) {
      Triangle corners = model_.triangles[t];
      if (is_narrow_[face(t)] || has(corners, kept)) return true;
      std::replace(corners.begin(), corners.end(), gone, kept);
      return dot(normal_[t], side_of_solid(t) * unit_normal_of(corners)) > 0;
    });
  }

  /// Are there wide faces on both sides that look away from each other?
  bool closes(VertexIndex a, VertexIndex b) const {
    const auto only_at = [&](VertexIndex one, VertexIndex other) {
      std::vector<std::uint32_t> found;
      for (const std::uint32_t t : around_[one])
        if (!is_narrow_[face(t)] && !has(model_.triangles[t], other)) found.push_back(t);
      return found;
    };
    const std::vector<std::uint32_t> at_a = only_at(a, b), at_b = only_at(b, a);
    return std::any_of(at_a.begin(), at_a.end(), [&](std::uint32_t t) {
      return std::any_of(at_b.begin(), at_b.end(), [&](std::uint32_t u) {
        return face(t) != face(u) && dot(normal_[t], normal_[u]) < kLookAway;
      });
    });
  }

  /// Narrow triangles with a corner on the edge opposite to it: the triangle beyond takes the corner.
  std::size_t turn_caps() {
    std::size_t done = 0;
    for (std::uint32_t t = 0; t < model_.triangles.size(); ++t)
      if (is_live_[t] && is_narrow_[face(t)]) done += turn_cap(t);
    return done;
  }

  bool turn_cap(std::uint32_t t) {
    const Triangle c = model_.triangles[t];
    std::size_t k = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (edge_length(c, i) > edge_length(c, k)) k = i;
    const VertexIndex a = c[k], b = c[(k + 1) % 3], apex = c[(k + 2) % 3];
    const Vec3 along = model_.points[b] - model_.points[a], to_apex = model_.points[apex] - model_.points[a];
    const double l = dot(along, along), part = l > 0 ? dot(to_apex, along) / l : 0;
    if (!(part > 0 && part < 1) || !(length(to_apex - part * along) < tiny_)) return false;
    const std::uint32_t u = beyond(t, a, b);
    return u != kNone && !looks_away(apex, u) && split(t, u, {a, b, apex}, part);
  }

  /// Is there a wide face at a vertex that looks away from a triangle?
  bool looks_away(VertexIndex v, std::uint32_t u) const {
    return std::any_of(around_[v].begin(), around_[v].end(), [&](std::uint32_t t) {
      return !is_narrow_[face(t)] && dot(normal_[t], normal_[u]) < kLookAway;
    });
  }

  double edge_length(const Triangle& t, std::size_t k) const {
    return distance(model_.points[t[k]], model_.points[t[(k + 1) % 3]]);
  }

  /// The other triangle at an edge; kNone unless there is just one, of another face.
  std::uint32_t beyond(std::uint32_t t, VertexIndex a, VertexIndex b) const {
    std::uint32_t found = kNone;
    for (const std::uint32_t u : around_[a]) {
      if (u == t || !has(model_.triangles[u], b)) continue;
      if (found != kNone) return kNone;
      found = u;
    }
    return found != kNone && face(found) != face(t) ? found : kNone;
  }

  /// Triangle u takes the apex of t into its edge from cap[0] to cap[1], and t goes.
  bool split(std::uint32_t t, std::uint32_t u, const Triangle& cap, double part) {
    const auto [a, b, apex] = cap;
    const Triangle old = model_.triangles[u];
    if (has(old, apex)) return false;
    Triangle at_a = old, at_b = old;
    std::replace(at_a.begin(), at_a.end(), b, apex), std::replace(at_b.begin(), at_b.end(), a, apex);
    for (const Triangle& made : {at_a, at_b})
      if (!is_narrow_[face(u)] && !(dot(unit_normal_of(old), unit_normal_of(made)) > 0)) return false;
    const std::size_t i = std::find(old.begin(), old.end(), a) - old.begin(),
                      j = std::find(old.begin(), old.end(), b) - old.begin();
    std::array<Uv, 3> uv_a = model_.corners[u], uv_b = uv_a;
    const Uv middle{uv_a[i].u + part * (uv_a[j].u - uv_a[i].u), uv_a[i].v + part * (uv_a[j].v - uv_a[i].v)};
    uv_a[j] = uv_b[i] = middle;
    for (const VertexIndex v : cap) std::erase(around_[v], t);
    model_.triangles[u] = at_a, model_.corners[u] = uv_a;
    model_.triangles[t] = at_b, model_.corners[t] = uv_b, model_.face_of[t] = face(u), normal_[t] = normal_[u];
    std::erase(around_[b], u);
    around_[apex].push_back(u);
    for (const VertexIndex v : at_b) around_[v].push_back(t);
    splits_.push_back({segment(a, b), apex});
    long_segments_.erase(segment(a, b));
    return true;
  }

  void take_triangles() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
      if (!is_live_[t]) continue;
      model_.triangles[kept] = model_.triangles[t], model_.corners[kept] = model_.corners[t];
      model_.face_of[kept] = model_.face_of[t], normal_[kept] = normal_[t];
      ++kept;
    }
    model_.triangles.resize(kept), model_.corners.resize(kept), model_.face_of.resize(kept), normal_.resize(kept);
    is_live_.assign(kept, 1);
  }

  bool is_touched(const CadEdge& edge) const {
    return std::any_of(edge.vertices.begin(), edge.vertices.end(),
                       [&](VertexIndex v) { return to_[v] != v || !origins_[v].empty(); }) ||
           std::any_of(edge.faces.begin(), edge.faces.end(), [&](std::uint32_t f) { return bool(is_narrow_[f]); });
  }

  /// An edge with its vertices as they are called now, and those that were put into it.
  void follow(CadEdge& edge) const {
    std::vector<VertexIndex> vertices;
    std::vector<double> parameters;
    for (std::size_t k = 0; k < edge.vertices.size(); ++k) {
      const VertexIndex v = last_of(edge.vertices[k]);
      if (!vertices.empty() && vertices.back() == v) continue;
      vertices.push_back(v), parameters.push_back(edge.parameters[k]);
    }
    std::set<Segment> divided;  // each once: later collapses can make one of two parts what the whole was
    for (std::size_t k = 0; k + 1 < vertices.size();) {
      const Segment whole = segment(vertices[k], vertices[k + 1]);
      const auto found = split_of_.find(whole);
      if (found == split_of_.end() || !divided.insert(whole).second) {
        ++k;
        continue;
      }
      const auto at = static_cast<std::ptrdiff_t>(k) + 1;
      parameters.insert(parameters.begin() + at, (parameters[k] + parameters[k + 1]) / 2);
      vertices.insert(vertices.begin() + at, found->second);
    }
    edge.vertices = std::move(vertices), edge.parameters = std::move(parameters);
  }

  /// Who is named by an edge and by how much of it stayed where it was: of two edges that became one the better stays.
  double weight_of(const CadEdge& before) const {
    double kept = 0;
    for (const VertexIndex v : before.vertices) kept += to_[v] == v;
    return kept / static_cast<double>(before.vertices.size());
  }

  void take_edges() {
    for (const Split& s : splits_) {
      const Segment of = segment(last_of(s.of[0]), last_of(s.of[1]));
      if (of[0] != of[1] && last_of(s.by) != of[0] && last_of(s.by) != of[1]) split_of_.emplace(of, last_of(s.by));
    }
    std::map<Segment, std::vector<std::uint32_t>> at;  // triangles at the segments of edges that changed
    std::vector<std::pair<double, CadEdge>> changed;
    std::vector<CadEdge> edges;
    for (CadEdge& edge : model_.edges) {
      if (!is_touched(edge)) {
        edges.push_back(std::move(edge));
        continue;
      }
      const double weight = weight_of(edge);
      follow(edge);
      for (std::size_t k = 0; k + 1 < edge.vertices.size(); ++k) at[segment(edge.vertices[k], edge.vertices[k + 1])];
      if (edge.vertices.size() > 1) changed.emplace_back(weight, std::move(edge));
    }
    for (std::uint32_t t = 0; t < model_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (const auto found = at.find(segment(model_.triangles[t][k], model_.triangles[t][(k + 1) % 3]));
            found != at.end())
          found->second.push_back(t);
    std::stable_sort(changed.begin(), changed.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::set<Segment> taken;
    for (auto& [weight, edge] : changed)
      if (is_new(edge, taken) && meets(edge, at)) edges.push_back(std::move(edge));
    model_.edges = std::move(edges);
    for (VertexIndex& v : model_.vertices) v = last_of(v);
  }

  static bool is_new(const CadEdge& edge, std::set<Segment>& taken) {
    bool any = false;
    for (std::size_t k = 0; k + 1 < edge.vertices.size(); ++k)
      any |= taken.insert(segment(edge.vertices[k], edge.vertices[k + 1])).second;
    return any;
  }

  /// Takes the faces that meet in it, and whether they are parallel; false if there are none.
  bool meets(CadEdge& edge, const std::map<Segment, std::vector<std::uint32_t>>& at) const {
    std::set<std::uint32_t> faces;
    bool is_parallel = true;
    for (std::size_t k = 0; k + 1 < edge.vertices.size(); ++k) {
      const std::vector<std::uint32_t>& here = at.at(segment(edge.vertices[k], edge.vertices[k + 1]));
      for (const std::uint32_t t : here) {
        faces.insert(face(t));
        is_parallel &= dot(normal_[t], normal_[here.front()]) > kParallel;
      }
    }
    const std::vector<std::uint32_t> now(faces.begin(), faces.end());
    std::vector<std::uint32_t> before = edge.faces;
    std::sort(before.begin(), before.end());
    if (now != before) edge.is_smooth = is_parallel && now.size() == 2, edge.is_seam = false;
    edge.faces = now;
    return !now.empty();
  }

  CadModel& model_;
  double tiny_;
  std::vector<VertexIndex> to_;  ///< where a vertex went; itself: it stayed
  std::vector<bool> is_narrow_;  ///< per face
  std::vector<char> is_live_;    ///< per triangle
  std::vector<char> at_tiny_;    ///< per vertex: of a tiny edge
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<std::vector<Vec3>> origins_;  ///< per vertex: where those came from that went to it
  std::vector<double> rank_;                ///< per vertex: the area of the largest wide face at it
  std::vector<Vec3> normal_;                ///< per triangle: out of the solid, of length 1, as it was
  std::set<Segment> tiny_segments_, long_segments_;
  std::vector<Split> splits_;
  std::map<Segment, VertexIndex> split_of_;
};

}  // namespace

Collapsed collapse_tiny(CadModel& model, double tiny, std::span<const std::uint32_t> spared) {
  std::vector<bool> is_narrow, is_spared(model.faces.size(), false);
  for (const double w : mean_widths(model)) is_narrow.push_back(w < tiny);
  for (const std::uint32_t f : spared) is_narrow[f] = false, is_spared[f] = true;
  const auto is_tiny = [&](const CadEdge& edge) { return edge.length < tiny; };
  if (std::find(is_narrow.begin(), is_narrow.end(), true) == is_narrow.end() &&
      std::none_of(model.edges.begin(), model.edges.end(), is_tiny))
    return {};
  for (int run = 0; run < kRuns; ++run) {
    CadModel made = model;
    const Collapsed collapsed = Collapse(made, tiny, is_narrow, is_spared).run();
    bool is_done = true;
    for (const std::uint32_t f : made.face_of)
      if (is_narrow[f]) is_narrow[f] = is_done = false;
    if (!is_done) continue;
    model = std::move(made);
    return collapsed;
  }
  return {};
}

}  // namespace octafront::cad
