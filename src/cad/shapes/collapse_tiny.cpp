#include "cad/shapes/collapse_tiny.h"

#include "base/geometry/measures.h"
#include "cad/shapes/face_groups.h"

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
/// Narrow parts of wide faces begin where lines meet; a solid that is a wedge of more than 14 degrees there may end a
/// little earlier.
constexpr double kBackToBack = -0.97;
/// Faces are parallel on both sides of a step: the cosine.
constexpr double kParallel = 0.985;
/// Triangles of wide faces whose lines run together at less than this (the tangent, 15 degrees) are a narrow part of
/// them.
constexpr double kFlat = 0.27;
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

/// What goes: tiny edges and narrow faces, or parts of wide faces.
enum class Goes { kWhole, kParts };

struct SegmentSplit {
  Segment of;
  VertexIndex by;
};

/// What became of vertices, faces and triangles.
struct Collapsing {
  std::vector<VertexIndex> to;             ///< where a vertex went; itself: it stayed
  std::vector<std::vector<Vec3>> origins;  ///< per vertex: where those came from that went to it
  std::vector<bool> is_narrow;             ///< per face
  std::vector<bool> is_narrowed;           ///< per face: lost triangles
  std::vector<Vec3> normal;                ///< per triangle: out of the solid, of length 1, as it was
  std::vector<SegmentSplit> splits;

  VertexIndex last_of(VertexIndex v) const {
    while (to[v] != v) v = to[v];
    return v;
  }
};

/// The edges of a model taken along with a change of its triangles.
class EdgesAfter {
 public:
  EdgesAfter(CadModel& model, const Collapsing& change) : model_(model), change_(change) {}

