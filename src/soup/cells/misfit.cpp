#include "soup/cells/misfit.h"

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/geometry/leeway.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace octafront::cells {
namespace {

/// Walls nearer than this part of the size make elements flatter than anybody wants.
constexpr double kOfSize = 0.1;
/// How many times farther than that it must be through the bodies.
constexpr double kThicker = 5;
/// Facets of curved walls stray from each other by what theirs do together; somewhat more where facets are irregular.
constexpr double kOfSagitta = 1.25;
/// The cosine of what facets of curved walls turn by, at most: 65 degrees; six facets around have 60.
constexpr double kCurved = 0.4226;
/// Elements of a mesh whose sizes nobody chose, about.
constexpr double kUsualElements = 30'000;

/// One body, as its neighbours meet it.
struct BodyWall {
  std::vector<Triangle> triangles;
  std::vector<Vec3> normals;
  std::vector<VertexIndex> vertices;
  std::vector<std::vector<std::uint32_t>> around;  ///< per vertex, by its place in `vertices`
  std::vector<double> sagitta;                     ///< per triangle: how far its facet is from what it stands for
  std::vector<double> sagitta_at;                  ///< per vertex
  std::vector<char> at_end;                        ///< per vertex: where a sheet ends
  /// Between two triangles; ends by their places in `vertices`.
  struct WallEdge {
    std::size_t v, w;
    std::uint32_t s, t;
  };
  std::vector<WallEdge> edges;
  double largest_sagitta = 0;
  Box3 box;
  std::unique_ptr<TriangleTree> tree;
  std::unique_ptr<Leeway> leeway;

  BodyWall(const std::vector<Vec3>& points, std::vector<Triangle> faces) : triangles(std::move(faces)) {
    for (const Triangle& t : triangles) {
      normals.push_back(unit_normal(points[t[0]], points[t[1]], points[t[2]]));
      vertices.insert(vertices.end(), t.begin(), t.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    around.resize(vertices.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (const VertexIndex v : triangles[t]) around[place_of(v)].push_back(t);
    for (const VertexIndex v : vertices) box.add(points[v]);
    measure_sagittas(points);
    tree = std::make_unique<TriangleTree>(points, triangles);
    leeway = std::make_unique<Leeway>(SurfaceMesh{}, *tree);
  }

  std::size_t place_of(VertexIndex v) const {
    return static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  }

 private:
  /// How a wall turns at an edge: 0 where it is flat, ends, or turns sharply.
  struct WallTurn {
    double angle = 0;
    bool is_convex = false;
    Vec3 along;
  };

  /// Of a chord of length w that turns by an angle at its ends: w / 2 tan(angle / 4).
  void measure_sagittas(const std::vector<Vec3>& points) {
    sagitta.assign(triangles.size(), 0);
    at_end.assign(vertices.size(), 0);
    std::vector<Triangle> local = triangles;
    for (Triangle& t : local)
      for (VertexIndex& v : t) v = static_cast<VertexIndex>(place_of(v));
    const EdgeTable table = make_edge_table(vertices.size(), local);
    std::vector<WallTurn> turns(table.size());
    std::vector<std::vector<std::size_t>> edges_at(vertices.size());
    for (std::size_t e = 0; e < table.size(); ++e) {
      const auto uses = table.uses(e);
      if (uses.size() == 1)
        for (const VertexIndex v : table.edges[e]) at_end[v] = 1;
      if (uses.size() != 2) continue;
      edges.push_back({table.edges[e][0], table.edges[e][1], uses[0] / 3, uses[1] / 3});
      turns[e] = turn_at(points, table, e);
      for (const VertexIndex v : table.edges[e]) edges_at[v].push_back(e);
    }
    for (std::size_t e = 0; e < table.size(); ++e) {
      if (turns[e].angle == 0) continue;
      double width = 0;
      for (const HalfEdge h : table.uses(e)) {
        const auto [a, b, c] = triangles[h / 3];
        const VertexIndex beyond = local[h / 3][(h % 3 + 2) % 3];
        if (!goes_on(turns, e, edges_at[beyond])) continue;
        const Vec3 p = points[vertices[table.edges[e][0]]], q = points[vertices[table.edges[e][1]]];
        width = std::max(width, length(double_area_normal(points[a], points[b], points[c])) / distance(p, q));
      }
      for (const HalfEdge h : table.uses(e))
        sagitta[h / 3] = std::max(sagitta[h / 3], width / 2 * elementary::tan(turns[e].angle / 4));
    }
    sagitta_at.assign(vertices.size(), 0);
    for (std::size_t v = 0; v < vertices.size(); ++v)
      for (const std::uint32_t t : around[v]) sagitta_at[v] = std::max(sagitta_at[v], sagitta[t]);
    for (const double s : sagitta) largest_sagitta = std::max(largest_sagitta, s);
  }

  WallTurn turn_at(const std::vector<Vec3>& points, const EdgeTable& table, std::size_t e) const {
    const auto uses = table.uses(e);
    const Vec3 n = normals[uses[0] / 3], m = normals[uses[1] / 3];
    if (!is_curved(n, m)) return {};
    const Vec3 p = points[vertices[table.edges[e][0]]], q = points[vertices[table.edges[e][1]]];
    const Vec3 beyond = points[triangles[uses[1] / 3][(uses[1] % 3 + 2) % 3]];
    return {elementary::atan2(length(cross(n, m)), dot(n, m)), dot(n, beyond - p) < 0, normalized(q - p)};
  }

  /// Whether the wall turns likewise on the other side of the facet, at one of these edges there: a single edge of a
  /// cone with a cylinder stands for no arc.
  static bool goes_on(const std::vector<WallTurn>& turns, std::size_t e, const std::vector<std::size_t>& beyond) {
    constexpr double kParallel = 0.7, kLikewise = 0.25;
    return std::ranges::any_of(beyond, [&](std::size_t f) {
      return f != e && turns[f].angle > kLikewise * turns[e].angle && turns[f].is_convex == turns[e].is_convex &&
             std::abs(dot(turns[f].along, turns[e].along)) > kParallel;
    });
  }
};

}  // namespace

double MisfitLimits::most() const {
  return tolerance.value_or(kOfSize * size);
}

MisfitLimits limits_for(std::optional<double> tolerance, const ElementsToCome& elements, double volume) {
  // A regular tetrahedron of edge 1 has a volume of .118.
  const double count = elements.elements ? static_cast<double>(*elements.elements) : kUsualElements;
  return {tolerance, elements.size.value_or(elementary::cbrt(volume / (0.118 * std::max(count, 1.0))))};
}

MisfitLimits limits_for(const ComplexOptions& options, const ElementsToCome& elements,
                        const std::vector<Body>& bodies) {
  double volume = 0;
  for (const Body& b : bodies) volume += std::abs(enclosed_volume(b.surface));
  return limits_for(options.tolerance, elements, volume);
}

bool is_curved(Vec3 n, Vec3 m) {
  return dot(n, m) >= kCurved;
}

bool face_each_other(Vec3 n, Vec3 m, Vec3 way) {
  // Cosines: walls of facets of eight and of six sides may turn against each other by 37 degrees, corners of three
  // walls may lie apart along their diagonal.
  constexpr double kParallel = 0.7, kAcross = 0.5;
  return std::abs(dot(n, m)) > kParallel && std::abs(dot(m, way)) >= kAcross * length(way);
}

namespace {

class Measuring {
 public:
  Measuring(const BodySoup& soup, const MisfitLimits& limits, const RunContext& context)
      : points_(soup.points), limits_(limits), context_(context) {
    std::vector<std::vector<Triangle>> faces;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      if (soup.body[t] >= faces.size()) faces.resize(soup.body[t] + 1);
      faces[soup.body[t]].push_back(soup.triangles[t]);
    }
    for (std::vector<Triangle>& f : faces) walls_.emplace_back(points_, std::move(f));
  }

  /// The misfits of pairs of bodies that come near each other; and how far their facets there are from what they stand
  /// for.
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> misfits(std::vector<double>& sagitta) const {
    const std::vector<std::array<std::uint32_t, 2>> pairs = near_pairs();
    std::vector<std::array<Met, 2>> met(pairs.size());
    parallel_for(
        pairs.size(),
        [&](std::size_t i) {
          const auto [a, b] = pairs[i];
          context_.check();
          met[i] = {misfit(walls_[a], walls_[b]), misfit(walls_[b], walls_[a])};
        },
        Split::kAdaptive);
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> misfits;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [a, b] = pairs[i];
      const double apart = std::max(met[i][0].apart, met[i][1].apart);
      if (apart > 0) misfits[{a, b}] = apart;
      sagitta[b] = std::max(sagitta[b], met[i][0].sagitta);
      sagitta[a] = std::max(sagitta[a], met[i][1].sagitta);
    }
    return misfits;
  }

 private:
  /// What is met of another wall: how far away it is, and how far its facets are from what they stand for; 0: nothing.
  struct Met {
    double apart = 0, sagitta = 0;
    void add(const Met& other) {
      apart = std::max(apart, other.apart);
      sagitta = std::max(sagitta, other.sagitta);
    }
  };

  /// Bodies whose boxes come near each other.
  std::vector<std::array<std::uint32_t, 2>> near_pairs() const {
    double sagitta = 0;
    for (const BodyWall& w : walls_) sagitta = std::max(sagitta, w.largest_sagitta);
    const double most = limits_.tolerance.value_or(std::max(kOfSize * limits_.size, 2 * kOfSagitta * sagitta));
    std::vector<std::uint32_t> order(walls_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(walls_[a].box.lo.x, a) < std::pair(walls_[b].box.lo.x, b);
    });
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        const BodyWall &a = walls_[order[i]], &b = walls_[order[j]];
        if (b.box.lo.x > a.box.hi.x + most) break;
        if (a.box.grown(most_between(a, b)).overlaps(b.box))
          pairs.push_back({std::min(order[i], order[j]), std::max(order[i], order[j])});
      }
    return pairs;
  }

  double most_between(const BodyWall& a, const BodyWall& b) const {
    if (limits_.tolerance) return *limits_.tolerance;
    return std::max(kOfSize * limits_.size, kOfSagitta * (a.largest_sagitta + b.largest_sagitta));
  }

  /// A place on a wall, by its normal (or 0: any), and how far facets may be from what they stand for there.
  struct Place {
    Vec3 at, normal;
    double sagitta;
    double across = 0;  ///< the least cosine of the way to the other wall with that one's normal
  };

  /// The farthest that `a` lies from a wall of `b` that it belongs to.
  Met misfit(const BodyWall& a, const BodyWall& b) const {
    const double most = most_between(a, b);
    const Box3 near_b = b.box.grown(most);
    Met all;
    std::vector<char> in_contact(a.vertices.size(), 0);
    for (std::size_t v = 0; v < a.vertices.size(); ++v) {
      const Vec3 p = points_[a.vertices[v]];
      if (!near_b.overlaps({p, p})) continue;
      const Met met = misfit_at(a, v, b, most);
      in_contact[v] = met.apart > 0;
      all.add(met);
    }
    for (const BodyWall::WallEdge& e : a.edges)
      if (!in_contact[e.v] || !in_contact[e.w]) all.add(misfit_along(a, e, b, near_b, most));
    return all;
  }

  Met misfit_at(const BodyWall& a, std::size_t v, const BodyWall& b, double most) const {
    const Vec3 p = points_[a.vertices[v]];
    // The end of a sheet goes on to walls any way.
    Met all = a.at_end[v] ? misfit_at(a, {p, {}, a.sagitta_at[v]}, b, most) : Met{};
    for (const std::uint32_t s : a.around[v]) all.add(misfit_at(a, {p, a.normals[s], a.sagitta_at[v]}, b, most));
    return all;
  }

  /// Of an edge that goes through a contact, or ends in it: of some places on it.
  Met misfit_along(const BodyWall& a, const BodyWall::WallEdge& e, const BodyWall& b, const Box3& near_b,
                   double most) const {
    const Vec3 p = points_[a.vertices[e.v]], q = points_[a.vertices[e.w]];
    if (!near_b.overlaps({min(p, q), max(p, q)})) return {};
    constexpr int kPlaces = 8;
    // Beside the end of the other wall there is none: 37 degrees, when facets at their edges see 30.
    constexpr double kAcross = 0.8;
    double from = 0, to = 1;
    for (int i = 0; i < 3; ++i) {
      const double way = q[i] - p[i];
      if (way == 0) continue;
      const double x = (near_b.lo[i] - p[i]) / way, y = (near_b.hi[i] - p[i]) / way;
      from = std::max(from, std::min(x, y));
      to = std::min(to, std::max(x, y));
    }
    Met all;
    for (int k = 0; k < kPlaces && from < to; ++k) {
      const Vec3 at = p + (from + (to - from) * (k + 0.5) / kPlaces) * (q - p);
      for (const std::uint32_t t : {e.s, e.t})
        all.add(misfit_at(a, {at, a.normals[t], a.sagitta[t], kAcross}, b, most));
    }
    return all;
  }

  Met misfit_at(const BodyWall& a, const Place& place, const BodyWall& b, double most) const {
    const Vec3 p = place.at;
    double nearest = TriangleTree::kFar, sagitta = 0;
    Vec3 at, normal;
    b.tree->for_each_box_near(Box3{p, p}.grown(most), [&](std::uint32_t t, const TriangleCorners& c) {
      const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
      const double d = distance(p, q);
      if (d > most || d >= nearest) return true;
      if (place.normal != Vec3{} && !face_each_other(place.normal, b.normals[t], p - q)) return true;
      if (std::abs(dot(b.normals[t], p - q)) < place.across * d) return true;
      nearest = d;
      at = q;
      normal = b.normals[t];
      sagitta = b.sagitta[t];
      return true;
    });
    if (!(nearest <= most)) return {};
    const Met met{nearest, sagitta};
    const double allowed = kOfSagitta * (place.sagitta + sagitta);
    if (limits_.tolerance || nearest <= allowed)
      return is_thinner(a, p, b, at, nearest) || has_other_side(a, p, place.normal, nearest) ||
                     has_other_side(b, at, normal, nearest)
                 ? Met{}
                 : met;
    const bool small = nearest <= kOfSize * limits_.size;
    return small && !is_thinner(a, p, b, at, kThicker * nearest) ? met : Met{};
  }

  /// Whether one of the bodies is there, to be moved by that.
  static bool is_thinner(const BodyWall& a, Vec3 p, const BodyWall& b, Vec3 q, double by) {
    return a.leeway->at(p, by) < by || b.leeway->at(q, by) < by;
  }

  /// Whether the body's other side is nearer to q, on a wall with normal n, than twice that: beside corners of coarse
  /// facets nothing lies straight across.
  bool has_other_side(const BodyWall& b, Vec3 q, Vec3 n, double by) const {
    constexpr double kTwice = 2, kFacesAway = -0.4;
    return !b.tree->for_each_box_near(Box3{q, q}.grown(kTwice * by), [&](std::uint32_t t, const TriangleCorners& c) {
      if (dot(b.normals[t], n) > kFacesAway) return true;
      const Vec3 way = closest_point_on_triangle(q, c[0], c[1], c[2]) - q;
      return !(length(way) < kTwice * by && dot(way, n) < 0);
    });
  }

  const std::vector<Vec3>& points_;
  const MisfitLimits& limits_;
  const RunContext& context_;
  std::vector<BodyWall> walls_;
};

}  // namespace

