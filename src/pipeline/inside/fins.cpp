#include "pipeline/inside/fins.h"

#include <octafront/error.h>
#include <octafront/named_groups.h>

#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/geometry/same_place.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/complex.h"
#include "base/mesh/face_table.h"
#include "pipeline/inside/polygons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace octafront {
namespace {

/// Height of a fin over its foot, of the foot's length: its triangle is nearly equilateral.
constexpr double kHeight = 0.85;

/// Normals of walls that sum up to less look every way.
constexpr double kLeastInward = 1e-6;

/// Two unit vectors across a direction.
std::array<Vec3, 2> across(Vec3 along) {
  const Vec3 t = normalized(along);
  const Vec3 other = std::abs(t.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(t, other));
  return {u, cross(t, u)};
}

/// How good a place is for the tip of a fin: inside, far from walls and from what else stands near.
class Places {
 public:
  Places(const WallsAround& ground, std::vector<Vec3> others) : ground_(ground), others_(std::move(others)) {}

  double worth(Vec3 tip, double reach) const {
    if (!ground_.is_inside(tip)) return -1;
    double worth = std::min(1.0, std::sqrt(ground_.walls().nearest(tip).squared_distance) / reach);
    for (const Vec3& other : others_) worth = std::min(worth, 0.5 * distance(tip, other) / reach);
    return worth;
  }

 private:
  const WallsAround& ground_;
  std::vector<Vec3> others_;
};

/// The best of some directions from a place, at the greatest of some heights where one is good enough; the first of
/// equals.
Vec3 best_tip(const Places& places, Vec3 from, const std::vector<Vec3>& directions, double height) {
  // Neighbours choose alike where rounding alone makes a difference.
  constexpr double kMore = 1e-3;
  // In narrow places fins are lower: what would pierce a wall would be cut off.
  constexpr double kGoodEnough = 0.2, kLower = 0.5;
  constexpr int kHeights = 8;
  Vec3 best = from + height * directions.front();
  double most = -2;
  for (int k = 0; k < kHeights && most < kGoodEnough; ++k, height *= kLower)
    for (const Vec3& d : directions) {
      const Vec3 tip = from + height * d;
      const double worth = places.worth(tip, height);
      if (worth > most + kMore) most = worth, best = tip;
    }
  return best;
}

/// Eight directions around an axis, cosine and sine; the first ones are the first choice.
constexpr double kDiagonal = std::numbers::sqrt2 / 2;
constexpr std::array<std::array<double, 2>, 8> kAround{{{1, 0},
                                                        {0, 1},
                                                        {-1, 0},
                                                        {0, -1},
                                                        {kDiagonal, kDiagonal},
                                                        {-kDiagonal, kDiagonal},
                                                        {-kDiagonal, -kDiagonal},
                                                        {kDiagonal, -kDiagonal}}};

/// Across a line: eight directions, and the one away from the walls there.
std::vector<Vec3> directions_across(Vec3 along, Vec3 inward) {
  const auto [u, v] = across(along);
  std::vector<Vec3> directions;
  for (const auto& [x, y] : kAround) directions.push_back(x * u + y * v);
  const Vec3 t = normalized(along), in = inward - dot(inward, t) * t;
  if (length(in) > kLeastInward) directions.push_back(normalized(in));
  return directions;
}

/// From a point: along the axes, between them, and away from the walls there.
std::vector<Vec3> directions_from(Vec3 inward) {
  std::vector<Vec3> directions;
  for (int axes = 1; axes <= 3; ++axes)
    for (int code = 0; code < 27; ++code) {
      const Vec3 d{1.0 - code % 3, 1.0 - code / 3 % 3, 1.0 - code / 9};
      if (squared_length(d) == axes) directions.push_back(normalized(d));
    }
  if (length(inward) > kLeastInward) directions.push_back(normalized(inward));
  return directions;
}

/// Edges of lines are so many times as long as a wall beside them is far at most, but not below this part of their
/// length by the size.
constexpr double kOfClearance = 3, kLeastBeside = 1.0 / 16, kNarrowSize = 2;

/// Adds what is behind a: b, and what divides the edge where it runs beside a wall. One that goes up from a wall needs
/// no division.
void halve_beside_walls(Vec3 a, Vec3 b, double least, const WallsAround& ground, std::vector<Vec3>& made) {
  const double l = distance(a, b), reach = l / kOfClearance;
  const Vec3 middle = 0.5 * (a + b);
  const bool is_clear =
      std::min({ground.clearance(a, reach), ground.clearance(middle, reach), ground.clearance(b, reach)}) >= reach;
  if (l <= least || is_clear) {
    made.push_back(b);
    return;
  }
  halve_beside_walls(a, middle, least, ground, made);
  halve_beside_walls(middle, b, least, ground, made);
}

void add_fin(SurfaceMesh& sheet, const std::array<Vec3, 3>& corners) {
  const auto first = static_cast<VertexIndex>(sheet.points.size());
  sheet.points.insert(sheet.points.end(), corners.begin(), corners.end());
  sheet.triangles.push_back({first, first + 1, first + 2});
}

/// Corners at the same place are one vertex, so that fins hang together where their feet do.
void merge_points(SurfaceMesh& sheet) {
  VerticesByPlace at;
  std::vector<Vec3> points;
  for (Triangle& t : sheet.triangles)
    for (VertexIndex& v : t) {
      const Vec3 p = sheet.points[v];
      v = at.add(p, static_cast<VertexIndex>(points.size()));
      if (v == points.size()) points.push_back(p);
    }
  sheet.points = std::move(points);
}

/// Whether an edge of a fin lies on its foot: no other edge of it comes so near, in place and direction.
bool lies_on(Vec3 p, Vec3 q, Vec3 a, Vec3 b) {
  constexpr double kNear = 1e-3, kAlong = 0.25;  // of the foot's length; sine of 15 degrees
  const Vec3 foot = b - a;
  const double size = length(foot);
  const auto off = [&](Vec3 v) { return length(cross(v - a, foot)) / squared_length(foot); };
  return off(p) < kNear && off(q) < kNear && length(cross(q - p, foot)) < kAlong * distance(p, q) * size;
}

/// A patch of a complex may have been divided by regions: "wire (bone|bone)".
bool is_called(const std::string& patch, const std::string& name) {
  return patch == name || patch.starts_with(name + " (");
}

SizeField capped(const SizeField& sizes, const std::vector<NamedSize>& named, const std::string& name) {
  double most = std::numeric_limits<double>::infinity();
  for (const NamedSize& n : named)
    if (n.name == name) most = std::min(most, n.size);
  if (!std::isfinite(most)) return sizes;
  return SizeField::from_function([sizes, most](Vec3 p) { return std::min(most, sizes.at(p)); },
                                  std::min(most, sizes.min_size()), std::min(most, sizes.max_size()));
}

std::string lies_outside(const char* what, const std::string& name) {
  return fmt::format(
      "the {} {} lies outside of everything: no part of it would be in the mesh; look at its coordinates, or leave it "
      "out",
      what, name);
}

double length_of(const std::vector<Vec3>& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < polygon.size(); ++i) sum += distance(polygon[i], polygon[i + 1]);
  return sum;
}

}  // namespace

