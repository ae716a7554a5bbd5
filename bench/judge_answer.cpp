// What became of a damaged model whose answer is known: octafront_judge_answer CASE.json RESULT.
// CASE.json is what scripts/damage-models.py writes; RESULT a mesh or a surface. Prints one JSON object of
// measurements; bench/known_answers.py says what they should be. Knows nothing of repair: it asks the undamaged solids.

#include <octafront/octafront.h>

#include "core/disjoint_sets.h"
#include "core/random.h"
#include "geometry/measures.h"
#include "geometry/triangle_tree.h"

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
using Json = nlohmann::ordered_json;

// All as parts of the diagonal of the undamaged model.
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
    for (const auto& d : known["directions"]) directions_.push_back({d[0], d[1], d[2]});
    for (const auto& z : known["zones"]) zones_.push_back(z.get<std::vector<double>>());
    for (const auto& b : known["touched"])
      touched_.push_back({{b[0][0], b[0][1], b[0][2]}, {b[1][0], b[1][1], b[1][2]}});
  }

  const Box3& box() const { return box_; }
  double diagonal() const { return box_.diagonal(); }
  const std::vector<SurfaceMesh>& solids() const { return solids_; }

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
  Box3 box_;
};

/// Calls visit(p) for the corners of a triangle and points inside it, none farther from the next than `spacing`.
template <class Visit>
void sample(const TriangleCorners& t, double spacing, Visit&& visit) {
  const double longest = std::sqrt(longest_squared_edge(t[0], t[1], t[2]));
  const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      visit(t[0] + (t[1] - t[0]) * (static_cast<double>(i) / n) + (t[2] - t[0]) * (static_cast<double>(j) / n));
  visit(centroid(t[0], t[1], t[2]));
}

struct Farthest {
  double distance = 0;
  Vec3 at;
  void add(double d, Vec3 p) {
    if (d > distance) *this = {d, p};
  }
  Json json(double diagonal) const { return {{"distance", distance / diagonal}, {"at", {at.x, at.y, at.z}}}; }
};

TriangleCorners corners_of(const SurfaceMesh& s, const Triangle& t) {
  return {s.points[t[0]], s.points[t[1]], s.points[t[2]]};
}

Json distances(const Truth& truth, const SurfaceMesh& made, const TriangleTree& tree) {
  const double spacing = kSpacing * truth.diagonal();
  Farthest to_truth, from_truth;
  for (const Triangle& t : made.triangles)
    sample(corners_of(made, t), spacing, [&](Vec3 p) {
      if (!truth.in_zone(p)) to_truth.add(truth.distance_to(p), p);
    });
  for (std::size_t s = 0; s < truth.solids().size(); ++s)
    for (const Triangle& t : truth.solids()[s].triangles)
      sample(corners_of(truth.solids()[s], t), spacing, [&](Vec3 p) {
        if (!truth.in_zone(p) && truth.is_bare(p, s, 0)) from_truth.add(std::sqrt(tree.nearest(p).squared_distance), p);
      });
  return {{"to_truth", to_truth.json(truth.diagonal())}, {"from_truth", from_truth.json(truth.diagonal())}};
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

/// The faces of only one tetrahedron, found anew: what the file calls its boundary is not believed.
std::vector<Triangle> single_faces(const TetMesh& mesh, std::uint32_t& components) {
  std::vector<std::pair<Triangle, std::uint32_t>> faces;  // sorted corners, 4 * tet + face
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t)
    for (std::uint32_t f = 0; f < 4; ++f) {
      Triangle key;
      for (int k = 0; k < 3; ++k) key[k] = mesh.tets[t][kTetFaces[f][k]];
      std::sort(key.begin(), key.end());
      faces.push_back({key, 4 * t + f});
    }
  std::sort(faces.begin(), faces.end());
  DisjointSets sets(mesh.tets.size());
  std::vector<Triangle> single;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i + 1 < faces.size() && faces[i].first == faces[i + 1].first) {
      sets.join(faces[i].second / 4, faces[i + 1].second / 4);
      ++i;
      continue;
    }
    const Tet& tet = mesh.tets[faces[i].second / 4];
    const auto& f = kTetFaces[faces[i].second % 4];
    single.push_back({tet[f[0]], tet[f[1]], tet[f[2]]});
  }
  components = 0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) components += sets.find(t) == t;
  return single;
}

