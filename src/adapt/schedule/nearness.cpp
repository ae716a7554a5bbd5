#include "adapt/schedule/nearness.h"

#include "base/core/parallel.h"
#include "base/core/renumber.h"
#include "base/geometry/hausdorff.h"
#include "base/geometry/measures.h"
#include "base/geometry/same_place.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace octafront::adapt {
namespace {

/// The triangles that stand for the smooth surface are this much nearer to it than what is asked for, and distances
/// are known as well.
constexpr double kPartOfTolerance = 0.1;
/// How long the longest edges of triangles that stray are said to be, in wanted lengths, so that they are divided.
constexpr double kLengthOfStray = 1.6;
/// Each side of a triangle is divided into so many where strays are looked for.
constexpr int kDivisions = 4;

bool all_frozen(const Triangle& t, std::span<const std::uint8_t> frozen) {
  return !frozen.empty() && frozen[t[0]] && frozen[t[1]] && frozen[t[2]];
}

/// visit(point) for places all over a triangle, corners too.
template <class Visit>
void visit_places(const TriangleCorners& t, const Visit& visit) {
  for (int i = 0; i <= kDivisions; ++i)
    for (int j = 0; i + j <= kDivisions; ++j) {
      const double u = static_cast<double>(i) / kDivisions, v = static_cast<double>(j) / kDivisions;
      visit(t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]));
    }
}

/// Whether all of a triangle is within a distance of one triangle of the tree: how far it is away is convex.
bool is_near_one(const TriangleTree& tree, const TriangleCorners& t, double within) {
  const std::uint32_t nearest = tree.nearest(centroid(t[0], t[1], t[2])).triangle;
  if (nearest == kNone) return false;
  const auto& [a, b, c] = tree.corners(nearest);
  return std::all_of(t.begin(), t.end(), [&](Vec3 p) {
    return squared_distance(p, closest_point_on_triangle(p, a, b, c)) < within * within;
  });
}

void add_triangles(const std::vector<TriangleCorners>& list, SurfaceMesh& surface) {
  for (const TriangleCorners& t : list) {
    const auto first = static_cast<VertexIndex>(surface.points.size());
    surface.points.insert(surface.points.end(), t.begin(), t.end());
    surface.triangles.push_back({first, first + 1, first + 2});
  }
}

/// Corners at one place become one point: how far it is away is asked once.
void join_points(SurfaceMesh& surface) {
  const std::vector<VertexIndex> first = first_at_place(surface.points);
  PointsTaken taken(surface.points);
  std::vector<Vec3> points;
  for (Triangle& t : surface.triangles) {
    for (VertexIndex& v : t) v = first[v];
    t = taken.take(t, points);
  }
  surface.points = std::move(points);
}

TriangleCorners corners_on(const SurfaceMesh& surface, const Triangle& t) {
  return {surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]};
}

}  // namespace

double excess_of(std::span<const Deviation> deviations) {
  return worst_of(deviations).excess();
}

Deviation worst_of(std::span<const Deviation> deviations) {
  Deviation worst;
  for (const Deviation& d : deviations)
    if (worst.bound == 0 || d.excess() > worst.excess()) worst = d;
  return worst;
}

bool SmoothWalls::stays(const Triangle& corners, std::uint32_t part) const {
  return all_frozen(corners, bounds_.frozen) || (!bounds_.kept.empty() && bounds_.kept[part] != 0);
}

SmoothWalls::SmoothWalls(const Ground& ground, const WallBounds& bounds) : bounds_(bounds), tree_(SurfaceMesh{}) {
  make_groups();
  const SurfaceMesh& walls = ground.walls().surface;
  std::vector<std::uint32_t> free;
  PointsTaken taken(walls.points);
  SurfaceMesh old, all;
  for (std::uint32_t t = 0; t < walls.triangles.size(); ++t) {
    if (stays(walls.triangles[t], walls.patch[t])) continue;
    if (!ground.is_covered(t)) free.push_back(t);
    old.triangles.push_back(taken.take(walls.triangles[t], old.points));
    old.patch.push_back(walls.patch[t]);
  }
  std::vector<std::vector<TriangleCorners>> made(free.size());
  parallel_for(free.size(), [&](std::size_t k) {
    made[k] = ground.divided(free[k], groups_[group_[walls.patch[free[k]]]].tolerance);
  });
  for (std::size_t k = 0; k < free.size(); ++k) {
    add_triangles(made[k], groups_[group_[walls.patch[free[k]]]].smooth);
    add_triangles(made[k], all);
  }
  if (ground.given()) add_given(ground, all);
  for (Group& group : groups_) join_points(group.smooth);
  tree_ = TriangleTree(all);
  std::vector<SurfaceMesh> old_of_groups = divided_in_groups(old);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].old = std::move(old_of_groups[g]);
    const auto p = static_cast<std::size_t>(std::find(group_.begin(), group_.end(), g) - group_.begin());
    groups_[g].bound = bounds_.tolerance[p];
    groups_[g].excused = bounds_.strict[p] != 0;
  }
}

