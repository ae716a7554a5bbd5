#include "base/core/disjoint_sets.h"
#include "base/geometry/hausdorff.h"
#include "base/geometry/measures.h"
#include "base/geometry/self_intersection.h"
#include "base/geometry/triangle_tree.h"
#include "soup/mend/caps.h"
#include "soup/mend/mend_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

namespace octafront::mend {
namespace {

using tidy::Draft;
using Triangles = std::vector<std::uint32_t>;

/// Around what crosses so many rings of triangles are tried, the fewest first.
constexpr int kMostRings = 2;
/// What was laid flat leaves room for what could not be before.
constexpr int kMostPassesOverCrumples = 4;
/// What needs more triangles is no crumple but a surface of its own.
constexpr std::size_t kMostTriangles = 2000;
/// Distances are known to this part of the tolerance.
constexpr double kSureTo = 0.1;
/// Where more pairs cross the arrangement decides alone.
constexpr std::size_t kMostPairs = 1'000'000;

using Pairs = std::vector<std::array<std::uint32_t, 2>>;
using Patch = std::set<std::uint32_t>;

/// Which triangles around a patch come to it: at sharp edges of the body those beyond them must not.
enum class Ring { kAll, kFlat };

struct Crumple {
  Triangles faces;
  std::vector<Triangle> cap;
  double distance = 0;
  std::size_t crossings = 0;  ///< pairs of which one is of its faces
};

class Crumples {
 public:
  Crumples(Draft& draft, double tolerance, Ring ring)
      : draft_(draft),
        tolerance_(tolerance),
        ring_(ring),
        edges_(draft.edges()),
        edge_of_(edges_.edge_of_half_edge()) {}

  LaidFlat run() {
    pairs_ = self_intersections(draft_.mesh.points, triangles(), kMostPairs, draft_.context);
    if (pairs_.size() >= kMostPairs) return {};
    taken_.assign(triangles().size(), 0);
    note_partners();
    for (const Triangles& cluster : clusters()) {
      bool any = false;
      for (const std::uint32_t t : cluster) any = take({t}) || any;
      if (!any) take(cluster);
    }
    while (!found_.empty()) {
      SurfaceMesh mesh = without_crumples();
      if (!drop_those_that_cross_more(mesh)) return replace(std::move(mesh));
    }
    return {};
  }

 private:
  const std::vector<Triangle>& triangles() const { return draft_.mesh.triangles; }
  Vec3 at(VertexIndex v) const { return draft_.mesh.points[v]; }

  /// What crosses, by what hangs together over crossings and edges.
  std::vector<Triangles> clusters() const {
    std::vector<char> crosses(triangles().size(), 0);
    DisjointSets sets(triangles().size());
    for (const auto& [s, t] : pairs_) {
      crosses[s] = crosses[t] = 1;
      sets.join(s, t);
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto uses = edges_.uses(e);
      for (std::size_t i = 1; i < uses.size(); ++i)
        if (crosses[uses[0] / 3] && crosses[uses[i] / 3]) sets.join(uses[0] / 3, uses[i] / 3);
    }
    std::map<std::uint32_t, Triangles> by_set;
    for (std::uint32_t t = 0; t < crosses.size(); ++t)
      if (crosses[t]) by_set[sets.find(t)].push_back(t);
    std::vector<Triangles> all;
    for (auto& [first, members] : by_set) all.push_back(std::move(members));
    return all;
  }

  /// The smallest patch around these triangles that can be laid flat, unless they are in another one.
  bool take(const Triangles& seeds) {
    Patch patch(seeds.begin(), seeds.end());
    for (int ring = 0; ring <= kMostRings; ++ring) {
      if (ring > 0) add_ring(patch);
      add_enclosed(patch);
      if (patch.size() > kMostTriangles || std::ranges::any_of(patch, [&](std::uint32_t t) { return taken_[t] != 0; }))
        return false;
      if (crossings(patch, true) == 0) continue;
      std::optional<Crumple> crumple = capped(patch);
      if (!crumple) continue;
      for (const std::uint32_t t : patch) taken_[t] = 1;
      found_.push_back(std::move(*crumple));
      return true;
    }
    return false;
  }