Misfits::Misfits(const BodySoup& soup, const MisfitLimits& limits, const RunContext& context) {
  for (const std::uint32_t b : soup.body) bodies_ = std::max(bodies_, b + 1);
  sagitta_.assign(bodies_, 0);
  if (limits.tolerance == 0.0) return;
  // Single precision keeps seven digits.
  constexpr double kOfDiagonal = 1e-6;
  Box3 box;
  for (const Vec3 p : soup.points) box.add(p);
  floor_ = std::min(kOfDiagonal * box.diagonal(), limits.tolerance.value_or(TriangleTree::kFar));
  misfit_ = Measuring(soup, limits, context).misfits(sagitta_);
}

double Misfits::largest() const {
  double largest = 0;
  for (const auto& [pair, d] : misfit_) largest = std::max(largest, d);
  return largest;
}

std::vector<std::uint32_t> Misfits::coarsest_first() const {
  std::vector<std::uint32_t> order(bodies_), place(bodies_);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return sagitta_[a] > sagitta_[b]; });
  for (std::uint32_t k = 0; k < bodies_; ++k) place[order[k]] = k;
  return place;
}

Misfits Misfits::renumbered(const std::vector<std::uint32_t>& number) const {
  Misfits other = *this;
  other.misfit_.clear();
  for (const auto& [pair, apart] : misfit_) other.misfit_[std::minmax(number[pair.first], number[pair.second])] = apart;
  for (std::uint32_t b = 0; b < bodies_; ++b) other.sagitta_[number[b]] = sagitta_[b];
  return other;
}

}  // namespace octafront::cells