/// Parts of the same tolerance, strict or not, in the order of their first parts.
void SmoothWalls::make_groups() {
  std::map<std::pair<double, std::uint8_t>, std::uint32_t> number;
  for (std::size_t p = 0; p < bounds_.tolerance.size(); ++p) {
    const std::pair key{bounds_.tolerance[p], bounds_.strict[p]};
    const auto [at, is_new] = number.try_emplace(key, static_cast<std::uint32_t>(groups_.size()));
    if (is_new) groups_.emplace_back().tolerance = kPartOfTolerance * key.first;
    group_.push_back(at->second);
  }
}

/// Of what was given, that is looked for among the new walls whose nearest old ones are covered and may change.
void SmoothWalls::add_given(const Ground& ground, SurfaceMesh& all) {
  const SurfaceMesh& walls = ground.walls().surface;
  const auto stands = [&](Vec3 p) {
    const std::uint32_t t = ground.wall_at(p);
    return t != kNone && ground.is_covered(t) && !stays(walls.triangles[t], walls.patch[t]);
  };
  double least = HUGE_VAL;
  for (const Group& group : groups_) least = std::min(least, group.tolerance);
  std::vector<Ground::GivenPieces> made(ground.given()->size());
  parallel_for(made.size(),
               [&](std::size_t t) { made[t] = ground.divided_given(static_cast<std::uint32_t>(t), least, stands); });
  for (const Ground::GivenPieces& pieces : made)
    for (const TriangleCorners& t : pieces.standing) {
      const std::uint32_t wall = ground.wall_at(centroid(t[0], t[1], t[2]));
      add_triangles({t}, groups_[group_[walls.patch[wall]]].smooth);
      add_triangles({t}, all);
    }
  for (const Ground::GivenPieces& pieces : made) add_triangles(pieces.others, all);
}

WallsOfParts SmoothWalls::walls_of(const Parts& mesh) const {
  return wall_triangles(mesh, [&](const Triangle& f, std::uint32_t part) {
    return std::all_of(f.begin(), f.end(), [&](VertexIndex v) { return mesh.vertices[v].frozen; }) ||
           (!bounds_.kept.empty() && bounds_.kept[part] != 0);
  });
}

std::vector<SurfaceMesh> SmoothWalls::divided_in_groups(const SurfaceMesh& walls) const {
  if (groups_.size() == 1) return {walls};
  std::vector<SurfaceMesh> parts(groups_.size());
  for (std::uint32_t g = 0; g < parts.size(); ++g) {
    PointsTaken taken(walls.points);
    for (std::size_t t = 0; t < walls.triangles.size(); ++t)
      if (group_[walls.patch[t]] == g) parts[g].triangles.push_back(taken.take(walls.triangles[t], parts[g].points));
  }
  return parts;
}

Deviation SmoothWalls::of_old(const Group& group) const {
  return distance_of(group, group.old, TriangleTree(group.old), kResolution);
}

void SmoothWalls::excuse(Group& group) {
  if (std::exchange(group.excused, true)) return;
  group.bound = std::max(group.bound, of_old(group).upper);
}

std::vector<Deviation> SmoothWalls::of_old() {
  std::vector<Deviation> all;
  for (Group& group : groups_) {
    excuse(group);
    all.push_back(of_old(group));
  }
  return all;
}