  void note_partners() {
    for (const auto& [s, t] : pairs_) {
      partners_[s].push_back(t);
      partners_[t].push_back(s);
    }
  }

  /// The pairs that cross of which both are in the patch, or one at least.
  std::size_t crossings(const Patch& patch, bool both) const {
    std::size_t inside = 0, half = 0;
    for (const std::uint32_t t : patch)
      if (const auto at = partners_.find(t); at != partners_.end())
        for (const std::uint32_t s : at->second) ++(patch.contains(s) ? inside : half);
    return both ? inside / 2 : inside / 2 + half;
  }

  template <class Visit>
  void for_each_neighbour(std::uint32_t t, const Visit& visit) const {
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h)
      for (const HalfEdge g : edges_.uses(edge_of_[h]))
        if (g / 3 != t) visit(g / 3);
  }

  void add_ring(Patch& patch) const {
    const Triangles before(patch.begin(), patch.end());
    const std::uint32_t base = *std::ranges::max_element(
        before, {}, [&](std::uint32_t t) { return triangle_area(draft_.mesh.points, triangles()[t]); });
    for (const std::uint32_t t : before)
      for_each_neighbour(t, [&](std::uint32_t s) {
        if (ring_ == Ring::kAll || lies_in_plane_of(base, s)) patch.insert(s);
      });
  }

  /// As far as the tolerance tells.
  bool lies_in_plane_of(std::uint32_t base, std::uint32_t t) const {
    const auto& [a, b, c] = triangles()[base];
    const Vec3 origin = at(a), normal = unit_normal(origin, at(b), at(c));
    return std::ranges::all_of(triangles()[t],
                               [&](VertexIndex v) { return std::abs(dot(at(v) - origin, normal)) <= tolerance_; });
  }

  /// Neighbours that have no corner of their own.
  void add_enclosed(Patch& patch) const {
    std::set<VertexIndex> corners;
    for (const std::uint32_t t : patch) corners.insert(triangles()[t].begin(), triangles()[t].end());
    Triangles waiting(patch.begin(), patch.end());
    while (!waiting.empty()) {
      const std::uint32_t t = waiting.back();
      waiting.pop_back();
      for_each_neighbour(t, [&](std::uint32_t s) {
        if (!std::ranges::all_of(triangles()[s], [&](VertexIndex v) { return corners.contains(v); })) return;
        if (patch.insert(s).second) waiting.push_back(s);
      });
    }
  }

  /// If the patch is a disc that a cap within the tolerance may replace.
  std::optional<Crumple> capped(const Patch& patch) const {
    const std::vector<HalfEdge> rim = rim_of(patch);
    if (rim.size() < 3) return std::nullopt;
    Crumple crumple{{patch.begin(), patch.end()}, cap_over(rim, patch), 0, crossings(patch, false)};
    if (crumple.cap.empty()) return std::nullopt;
    const SurfaceMesh before = part(faces_of(crumple)), after = part(crumple.cap);
    const TriangleTree cap(after);
    if (std::ranges::any_of(before.points, [&](Vec3 p) { return !cap.is_within(p, tolerance_); })) return std::nullopt;
    crumple.distance = hausdorff_distance(before, after, kSureTo * tolerance_).upper;
    if (crumple.distance > tolerance_) return std::nullopt;
    return crumple;
  }

