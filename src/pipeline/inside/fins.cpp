#include "pipeline/inside/fins.h"

#include <octafront/error.h>
#include <octafront/named_groups.h>

#include "base/core/wording.h"
#include "base/geometry/predicates.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/face_table.h"
#include "pipeline/inside/polygons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace octafront {
namespace {

/// Height of a fin over its foot, of the foot's length: its triangle is nearly equilateral.
constexpr double kHeight = 0.85;

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
  Places(const KnownSurface& walls, std::vector<Vec3> others) : walls_(walls), others_(std::move(others)) {}

  double worth(Vec3 tip, double reach) const {
    const auto near = walls_.tree().nearest(tip);
    if (is_outside(tip, near)) return -1;
    double worth = std::min(1.0, std::sqrt(near.squared_distance) / reach);
    for (const Vec3& other : others_) worth = std::min(worth, 0.5 * distance(tip, other) / reach);
    return worth;
  }

 private:
  bool is_outside(Vec3 tip, const TriangleTree::Nearest& near) const {
    const auto& [a, b, c] = walls_.mesh().triangles[near.triangle];
    const auto& p = walls_.mesh().points;
    const Sides sides = walls_.mesh().sides_of(near.triangle);
    const int side = orient3d(p[a], p[b], p[c], tip);  // above 0: in front
    return side != 0 && sides[side > 0 ? 0 : 1] == kNone;
  }

  const KnownSurface& walls_;
  std::vector<Vec3> others_;
};

/// The best of some tips; the first of equals.
Vec3 best_tip(const Places& places, const std::vector<Vec3>& tips, double reach) {
  std::size_t best = 0;
  double most = -2;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    const double worth = places.worth(tips[i], reach);
    // Neighbours choose alike where rounding alone makes a difference.
    constexpr double kMore = 1e-3;
    if (worth > most + kMore) most = worth, best = i;
  }
  return tips[best];
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

void add_fin(SurfaceMesh& sheet, const std::array<Vec3, 3>& corners) {
  const auto first = static_cast<VertexIndex>(sheet.points.size());
  sheet.points.insert(sheet.points.end(), corners.begin(), corners.end());
  sheet.triangles.push_back({first, first + 1, first + 2});
}

/// Corners at the same place are one vertex, so that fins hang together where their feet do.
void merge_points(SurfaceMesh& sheet) {
  std::map<std::array<double, 3>, VertexIndex> at;
  std::vector<Vec3> points;
  for (Triangle& t : sheet.triangles)
    for (VertexIndex& v : t) {
      const Vec3 p = sheet.points[v];
      const auto [found, is_new] = at.try_emplace({p.x, p.y, p.z}, static_cast<VertexIndex>(points.size()));
      if (is_new) points.push_back(p);
      v = found->second;
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

double length_of(const std::vector<Vec3>& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < polygon.size(); ++i) sum += distance(polygon[i], polygon[i + 1]);
  return sum;
}

}  // namespace

Fins::Fins(const std::vector<LineNet>& lines, const std::vector<PointSet>& points, const SizeField& sizes,
           const std::vector<NamedSize>& named, const KnownSurface& walls) {
  for (const LineNet& l : lines) stand_on(l, capped(sizes, named, l.name), walls);
  for (const PointSet& p : points) stand_on(p, capped(sizes, named, p.name), walls);
  for (Sheet& sheet : sheets_) merge_points(sheet.surface);
}

void Fins::stand_on(const LineNet& lines, const SizeField& sizes, const KnownSurface& walls) {
  Stand stand{lines.name};
  Sheet sheet{lines.name, {}};
  for (const std::vector<Vec3>& polygon : polygons_of(lines)) {
    stand.length += length_of(polygon);
    const std::vector<Vec3> p = divided(polygon, sizes, walls.tree());
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
      std::vector<Vec3> others;
      if (i > 0) others.push_back(p[i - 1]);
      if (i + 2 < p.size()) others.push_back(p[i + 2]);
      const double foot = distance(p[i], p[i + 1]), height = kHeight * foot;
      const auto [u, v] = across(p[i + 1] - p[i]);
      std::vector<Vec3> tips;
      for (const auto& [x, y] : kAround) tips.push_back(0.5 * (p[i] + p[i + 1]) + height * (x * u + y * v));
      add_fin(sheet.surface, {p[i], p[i + 1], best_tip(Places(walls, std::move(others)), tips, height)});
      stand.feet.push_back({p[i], p[i + 1]});
    }
  }
  stands_.push_back(std::move(stand));
  sheets_.push_back(std::move(sheet));
}

void Fins::stand_on(const PointSet& points, const SizeField& sizes, const KnownSurface& walls) {
  if (points.points.empty()) throw InputError(fmt::format("the points {}: there is none", points.name));
  Stand stand{points.name, false};
  Sheet sheet{points.name, {}};
  for (const Vec3& p : points.points) {
    if (!is_finite(p)) throw InputError(fmt::format("the points {}: one is not finite", points.name));
    if (std::find(stand.asked.begin(), stand.asked.end(), p) != stand.asked.end()) continue;
    double foot = sizes.at(p);
    std::vector<Vec3> others;
    for (const Vec3& q : points.points)
      if (q != p) foot = std::min(foot, 0.5 * distance(p, q));
    std::vector<Vec3> tips;
    for (const int axis : {0, 1, 2})
      for (const double sign : {1.0, -1.0}) {
        Vec3 along{};
        along[axis] = sign * foot;
        tips.push_back(p + along);
      }
    const Places places(walls, {});
    const Vec3 first = best_tip(places, tips, foot);
    // The second one at 60 degrees to the first.
    const auto [u, v] = across(first - p);
    tips.clear();
    for (const auto& [x, y] : kAround)
      tips.push_back(p + 0.5 * (first - p) + foot * std::numbers::sqrt3 / 2 * (x * u + y * v));
    add_fin(sheet.surface, {p, first, best_tip(places, tips, foot)});
    stand.feet.push_back({p, p});
    stand.asked.push_back(p);
  }
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
  std::vector<std::pair<double, VertexIndex>> nearest(stand.asked.size(), {TriangleTree::kFar, kNone});
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
      notes.push_back(fmt::format("the points {}: {} of {} are nodes{}", stand.name, stand.nodes.size(),
                                  stand.asked.size(),
                                  stand.nodes.size() < stand.asked.size() ? ", the others lie outside" : ""));
      if (!stand.nodes.empty()) mesh.sets.push_back({stand.name, NamedSet::Kind::kNodes, stand.nodes});
      continue;
    }
    double made = 0;
    for (const auto& [a, b] : stand.edges) made += distance(mesh.points[a], mesh.points[b]);
    notes.push_back(fmt::format("the line {}: length {:.6g} in {}, of {:.6g} given", stand.name, made,
                                counted(stand.edges.size(), "edge"), stand.length));
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