std::vector<Deviation> SmoothWalls::of(const SurfaceMesh& walls) {
  const TriangleTree tree(walls);
  const std::vector<SurfaceMesh> parts = divided_in_groups(walls);
  std::vector<Deviation> all;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Deviation known = distance_of(groups_[g], parts[g], tree, kResolution);
    if (known.upper > groups_[g].bound) excuse(groups_[g]);
    const double bound = known.bound = groups_[g].bound;
    if (known.lower <= bound && bound < known.upper) known = distance_of(groups_[g], parts[g], tree, kFineResolution);
    all.push_back(known);
  }
  const auto farther = [](const Deviation& a, const Deviation& b) { return a.excess() > b.excess(); };
  std::stable_sort(all.begin(), all.end(), farther);
  return all;
}

/// `tree`: of all new walls.
Deviation SmoothWalls::distance_of(const Group& group, const SurfaceMesh& walls, const TriangleTree& tree,
                                   double resolution) const {
  if (walls.triangles.empty() && group.smooth.triangles.empty()) return {0, 0, {}, group.bound};
  const HausdorffBounds there = one_sided_hausdorff(walls, tree_, resolution * group.tolerance);
  const HausdorffBounds back = one_sided_hausdorff(group.smooth, tree, resolution * group.tolerance);
  const HausdorffBounds& farther = there.lower >= back.lower ? there : back;
  return {farther.lower, std::max(there.upper, back.upper), farther.place, group.bound};
}

std::vector<SmoothWalls::Stray> SmoothWalls::strays(const Parts& mesh, double share, double least_edge) const {
  const WallsOfParts walls = walls_of(mesh);
  std::vector<Stray> found = strays(walls.surface, share, least_edge);
  for (Stray& s : found)
    for (VertexIndex& v : s.corners) v = walls.vertex[v];
  return found;
}

std::vector<SmoothWalls::Stray> SmoothWalls::strays(const SurfaceMesh& surface, double share, double least_edge) const {
  const TriangleTree tree(surface);
  const auto bound_of = [&](std::size_t t) { return groups_[group_[surface.patch[t]]].bound; };
  std::vector<std::uint8_t> far(surface.triangles.size(), 0);
  parallel_for(far.size(), [&](std::size_t t) {
    visit_places(corners_on(surface, surface.triangles[t]), [&](Vec3 p) {
      if (!far[t]) far[t] = !tree_.is_within(p, share * bound_of(t));
    });
  });
  for (const Group& group : groups_) {
    std::vector<std::uint32_t> nearest(group.smooth.triangles.size(), kNone);
    parallel_for(nearest.size(), [&](std::size_t t) {
      const TriangleCorners corners = corners_on(group.smooth, group.smooth.triangles[t]);
      if (is_near_one(tree, corners, share * group.bound)) return;
      visit_places(corners, [&](Vec3 p) {
        if (nearest[t] == kNone && !tree.is_within(p, share * group.bound)) nearest[t] = tree.nearest(p).triangle;
      });
    });
    for (const std::uint32_t t : nearest)
      if (t != kNone) far[t] = 1;
  }
  std::vector<Stray> found;
  for (std::size_t t = 0; t < far.size(); ++t) {
    const auto [a, b, c] = corners_on(surface, surface.triangles[t]);
    const double bound = bound_of(t), least = least_edge * bound;
    if (far[t] && longest_squared_edge(a, b, c) >= least * least) found.push_back({surface.triangles[t], bound});
  }
  return found;
}

void ask_for(Vertex& vertex, const Metric& metric) {
  vertex.metric = metric;
  vertex.density = density_of(metric);
  vertex.exact = false, vertex.active = true, vertex.calmness = Vertex::kStirred;
}

std::vector<VertexIndex> ask_for_smaller(std::vector<Vertex>& vertices, std::span<const SmoothWalls::Stray> strays) {
  std::vector<double> factor(vertices.size(), 1);
  for (const auto& [t, bound] : strays) {
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &a = vertices[t[i]], &b = vertices[t[(i + 1) % 3]];
      longest = std::max(longest, metric_length(b.at - a.at, a.metric, b.metric));
    }
    if (longest > 0)
      for (const VertexIndex v : t) factor[v] = std::max(factor[v], kLengthOfStray / longest);
  }
  std::vector<VertexIndex> asked;
  for (VertexIndex v = 0; v < factor.size(); ++v) {
    if (factor[v] <= 1) continue;
    asked.push_back(v);
    ask_for(vertices[v], factor[v] * factor[v] * vertices[v].metric);
  }
  return asked;
}

}  // namespace octafront::adapt