  /// Empty where it would need an edge that is there already.
  std::vector<Triangle> cap_over(const std::vector<HalfEdge>& rim, const Patch& patch) const {
    std::vector<Vec3> polygon, beyond;
    for (const HalfEdge h : rim) {
      polygon.push_back(at(start_of(triangles(), h)));
      const auto uses = edges_.uses(edge_of_[h]);
      const auto& [a, b, c] = triangles()[(uses[0] == h ? uses[1] : uses[0]) / 3];
      beyond.push_back(unit_normal(at(a), at(b), at(c)));
    }
    const auto vertex = [&](std::uint32_t i) { return start_of(triangles(), rim[i]); };
    const auto is_taken = [&](std::uint32_t i, std::uint32_t j) {
      const bool is_chord = (i + 1) % rim.size() != j && (j + 1) % rim.size() != i;
      return is_chord && is_used_beyond(vertex(i), vertex(j), patch);
    };
    std::vector<Triangle> cap;
    for (const auto& [i, j, k] : triangulate_polygon(polygon, beyond, is_taken)) {
      if (is_taken(i, j) || is_taken(j, k) || is_taken(k, i)) return {};
      cap.push_back({vertex(i), vertex(j), vertex(k)});
    }
    return cap;
  }

  std::vector<Triangle> faces_of(const Crumple& crumple) const {
    std::vector<Triangle> faces;
    for (const std::uint32_t t : crumple.faces) faces.push_back(triangles()[t]);
    return faces;
  }

  /// The rim of a disc, as its half-edges one after the other; empty if the patch is none, or at a hole.
  std::vector<HalfEdge> rim_of(const Patch& patch) const {
    std::set<VertexIndex> vertices;
    std::set<std::uint32_t> edges;
    std::map<VertexIndex, HalfEdge> leaving;
    for (const std::uint32_t t : patch)
      for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
        vertices.insert(start_of(triangles(), h));
        edges.insert(edge_of_[h]);
        const auto uses = edges_.uses(edge_of_[h]);
        if (uses.size() != 2) return {};
        const HalfEdge twin = uses[0] == h ? uses[1] : uses[0];
        if (start_of(triangles(), twin) == start_of(triangles(), h)) return {};
        if (!patch.contains(twin / 3) && !leaving.emplace(start_of(triangles(), h), h).second) return {};
      }
    if (vertices.size() + patch.size() != edges.size() + 1 || leaving.empty()) return {};
    std::vector<HalfEdge> rim;
    for (HalfEdge h = leaving.begin()->second; rim.size() < leaving.size();) {
      rim.push_back(h);
      const auto next = leaving.find(end_of(triangles(), h));
      if (next == leaving.end()) return {};
      h = next->second;
    }
    return end_of(triangles(), rim.back()) == start_of(triangles(), rim.front()) ? rim : std::vector<HalfEdge>{};
  }

  bool is_used_beyond(VertexIndex a, VertexIndex b, const Patch& patch) const {
    const Edge edge{std::min(a, b), std::max(a, b)};
    const auto found = std::ranges::lower_bound(edges_.edges, edge);
    if (found == edges_.edges.end() || *found != edge) return false;
    const auto uses = edges_.uses(static_cast<std::size_t>(found - edges_.edges.begin()));
    return std::ranges::any_of(uses, [&](HalfEdge h) { return !patch.contains(h / 3); });
  }

  /// These triangles with their own corners only.
  SurfaceMesh part(const std::vector<Triangle>& faces) const {
    SurfaceMesh mesh;
    std::unordered_map<VertexIndex, VertexIndex> number;
    for (Triangle t : faces) {
      for (VertexIndex& v : t) {
        const auto [place, is_new] = number.try_emplace(v, static_cast<VertexIndex>(mesh.points.size()));
        if (is_new) mesh.points.push_back(at(v));
        v = place->second;
      }
      mesh.triangles.push_back(t);
    }
    return mesh;
  }

