// What became of a damaged model whose answer is known: octafront_judge_answer CASE.json RESULT.
// CASE.json is what bench/models/damage_models.py writes; RESULT a mesh or a surface. Prints one JSON object of
// measurements; bench/run/known_answers.py says what they should be. Knows nothing of repair: it asks the undamaged
// solids.

#include <octafront/octafront.h>

#include "base/core/random.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "made_result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include <fmt/core.h>

namespace {

using namespace octafront;

// All as parts of the diagonal of the undamaged model.
constexpr double kSame = 1e-7;       ///< triangles nearer than this are not looked at closer: far below every limit
constexpr double kSpacing = 4e-3;    ///< of the points at which distances are measured; corners are always among them
constexpr double kAway = 5e-3;       ///< points are asked for inside or outside if the surface is not nearer than this
constexpr double kShallow = 0.03;    ///< half of them are no farther than this
constexpr double kEdgeReach = 0.01;  ///< edges are judged where no other solid is nearer than this

constexpr int kPoints = 10000;
constexpr int kRays = 300;     ///< squared: lines along which the volume of a union is measured
constexpr double kSharp = 30;  ///< edges that bend by more degrees than this are sharp

/// The union of the undamaged solids, and where nobody can know.
class Truth {
 public:
  explicit Truth(const Json& known) {
    for (const auto& name : known["solids"]) {
      solids_.push_back(read_surface(name.get<std::string>()).surface);
      trees_.push_back(std::make_unique<TriangleTree>(solids_.back()));
      box_.add(trees_.back()->box());
    }
    for (std::size_t s = 0; s < solids_.size(); ++s) {
      is_lost_.emplace_back(solids_[s].triangles.size(), 0);
      for (const std::uint32_t t : known["lost"][s]) is_lost_[s][t] = 1;
    }
    for (const auto& d : known["directions"]) directions_.push_back({d[0], d[1], d[2]});
    for (const auto& z : known["zones"]) zones_.push_back(z.get<std::vector<double>>());
    for (const auto& b : known["touched"])
      touched_.push_back({{b[0][0], b[0][1], b[0][2]}, {b[1][0], b[1][1], b[1][2]}});
  }

  const Box3& box() const { return box_; }
  double diagonal() const { return box_.diagonal(); }
  const std::vector<SurfaceMesh>& solids() const { return solids_; }
  const std::vector<std::unique_ptr<TriangleTree>>& trees() const { return trees_; }

  bool in_zone(Vec3 p) const {
    return std::any_of(zones_.begin(), zones_.end(), [&](const auto& zone) {
      for (std::size_t d = 0; d < zone.size(); ++d)
        if (dot(directions_[d], p) > zone[d]) return false;
      return true;
    });
  }
  bool is_touched(Vec3 p) const {
    return std::any_of(touched_.begin(), touched_.end(), [&](const Box3& b) { return b.contains(p); });
  }
  bool contains(Vec3 p) const {
    return std::any_of(trees_.begin(), trees_.end(), [&](const auto& t) { return t->winding_number(p) != 0; });
  }
  /// At most the distance to the surface of the union, and exactly that for a single solid and for points outside.
  double distance_to(Vec3 p) const {
    double nearest = TriangleTree::kFar, deepest = 0;
    for (const auto& t : trees_) {
      const double d = std::sqrt(t->nearest(p).squared_distance);
      nearest = std::min(nearest, d);
      if (trees_.size() > 1 && t->contains(p)) deepest = std::max(deepest, d);
    }
    return deepest > 0 ? deepest : nearest;
  }
  /// Whether the damage is at that triangle: it was no longer there as it had been.
  bool is_lost(std::size_t solid, std::uint32_t triangle) const { return is_lost_[solid][triangle] != 0; }
  /// Whether it is at the place nearest to a point.
  bool is_near_damage(Vec3 p) const {
    double nearest = TriangleTree::kFar;
    bool is_near = false;
    for (std::size_t s = 0; s < trees_.size(); ++s) {
      const auto found = trees_[s]->nearest(p);
      if (found.squared_distance >= nearest) continue;
      nearest = found.squared_distance;
      is_near = is_lost(s, found.triangle);
    }
    return is_near;
  }
  /// Whether a point of one solid's surface is also one of the union's: not inside another solid, nor within `margin`.
  bool is_bare(Vec3 p, std::size_t solid, double margin) const {
    for (std::size_t i = 0; i < trees_.size(); ++i)
      if (i != solid && (trees_[i]->contains(p) || (margin > 0 && trees_[i]->is_within(p, margin)))) return false;
    return true;
  }
  /// Exact for a single solid, else by lines along z.
  double volume() const {
    if (solids_.size() == 1) return enclosed_volume(solids_[0]);
    const Vec3 step = box_.extent() / kRays;
    Random random(1);
    double length = 0;
    for (int i = 0; i < kRays; ++i)
      for (int j = 0; j < kRays; ++j)
        length += length_inside(box_.lo.x + (i + random.unit()) * step.x, box_.lo.y + (j + random.unit()) * step.y);
    return length * step.x * step.y;
  }