  void run() {
    for (const SegmentSplit& s : change_.splits) {
      const Segment of = segment(change_.last_of(s.of[0]), change_.last_of(s.of[1]));
      if (of[0] != of[1] && change_.last_of(s.by) != of[0] && change_.last_of(s.by) != of[1])
        split_of_.emplace(of, change_.last_of(s.by));
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
    for (VertexIndex& v : model_.vertices) v = change_.last_of(v);
  }

 private:
  bool is_touched(const CadEdge& edge) const {
    return std::any_of(edge.vertices.begin(), edge.vertices.end(),
                       [&](VertexIndex v) { return change_.to[v] != v || !change_.origins[v].empty(); }) ||
           std::any_of(edge.faces.begin(), edge.faces.end(),
                       [&](std::uint32_t f) { return change_.is_narrow[f] || change_.is_narrowed[f]; });
  }

  /// An edge with its vertices as they are called now, and those that were put into it.
  void follow(CadEdge& edge) const {
    std::vector<VertexIndex> vertices;
    std::vector<double> parameters;
    for (std::size_t k = 0; k < edge.vertices.size(); ++k) {
      const VertexIndex v = change_.last_of(edge.vertices[k]);
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
    for (const VertexIndex v : before.vertices) kept += change_.to[v] == v;
    return kept / static_cast<double>(before.vertices.size());
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
        faces.insert(model_.face_of[t]);
        is_parallel &= dot(change_.normal[t], change_.normal[here.front()]) > kParallel;
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
  const Collapsing& change_;
  std::map<Segment, VertexIndex> split_of_;
};

class Collapse {
 public:
  Collapse(CadModel& model, double tiny, Goes goes, std::vector<bool> is_narrow, const std::vector<bool>& is_spared)
      : model_(model),
        tiny_(tiny),
        goes_(goes),
        change_{std::vector<VertexIndex>(model.points.size()),
                std::vector<std::vector<Vec3>>(model.points.size()),
                std::move(is_narrow),
                std::vector<bool>(model.faces.size(), false),
                {},
                {}} {
    std::iota(change_.to.begin(), change_.to.end(), VertexIndex{0});
    at_tiny_.assign(model.points.size(), 0);
    on_line_.assign(model.points.size(), 0);
    for (std::size_t e = 0; e < model.edges.size(); ++e) lay_out(model.edges[e], is_spared);
    is_live_.assign(model.triangles.size(), 1);
    around_.resize(model.points.size()), rank_.resize(model.points.size(), 0);
    for (std::uint32_t t = 0; t < model.triangles.size(); ++t) {
      const Triangle& corners = model.triangles[t];
      change_.normal.push_back(side_of_solid(t) * unit_normal_of(corners));
      for (const VertexIndex v : corners) {
        around_[v].push_back(t);
        if (!change_.is_narrow[face(t)]) rank_[v] = std::max(rank_[v], model.faces[face(t)].area);
      }
    }
  }

  Collapsed run() {
    Collapsed made;
    const std::vector<char> had = faces_with_triangles();
    for (int round = 0; round < kRounds && (collapse_edges(false) + collapse_edges(true) + turn_caps()) > 0; ++round) {
    }
    for (const CadEdge& edge : model_.edges)
      made.edges += goes_ == Goes::kWhole && edge.length < tiny_ &&
                    change_.last_of(edge.vertices.front()) == change_.last_of(edge.vertices.back()) &&
                    edge.vertices.front() != edge.vertices.back();
    take_triangles();
    EdgesAfter(model_, change_).run();
    const std::vector<char> has_now = faces_with_triangles();
    for (std::uint32_t f = 0; f < had.size(); ++f)
      if (had[f] && !has_now[f])
        made.faces.push_back(f);
      else if (goes_ == Goes::kParts && change_.is_narrowed[f])
        made.narrowed.push_back(f);
    return made;
  }

 private:
  std::uint32_t face(std::uint32_t t) const { return model_.face_of[t]; }
  Vec3 unit_normal_of(const Triangle& t) const {
    return unit_normal(model_.points[t[0]], model_.points[t[1]], model_.points[t[2]]);
  }
  /// Normals of triangles look out of the solid behind them, else of the one in front.
  double side_of_solid(std::uint32_t t) const { return model_.faces[face(t)].sides[1] != kNone ? 1 : -1; }

  void lay_out(const CadEdge& edge, const std::vector<bool>& is_spared) {
    const bool stays = std::any_of(edge.faces.begin(), edge.faces.end(), [&](std::uint32_t f) { return is_spared[f]; });
    const bool is_tiny =
        goes_ == Goes::kWhole && !stays && edge.length < tiny_ && edge.vertices.front() != edge.vertices.back();
    for (const VertexIndex v : edge.vertices) {
      if (is_tiny) at_tiny_[v] = 1;
      if (on_line_[v] != kSpared) on_line_[v] = stays ? kSpared : 1;
    }
    for (std::size_t k = 0; k + 1 < edge.vertices.size(); ++k)
      (is_tiny ? tiny_segments_ : long_segments_).insert(segment(edge.vertices[k], edge.vertices[k + 1]));
  }

  std::vector<char> faces_with_triangles() const {
    std::vector<char> with(model_.faces.size(), 0);
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) with[model_.face_of[t]] |= is_live_[t];
    return with;
  }

  /// Short edges across narrow faces, and those of tiny edges, the shortest first.
  std::vector<Segment> candidates() const {
    std::set<std::pair<double, Segment>> found;
    for (std::uint32_t t = 0; t < model_.triangles.size(); ++t) {
      if (!is_live_[t]) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Segment s = segment(model_.triangles[t][k], model_.triangles[t][(k + 1) % 3]);
        const bool crosses =
            !long_segments_.contains(s) && (change_.is_narrow[face(t)] || crosses_wedge(model_.triangles[t], k));
        if (!crosses && !(at_tiny_[s[0]] && at_tiny_[s[1]] && tiny_segments_.contains(s))) continue;
        if (const double l = distance(model_.points[s[0]], model_.points[s[1]]); l < tiny_) found.insert({l, s});
      }
    }
    std::vector<Segment> in_order;
    for (const auto& [length, s] : found) in_order.push_back(s);
    return in_order;
  }

  /// Whether edge k of a triangle joins two lines that run together there, and it is the short one.
  bool crosses_wedge(const Triangle& t, std::size_t k) const {
    const VertexIndex a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
    if (goes_ != Goes::kParts || on_line_[a] != 1 || on_line_[b] != 1) return false;
    if (!long_segments_.contains(segment(a, c)) && !long_segments_.contains(segment(b, c))) return false;
    const Vec3 to_a = model_.points[a] - model_.points[c], to_b = model_.points[b] - model_.points[c];
    return length(cross(to_a, to_b)) < kFlat * dot(to_a, to_b);
  }

  /// Onto the larger of the faces; with `either_way` onto the other where that cannot be.
  std::size_t collapse_edges(bool either_way) {
    std::size_t done = 0;
    for (const auto& [a, b] : candidates()) {
      if (change_.to[a] != a || change_.to[b] != b) continue;
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
        change_.is_narrowed[face(t)] = true;
        for (const VertexIndex v : corners)
          if (v != gone) std::erase(around_[v], t);
        continue;
      }
      std::replace(corners.begin(), corners.end(), gone, kept);
      around_[kept].push_back(t);
    }
    around_[gone].clear();
    rename_segments(gone, kept);
    change_.to[gone] = kept;
    rank_[kept] = std::max(rank_[kept], rank_[gone]);
    at_tiny_[kept] |= at_tiny_[gone];
    change_.origins[kept].push_back(model_.points[gone]);
    change_.origins[kept].insert(change_.origins[kept].end(), change_.origins[gone].begin(),
                                 change_.origins[gone].end());
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
    return is_near(model_.points[gone]) &&
           std::all_of(change_.origins[gone].begin(), change_.origins[gone].end(), is_near);
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
      if (change_.is_narrow[face(t)] || has(corners, kept)) return true;
      std::replace(corners.begin(), corners.end(), gone, kept);
      return dot(change_.normal[t], side_of_solid(t) * unit_normal_of(corners)) > 0;
    });
  }

  /// Are there wide faces on both sides that look away from each other?
  bool closes(VertexIndex a, VertexIndex b) const {
    const double limit = is_in_narrow_face(a, b) ? kLookAway : kBackToBack;
    const auto only_at = [&](VertexIndex one, VertexIndex other) {
      std::vector<std::uint32_t> found;
      for (const std::uint32_t t : around_[one])
        if (!change_.is_narrow[face(t)] && !has(model_.triangles[t], other)) found.push_back(t);
      return found;
    };
    const std::vector<std::uint32_t> at_a = only_at(a, b), at_b = only_at(b, a);
    return std::any_of(at_a.begin(), at_a.end(), [&](std::uint32_t t) {
      return std::any_of(at_b.begin(), at_b.end(),
                         [&](std::uint32_t u) { return face(t) != face(u) && look_away(t, u, limit); });
    });
  }

  bool is_in_narrow_face(VertexIndex a, VertexIndex b) const {
    return std::any_of(around_[a].begin(), around_[a].end(),
                       [&](std::uint32_t t) { return change_.is_narrow[face(t)] && has(model_.triangles[t], b); });
  }

  bool is_loose(std::uint32_t t) const { return model_.faces[face(t)].sides == Sides{kNone, kNone}; }

  /// From each other, as seen from a solid, or the outside, that both bound.
  bool look_away(std::uint32_t t, std::uint32_t u, double limit) const {
    // Without solids nobody knows which side is out; beside solids what is loose is left out.
    if (is_loose(t) || is_loose(u))
      return model_.solids.empty() && std::abs(dot(change_.normal[t], change_.normal[u])) > -limit;
    const double turned = side_of_solid(t) * side_of_solid(u) * dot(change_.normal[t], change_.normal[u]);
    const Sides &of_t = model_.faces[face(t)].sides, &of_u = model_.faces[face(u)].sides;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t k = 0; k < 2; ++k)
        if (of_t[i] == of_u[k] && (i == k ? turned : -turned) < limit) return true;
    return false;
  }

  /// Narrow triangles with a corner on the edge opposite to it: the triangle beyond takes the corner.
  std::size_t turn_caps() {
    std::size_t done = 0;
    for (std::uint32_t t = 0; t < model_.triangles.size(); ++t)
      if (is_live_[t] && (change_.is_narrow[face(t)] || is_between_lines(model_.triangles[t]))) done += turn_cap(t);
    return done;
  }

  bool is_between_lines(const Triangle& t) const {
    return goes_ == Goes::kParts && std::all_of(t.begin(), t.end(), [&](VertexIndex v) { return on_line_[v] == 1; });
  }

  bool turn_cap(std::uint32_t t) {
    const Triangle c = model_.triangles[t];
    std::size_t k = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (edge_length(c, i) > edge_length(c, k)) k = i;
    const VertexIndex a = c[k], b = c[(k + 1) % 3], apex = c[(k + 2) % 3];
    const Vec3 along = model_.points[b] - model_.points[a], to_apex = model_.points[apex] - model_.points[a];
    const double l = dot(along, along), part = l > 0 ? dot(to_apex, along) / l : 0;
    const double height = length(to_apex - part * along);
    if (!(part > 0 && part < 1) || !(height < tiny_)) return false;
    if (!change_.is_narrow[face(t)]) {
      if (!long_segments_.contains(segment(a, b))) return false;
      if (!(height < kFlat * std::min(part, 1 - part) * std::sqrt(l))) return false;
    }
    const double limit = change_.is_narrow[face(t)] ? kLookAway : kBackToBack;
    const std::vector<std::uint32_t> others = beyond(t, a, b);
    const auto is_fit = [&](std::uint32_t u) { return !looks_away(apex, u, limit) && can_split(u, {a, b, apex}); };
    if (others.empty() || !std::all_of(others.begin(), others.end(), is_fit)) return false;
    take_cap(t, others, {a, b, apex}, part);
    return true;
  }

  /// Is there a wide face at a vertex that looks away from a triangle?
  bool looks_away(VertexIndex v, std::uint32_t u, double limit) const {
    return std::any_of(around_[v].begin(), around_[v].end(),
                       [&](std::uint32_t t) { return !change_.is_narrow[face(t)] && look_away(t, u, limit); });
  }

  double edge_length(const Triangle& t, std::size_t k) const {
    return distance(model_.points[t[k]], model_.points[t[(k + 1) % 3]]);
  }

  /// The other triangles at an edge; none if one is of the same face.
  std::vector<std::uint32_t> beyond(std::uint32_t t, VertexIndex a, VertexIndex b) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t u : around_[a]) {
      if (u == t || !has(model_.triangles[u], b)) continue;
      if (face(u) == face(t)) return {};
      found.push_back(u);
    }
    return found;
  }

  /// Whether triangle u may take the apex of a cap into its edge from cap[0] to cap[1].
  bool can_split(std::uint32_t u, const Triangle& cap) const {
    const auto [a, b, apex] = cap;
    const Triangle& old = model_.triangles[u];
    if (has(old, apex)) return false;
    Triangle at_a = old, at_b = old;
    std::replace(at_a.begin(), at_a.end(), b, apex), std::replace(at_b.begin(), at_b.end(), a, apex);
    return change_.is_narrow[face(u)] ||
           (dot(unit_normal_of(old), unit_normal_of(at_a)) > 0 && dot(unit_normal_of(old), unit_normal_of(at_b)) > 0);
  }

  /// The triangles beyond the cap t take its apex, and t goes.
  void take_cap(std::uint32_t t, const std::vector<std::uint32_t>& others, const Triangle& cap, double part) {
    for (const VertexIndex v : cap) std::erase(around_[v], t);
    const bool is_part = !change_.is_narrow[face(t)];
    change_.is_narrowed[face(t)] = true;
    std::uint32_t free = t;
    for (const std::uint32_t u : others) {
      split(u, free, cap, part);
      free = static_cast<std::uint32_t>(model_.triangles.size());
    }
    change_.splits.push_back({segment(cap[0], cap[1]), cap[2]});
    long_segments_.erase(segment(cap[0], cap[1]));
    for (const VertexIndex v : {cap[0], cap[1]})
      if (is_part) long_segments_.insert(segment(v, cap[2]));
  }

  /// The half of triangle u at cap[1] becomes triangle `made`, which may be a new one.
  void split(std::uint32_t u, std::uint32_t made, const Triangle& cap, double part) {
    const auto [a, b, apex] = cap;
    const Triangle old = model_.triangles[u];
    Triangle at_a = old, at_b = old;
    std::replace(at_a.begin(), at_a.end(), b, apex), std::replace(at_b.begin(), at_b.end(), a, apex);
    const std::size_t i = std::find(old.begin(), old.end(), a) - old.begin(),
                      j = std::find(old.begin(), old.end(), b) - old.begin();
    std::array<Uv, 3> uv_a = model_.corners[u], uv_b = uv_a;
    const Uv middle{uv_a[i].u + part * (uv_a[j].u - uv_a[i].u), uv_a[i].v + part * (uv_a[j].v - uv_a[i].v)};
    uv_a[j] = uv_b[i] = middle;
    if (made == model_.triangles.size()) {
      model_.triangles.emplace_back(), model_.corners.emplace_back(), model_.face_of.emplace_back();
      change_.normal.emplace_back(), is_live_.push_back(1);
    }
    model_.triangles[u] = at_a, model_.corners[u] = uv_a;
    model_.triangles[made] = at_b, model_.corners[made] = uv_b, model_.face_of[made] = face(u);
    change_.normal[made] = change_.normal[u];
    std::erase(around_[b], u);
    around_[apex].push_back(u);
    for (const VertexIndex v : at_b) around_[v].push_back(made);
  }

  void take_triangles() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < model_.triangles.size(); ++t) {
      if (!is_live_[t]) continue;
      model_.triangles[kept] = model_.triangles[t], model_.corners[kept] = model_.corners[t];
      model_.face_of[kept] = model_.face_of[t], change_.normal[kept] = change_.normal[t];
      ++kept;
    }
    model_.triangles.resize(kept), model_.corners.resize(kept), model_.face_of.resize(kept),
        change_.normal.resize(kept);
    is_live_.assign(kept, 1);
  }

  CadModel& model_;
  double tiny_;
  Goes goes_;
  Collapsing change_;
  std::vector<char> is_live_;  ///< per triangle
  std::vector<char> at_tiny_;  ///< per vertex: of a tiny edge
  static constexpr char kSpared = 2;
  std::vector<char> on_line_;  ///< per vertex: 1: of edges; kSpared: of some that stay
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<double> rank_;  ///< per vertex: the area of the largest wide face at it
  std::set<Segment> tiny_segments_, long_segments_;
};

}  // namespace