  /// The other triangles in their order, then the caps in theirs.
  SurfaceMesh without_crumples() const {
    std::vector<char> gone(triangles().size(), 0);
    for (const Crumple& crumple : found_)
      for (const std::uint32_t t : crumple.faces) gone[t] = 1;
    SurfaceMesh mesh{draft_.mesh.points, {}, {}, {}, {}};
    for (std::uint32_t t = 0; t < gone.size(); ++t)
      if (!gone[t]) mesh.triangles.push_back(triangles()[t]);
    for (const Crumple& crumple : found_)
      mesh.triangles.insert(mesh.triangles.end(), crumple.cap.begin(), crumple.cap.end());
    return mesh;
  }

  /// Those whose caps cross as many triangles as their faces did. Whether there were any.
  bool drop_those_that_cross_more(const SurfaceMesh& mesh) {
    std::vector<std::size_t> crumple_of;
    for (std::size_t i = 0; i < found_.size(); ++i) crumple_of.insert(crumple_of.end(), found_[i].cap.size(), i);
    const std::size_t first = mesh.triangles.size() - crumple_of.size();
    std::vector<std::size_t> crossings(found_.size(), 0);
    for (const auto& pair : self_intersections(mesh.points, mesh.triangles, kMostPairs, draft_.context))
      for (const std::uint32_t t : pair)
        if (t >= first) ++crossings[crumple_of[t - first]];
    std::size_t i = 0;
    return std::erase_if(found_, [&](const Crumple& c) { return crossings[i++] >= c.crossings; }) > 0;
  }

  LaidFlat replace(SurfaceMesh mesh) {
    LaidFlat done;
    std::vector<char> gone(triangles().size(), 0);
    Triangles like;  // per triangle of the caps the face nearest to it, whose part it is taken for
    for (const Crumple& crumple : found_) {
      const TriangleTree tree(draft_.mesh.points, faces_of(crumple));
      for (const auto& [a, b, c] : crumple.cap)
        like.push_back(crumple.faces[tree.nearest(centroid(at(a), at(b), at(c))).triangle]);
      for (const std::uint32_t t : crumple.faces) gone[t] = 1;
      done.faces += crumple.faces.size();
      done.largest_move = std::max(done.largest_move, crumple.distance);
      done.places.push_back(at(crumple.cap.front()[0]));
    }
    Triangles old;
    for (std::uint32_t t = 0; t < gone.size(); ++t)
      if (!gone[t]) old.push_back(t);
    old.insert(old.end(), like.begin(), like.end());
    std::vector<std::uint32_t> face, patch;
    for (const std::uint32_t t : old) {
      face.push_back(draft_.face[t]);
      if (!draft_.mesh.patch.empty()) patch.push_back(draft_.mesh.patch[t]);
    }
    draft_.mesh.triangles = std::move(mesh.triangles);
    draft_.mesh.patch = std::move(patch);
    draft_.face = std::move(face);
    draft_.known_edges.reset();
    return done;
  }

  Draft& draft_;
  double tolerance_;
  Ring ring_;
  const EdgeTable edges_;
  const RawVector<std::uint32_t> edge_of_;
  Pairs pairs_;                                            ///< that cross
  std::unordered_map<std::uint32_t, Triangles> partners_;  ///< what each of them crosses
  std::vector<char> taken_;                                ///< per triangle: in one of those found
  std::vector<Crumple> found_;
};

}  // namespace

LaidFlat lay_crumples_flat(Draft& draft, double tolerance) {
  LaidFlat all;
  for (int pass = 0; pass < kMostPassesOverCrumples && tolerance > 0; ++pass) {
    LaidFlat done = Crumples(draft, tolerance, Ring::kAll).run();
    if (done.faces == 0) done = Crumples(draft, tolerance, Ring::kFlat).run();
    if (done.faces == 0) break;
    all.faces += done.faces;
    all.largest_move = std::max(all.largest_move, done.largest_move);
    all.places.insert(all.places.end(), done.places.begin(), done.places.end());
  }
  if (all.faces > 0) tidy::drop_unused_vertices(draft);
  return all;
}

}  // namespace octafront::mend