 private:
  double length_inside(double x, double y) const {
    std::vector<std::pair<double, int>> crossings;  // z, and by how much the number of solids around changes
    const Vec3 p{x, y, box_.lo.z - 1}, q{x, y, box_.hi.z + 1};
    for (const auto& tree : trees_)
      tree->for_each_hit(p, q, [&](std::uint32_t t, const SegmentHit&) {
        const TriangleCorners& c = tree->corners(t);
        const Vec3 n = double_area_normal(c[0], c[1], c[2]);
        if (n.z != 0) crossings.push_back({c[0].z - (n.x * (x - c[0].x) + n.y * (y - c[0].y)) / n.z, n.z < 0 ? 1 : -1});
      });
    std::sort(crossings.begin(), crossings.end());
    double sum = 0;
    int depth = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      if (depth > 0) sum += crossings[i].first - crossings[i - 1].first;
      depth += crossings[i].second;
    }
    return sum;
  }

  std::vector<SurfaceMesh> solids_;
  std::vector<std::unique_ptr<TriangleTree>> trees_;
  std::vector<Vec3> directions_;
  std::vector<std::vector<double>> zones_;
  std::vector<Box3> touched_;
  std::vector<std::vector<char>> is_lost_;  ///< per solid and triangle
  Box3 box_;
};

/// Both ways, at the damage and in all.
Json distances(const Truth& truth, const SurfaceMesh& made, const TriangleTree& tree) {
  const double spacing = kSpacing * truth.diagonal();
  Farthest to_truth, from_truth, to_damage, from_damage;
  const double same = kSame * truth.diagonal();
  for (const Triangle& t : made.triangles) {
    const TriangleCorners c = corners_of(made, t);
    if (truth.trees().size() == 1 && farthest_from_one(c, *truth.trees()[0]) < same) continue;
    sample(c, spacing, [&](Vec3 p) {
      if (truth.in_zone(p)) return;
      const double d = truth.distance_to(p);
      to_truth.add(d, p);
      if (d > to_damage.distance && truth.is_near_damage(p)) to_damage.add(d, p);
    });
  }
  for (std::size_t s = 0; s < truth.solids().size(); ++s)
    for (std::uint32_t t = 0; t < truth.solids()[s].triangles.size(); ++t) {
      const TriangleCorners c = corners_of(truth.solids()[s], truth.solids()[s].triangles[t]);
      if (farthest_from_one(c, tree) < same) continue;
      sample(c, spacing, [&](Vec3 p) {
        if (truth.in_zone(p) || !truth.is_bare(p, s, 0)) return;
        const double d = std::sqrt(tree.nearest(p).squared_distance);
        from_truth.add(d, p);
        if (truth.is_lost(s, t)) from_damage.add(d, p);
      });
    }
  const double diagonal = truth.diagonal();
  return {{"to_truth", to_truth.json(diagonal)},
          {"from_truth", from_truth.json(diagonal)},
          {"to_damage", to_damage.json(diagonal)},
          {"from_damage", from_damage.json(diagonal)}};
}