WallsAround::WallsAround(const SurfaceMesh& walls, const TriangleTree& tree)
    : walls_(tree),
      hull_(walls.sides.empty() ? walls : hull_of(walls)),
      tree_(hull_),
      near_(kOnWalls * tree.box().diagonal()) {}

bool WallsAround::is_inside(Vec3 p) const {
  return tree_.contains(p);
}

bool WallsAround::is_outside(Vec3 p) const {
  return !is_inside(p) && !walls_.is_within(p, near_);
}

double WallsAround::clearance(Vec3 p, double reach) const {
  // Walls that turn by less than 40 degrees are one, as the facets of a cylinder are.
  constexpr double kSmooth = 0.766;
  const auto visit_near = [&](double within, auto&& visit) {
    const Vec3 r{within, within, within};
    walls_.for_each_box_near({p - r, p + r}, [&](std::uint32_t, const TriangleCorners& t) {
      visit(distance(closest_point_on_triangle(p, t[0], t[1], t[2]), p), unit_normal(t[0], t[1], t[2]));
      return true;
    });
  };
  std::vector<Vec3> on;
  visit_near(near_, [&](double d, Vec3 n) {
    if (d <= near_) on.push_back(n);
  });
  double least = reach;
  visit_near(reach, [&](double d, Vec3 n) {
    const auto goes_on = [&](Vec3 other) { return std::abs(dot(n, other)) > kSmooth; };
    if (d > near_ && d < least && std::ranges::none_of(on, goes_on)) least = d;
  });
  return least;
}

Vec3 WallsAround::inward(Vec3 p) const {
  Vec3 sum;
  const Vec3 r{near_, near_, near_};
  std::vector<Vec3> seen;
  tree_.for_each_box_near({p - r, p + r}, [&](std::uint32_t, const TriangleCorners& t) {
    if (distance(closest_point_on_triangle(p, t[0], t[1], t[2]), p) > near_) return true;
    const Vec3 n = unit_normal(t[0], t[1], t[2]);
    // Triangles of one plane speak once.
    constexpr double kSamePlane = 1 - 1e-9;
    if (std::ranges::any_of(seen, [&](Vec3 other) { return dot(n, other) > kSamePlane; })) return true;
    seen.push_back(n);
    sum -= n;
    return true;
  });
  return sum;
}