/// Counts of a surface: shells, genus, edges without just two triangles that agree, vertices with more than one fan.
Json kind_of(const SurfaceMesh& s) {
  std::map<Edge, std::array<int, 2>> edges;
  DisjointSets shells(s.points.size()), fans(3 * s.triangles.size());
  std::map<Edge, std::uint32_t> half;
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const VertexIndex a = s.triangles[t][k], b = s.triangles[t][(k + 1) % 3];
      ++edges[{std::min(a, b), std::max(a, b)}][a < b];
      shells.join(a, b);
      half[{a, b}] = 3 * t + k;
    }
  std::size_t bad_edges = 0, used = 0, roots = 0, fan_count = 0;
  for (const auto& [e, n] : edges) bad_edges += n[0] != 1 || n[1] != 1;
  // Corners at one vertex belong to one fan if their triangles share an edge there.
  for (const auto& [e, h] : half) {
    const auto other = half.find({e[1], e[0]});
    if (other == half.end()) continue;
    const auto next = [](std::uint32_t c) { return c / 3 * 3 + (c + 1) % 3; };
    fans.join(h, next(other->second));
    fans.join(next(h), other->second);
  }
  for (std::uint32_t c = 0; c < 3 * s.triangles.size(); ++c) fan_count += fans.find(c) == c;
  std::vector<bool> is_used(s.points.size());
  for (const Triangle& t : s.triangles)
    for (const VertexIndex v : t) is_used[v] = true;
  for (VertexIndex v = 0; v < s.points.size(); ++v) {
    used += is_used[v];
    roots += is_used[v] && shells.find(v) == v;
  }
  const auto euler =
      static_cast<long>(fan_count) - static_cast<long>(edges.size()) + static_cast<long>(s.triangles.size());
  return {{"triangles", s.triangles.size()},
          {"shells", roots},
          {"genus", static_cast<long>(roots) - euler / 2},
          {"bad_edges", bad_edges},
          {"bad_vertices", static_cast<long>(fan_count) - static_cast<long>(used)}};
}

/// Solids of a closed surface: shells that face outward.
std::uint32_t outward_shells(const SurfaceMesh& s) {
  DisjointSets sets(s.points.size());
  for (const Triangle& t : s.triangles) sets.join(t[0], t[1]), sets.join(t[1], t[2]);
  std::map<std::uint32_t, double> volumes;
  for (const Triangle& t : s.triangles)
    volumes[sets.find(t[0])] += six_volumes(s.points[0], s.points[t[0]], s.points[t[1]], s.points[t[2]]);
  return static_cast<std::uint32_t>(
      std::count_if(volumes.begin(), volumes.end(), [](const auto& v) { return v.second > 0; }));
}

Json judge(const Json& known, const std::string& file) {
  const Truth truth(known);
  SurfaceMesh made;
  Json j;
  std::uint32_t components = 0;
  if (file.ends_with(".off")) {
    made = read_surface(file).surface;
    components = outward_shells(made);
  } else {
    const TetMesh mesh = read_mesh(file);
    const auto defect = first_defect(mesh);
    const QualitySummary q = summarize_quality(mesh);
    made.points = mesh.points;
    made.triangles = single_faces(mesh, components);
    std::uint32_t regions = 1;
    for (const std::uint32_t r : mesh.region) regions = std::max(regions, r + 1);
    j = {{"tets", mesh.tets.size()},
         {"defect", defect ? Json(*defect) : Json(nullptr)},
         {"regions", regions},
         {"beta_mean", q.beta_mean},
         {"dihedral_min", q.dihedral_min},
         {"dihedral_max", q.dihedral_max}};
  }
  if (made.triangles.empty()) return {{"empty", true}};
  const TriangleTree tree(made);
  j["components"] = components;
  j.update(kind_of(made));
  j["volume_percent"] = 100 * (enclosed_volume(made) / truth.volume() - 1);
  j.update(distances(truth, made, tree));
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