/// Points in the box, and points near the surface: half of each.
Json sides(const Truth& truth, const TriangleTree& tree) {
  Random random(2);
  const auto in_box = [&] {
    const Vec3 e = truth.box().extent();
    const auto at = [&](double lo, double size) { return lo + (1.2 * random.unit() - 0.1) * size; };
    return Vec3{at(truth.box().lo.x, e.x), at(truth.box().lo.y, e.y), at(truth.box().lo.z, e.z)};
  };
  const auto near_surface = [&] {
    const SurfaceMesh& s = truth.solids()[random.below(truth.solids().size())];
    const TriangleCorners c = corners_of(s, s.triangles[random.below(s.triangles.size())]);
    double u = random.unit(), v = random.unit();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3 way{random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5};
    return c[0] + (c[1] - c[0]) * u + (c[2] - c[0]) * v +
           normalized(way) * (random.unit() * kShallow * truth.diagonal());
  };
  int asked = 0, inside = 0, wrong = 0;
  Vec3 at;
  for (int tries = 0; asked < kPoints && tries < 20 * kPoints; ++tries) {
    const Vec3 p = tries % 2 ? in_box() : near_surface();
    if (truth.in_zone(p) || truth.distance_to(p) < kAway * truth.diagonal()) continue;
    const bool is_inside = truth.contains(p);
    ++asked;
    inside += is_inside;
    if (is_inside == (tree.winding_number(p) == 1)) continue;
    if (wrong++ == 0) at = p;
  }
  return {{"asked", asked}, {"inside", inside}, {"wrong", wrong}, {"first_at", {at.x, at.y, at.z}}};
}

/// Sharp edges of the solids, where nothing was damaged: how far they are from the result.
Json sharp_edges(const Truth& truth, const TriangleTree& tree) {
  Farthest farthest;
  int points = 0;
  for (std::size_t i = 0; i < truth.solids().size(); ++i) {
    const SurfaceMesh& s = truth.solids()[i];
    std::map<Edge, Vec3> normals;
    for (const Triangle& t : s.triangles) {
      const Vec3 n = unit_normal(s.points[t[0]], s.points[t[1]], s.points[t[2]]);
      for (int k = 0; k < 3; ++k) {
        const VertexIndex a = t[k], b = t[(k + 1) % 3];
        const auto [other, is_first] = normals.insert({{std::min(a, b), std::max(a, b)}, n});
        if (is_first || dot(n, other->second) > std::cos(kSharp * std::acos(-1.0) / 180)) continue;
        const int steps = 1 + static_cast<int>(distance(s.points[a], s.points[b]) / (kSpacing * truth.diagonal()));
        for (int j = 0; j <= steps; ++j) {
          const Vec3 p = s.points[a] + (s.points[b] - s.points[a]) * (static_cast<double>(j) / steps);
          if (truth.is_touched(p) || truth.in_zone(p) || !truth.is_bare(p, i, kEdgeReach * truth.diagonal())) continue;
          ++points;
          farthest.add(std::sqrt(tree.nearest(p).squared_distance), p);
        }
      }
    }
  }
  Json j = farthest.json(truth.diagonal());
  j["points"] = points;
  return j;
}

Json judge(const Json& known, const std::string& file) {
  const Truth truth(known);
  const MadeResult made = read_result(file);
  if (made.boundary.triangles.empty()) return {{"empty", true}};
  const TriangleTree tree(made.boundary);
  Json j = made.about;
  j["volume_percent"] = 100 * (enclosed_volume(made.boundary) / truth.volume() - 1);
  j.update(distances(truth, made.boundary, tree));
  j["sides"] = sides(truth, tree);
  j["sharp_edges"] = sharp_edges(truth, tree);
  return j;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("octafront_judge_answer CASE.json MESH|SURFACE.off\n", stderr);
    return 2;
  }
  try {
    std::ifstream in(argv[1]);
    fmt::print("{}\n", judge(Json::parse(in), argv[2]).dump());
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 3;
  }
  return 0;
}