Fins::Fins(const std::vector<LineNet>& lines, const std::vector<PointSet>& points, const SizeField& sizes,
           const std::vector<NamedSize>& named, const KnownSurface& walls) {
  const WallsAround ground(walls.mesh(), walls.tree());
  for (const LineNet& l : lines) stand_on(l, capped(sizes, named, l.name), ground);
  for (const PointSet& p : points) stand_on(p, capped(sizes, named, p.name), ground);
  for (Sheet& sheet : sheets_) merge_points(sheet.surface);
}

void Fins::stand_on(const LineNet& lines, const SizeField& sizes, const WallsAround& ground) {
  Stand stand{lines.name};
  Sheet sheet{lines.name, {}};
  for (const std::vector<Vec3>& polygon : polygons_of(lines)) {
    stand.length += length_of(polygon);
    const std::vector<Vec3> p = divided_beside_walls(divided(polygon, sizes, ground.walls()), ground);
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
      const Vec3 middle = 0.5 * (p[i] + p[i + 1]);
      const double foot = distance(p[i], p[i + 1]);
      if (ground.is_outside(middle)) {
        stand.outside += foot;
        continue;
      }
      std::vector<Vec3> others;
      if (i > 0) others.push_back(p[i - 1]);
      if (i + 2 < p.size()) others.push_back(p[i + 2]);
      const std::vector<Vec3> directions = directions_across(p[i + 1] - p[i], ground.inward(middle));
      add_fin(sheet.surface,
              {p[i], p[i + 1], best_tip(Places(ground, std::move(others)), middle, directions, kHeight * foot)});
      stand.feet.push_back({p[i], p[i + 1]});
    }
  }
  if (stand.feet.empty()) throw InputError(lies_outside("line", lines.name));
  stands_.push_back(std::move(stand));
  sheets_.push_back(std::move(sheet));
}

std::vector<Vec3> Fins::divided_beside_walls(const std::vector<Vec3>& line, const WallsAround& ground) {
  std::vector<Vec3> made{line.front()};
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double least = kLeastBeside * distance(line[i], line[i + 1]);
    const std::size_t first = made.size();
    halve_beside_walls(line[i], line[i + 1], least, ground, made);
    for (std::size_t k = first; made.size() > first + 1 && k < made.size(); ++k) {
      const double l = distance(made[k - 1], made[k]);
      narrow_.push_back({min(made[k - 1], made[k]), max(made[k - 1], made[k]), 0, kNarrowSize * l});
    }
  }
  return made;
}

void Fins::stand_on(const PointSet& points, const SizeField& sizes, const WallsAround& ground) {
  if (points.points.empty()) throw InputError(fmt::format("the points {}: there is none", points.name));
  Stand stand{points.name, false};
  Sheet sheet{points.name, {}};
  for (const Vec3& p : points.points) {
    if (!is_finite(p)) throw InputError(fmt::format("the points {}: one is not finite", points.name));
    if (std::find(stand.asked.begin(), stand.asked.end(), p) != stand.asked.end()) continue;
    stand.asked.push_back(p);
    if (ground.is_outside(p)) {
      ++stand.points_outside;
      continue;
    }
    stand.feet.push_back({p, p});
    double foot = sizes.at(p);
    for (const Vec3& q : points.points)
      if (q != p) foot = std::min(foot, 0.5 * distance(p, q));
    if (const double beside = kOfClearance * ground.clearance(p, foot / kOfClearance); beside < foot) {
      foot = std::max(beside, kLeastBeside * foot);
      narrow_.push_back({p, p, 0, kNarrowSize * foot});
    }
    const Places places(ground, {});
    const Vec3 first = best_tip(places, p, directions_from(ground.inward(p)), foot) - p;
    // The second one at 60 degrees to the first.
    std::vector<Vec3> directions;
    const auto [u, v] = across(first);
    for (const auto& [x, y] : kAround)
      directions.push_back(0.5 * normalized(first) + std::numbers::sqrt3 / 2 * (x * u + y * v));
    add_fin(sheet.surface, {p, p + first, best_tip(places, p, directions, length(first))});
  }
  if (stand.feet.empty()) throw InputError(lies_outside("set of points", points.name));
  stands_.push_back(std::move(stand));
  sheets_.push_back(std::move(sheet));
}