Collapsed collapse_tiny(CadModel& model, double tiny, std::span<const std::uint32_t> spared) {
  std::vector<bool> is_narrow, is_spared(model.faces.size(), false);
  for (const double w : mean_widths(model)) is_narrow.push_back(w < tiny);
  const auto is_tiny = [&](const CadEdge& edge) { return edge.length < tiny; };
  for (const std::uint32_t f : spared) is_narrow[f] = false, is_spared[f] = true;
  if (std::find(is_narrow.begin(), is_narrow.end(), true) == is_narrow.end() &&
      std::none_of(model.edges.begin(), model.edges.end(), is_tiny))
    return {};
  for (int run = 0; run < kRuns; ++run) {
    CadModel made = model;
    const Collapsed collapsed = Collapse(made, tiny, Goes::kWhole, is_narrow, is_spared).run();
    bool is_done = true;
    for (const std::uint32_t f : made.face_of)
      if (is_narrow[f]) is_narrow[f] = is_done = false;
    if (!is_done) continue;
    model = std::move(made);
    return collapsed;
  }
  return {};
}

Collapsed end_narrow_parts(CadModel& model, double tiny, std::span<const std::uint32_t> spared) {
  std::vector<bool> is_spared(model.faces.size(), false);
  for (const std::uint32_t f : spared) is_spared[f] = true;
  const std::vector<double> widths = mean_widths(model);
  const std::vector<bool> none_narrow(model.faces.size(), false);
  for (int run = 0; run < kRuns; ++run) {
    CadModel made = model;
    Collapsed collapsed = Collapse(made, tiny, Goes::kParts, none_narrow, is_spared).run();
    bool is_done = true;
    for (const std::uint32_t f : collapsed.faces)
      if (widths[f] >= tiny) is_spared[f] = true, is_done = false;
    if (!is_done) continue;
    model = std::move(made);
    return collapsed;
  }
  return {};
}

}  // namespace octafront::cad