void Fins::leave(TetMesh& mesh) {
  std::vector<std::vector<std::uint32_t>> faces(stands_.size());
  std::vector<char> gone(mesh.interfaces.size(), 0);
  for (std::uint32_t f = 0; f < mesh.interfaces.size(); ++f) {
    const std::uint32_t p = mesh.interface_patch.empty() ? 0 : mesh.interface_patch[f];
    if (p >= mesh.patch_names.size()) continue;
    for (std::size_t s = 0; s < stands_.size(); ++s)
      if (is_called(mesh.patch_names[p], stands_[s].name)) faces[s].push_back(f), gone[f] = 1;
  }
  for (std::size_t s = 0; s < stands_.size(); ++s) find(mesh, s, faces[s]);
  std::uint32_t kept = 0;
  for (std::size_t f = 0; f < gone.size(); ++f) {
    if (gone[f]) continue;
    mesh.interfaces[kept] = mesh.interfaces[f];
    if (!mesh.interface_patch.empty()) mesh.interface_patch[kept] = mesh.interface_patch[f];
    if (!mesh.face_layers.empty())
      mesh.face_layers[mesh.boundary.size() + kept] = mesh.face_layers[mesh.boundary.size() + f];
    ++kept;
  }
  mesh.interfaces.resize(kept);
  if (!mesh.interface_patch.empty()) mesh.interface_patch.resize(kept);
  if (!mesh.face_layers.empty()) mesh.face_layers.resize(mesh.boundary.size() + kept);
}

void Fins::find(const TetMesh& mesh, std::size_t s, const std::vector<std::uint32_t>& faces) {
  Stand& stand = stands_[s];
  const TriangleTree fins(sheets_[s].surface);
  std::vector<std::pair<double, VertexIndex>> nearest(stand.feet.size(), {TriangleTree::kFar, kNone});
  for (const std::uint32_t f : faces) {
    const Triangle& t = mesh.interfaces[f];
    const Vec3 middle = (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3;
    const std::uint32_t fin = fins.nearest(middle).triangle;
    const auto& [a, b] = stand.feet[fin];
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexIndex v = t[i], w = t[(i + 1) % 3];
      if (stand.is_line && lies_on(mesh.points[v], mesh.points[w], a, b)) stand.edges.push_back(sorted_edge(v, w));
      if (!stand.is_line) nearest[fin] = std::min(nearest[fin], std::pair(squared_length(mesh.points[v] - a), v));
    }
  }
  std::sort(stand.edges.begin(), stand.edges.end());
  stand.edges.erase(std::unique(stand.edges.begin(), stand.edges.end()), stand.edges.end());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    // Its own vertex, unless that was cut off or came onto a wall.
    constexpr double kSame = 1e-3;
    const auto& [x, y, z] = sheets_[s].surface.triangles[i];
    const double foot = squared_length(sheets_[s].surface.points[y] - sheets_[s].surface.points[x]);
    if (nearest[i].first < kSame * kSame * foot) stand.nodes.push_back(nearest[i].second);
  }
  std::sort(stand.nodes.begin(), stand.nodes.end());
  stand.nodes.erase(std::unique(stand.nodes.begin(), stand.nodes.end()), stand.nodes.end());
}

std::vector<std::string> Fins::enter(TetMesh& mesh) const {
  std::vector<std::string> notes;
  for (const Stand& stand : stands_) {
    if (!stand.is_line) {
      std::string note =
          fmt::format("the points {}: {} of {} are nodes", stand.name, stand.nodes.size(), stand.asked.size());
      if (stand.points_outside > 0)
        note += fmt::format(", {} {} outside", stand.points_outside, stand.points_outside == 1 ? "lies" : "lie");
      if (const auto lost = stand.asked.size() - stand.nodes.size() - stand.points_outside; lost > 0)
        note += fmt::format(", {} had no room beside others and walls: a smaller size helps", lost);
      notes.push_back(std::move(note));
      if (!stand.nodes.empty()) mesh.sets.push_back({stand.name, NamedSet::Kind::kNodes, stand.nodes});
      continue;
    }
    double made = 0;
    for (const auto& [a, b] : stand.edges) made += distance(mesh.points[a], mesh.points[b]);
    notes.push_back(
        fmt::format("the line {}: length {:.6g} in {}, of {:.6g} given{}", stand.name, made,
                    counted(stand.edges.size(), "edge"), stand.length,
                    stand.outside > 0 ? fmt::format("; {:.6g} of it lies outside and is cut off", stand.outside) : ""));
    if (stand.edges.empty()) continue;
    const auto curve = static_cast<std::uint32_t>(mesh.curve_names.size());
    mesh.curve.resize(mesh.curve_edges.size(), 0);
    for (const Edge& e : stand.edges) {
      mesh.curve_edges.push_back(e);
      mesh.curve.push_back(curve);
    }
    mesh.curve_names.push_back(stand.name);
  }
  return notes;
}

}  // namespace octafront
