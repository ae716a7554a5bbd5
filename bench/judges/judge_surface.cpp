// One judge for every surface mesh, ours or a peer's. Prints one JSON object.
//   octafront_judge_surface MODEL [--size H | --triangles N] [-o FILE]   makes it with octafront, and judges it
//       [--only times]                                                   and says no more than what it took
//   octafront_judge_surface MODEL --size H --made FILE                   judges what somebody else made
// Validity and topology, Hausdorff distance, edges against sizes, shapes of triangles, straight feature lines.

#include <octafront/octafront.h>

#include "base/geometry/hausdorff.h"
#include "base/geometry/measures.h"
#include "base/mesh/features.h"
#include "pipeline/stages/measure.h"
#include "sizing/sources/make_size_field.h"
#include "surface/remeshing/surface_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>

#include <fmt/core.h>

namespace {

using namespace octafront;
using Json = nlohmann::ordered_json;

/// Sampling density of the Hausdorff distance, as a part of the diagonal.
constexpr double kHausdorffTolerance = 4e-4;
/// Triangles below this 2r/R are bad; from a feature angle below kForcing degrees no better one can be made.
constexpr double kBad = 0.4, kForcing = 13;
/// Edges of features shorter than this part of the wanted length are details finer than the size, and so are two lines
/// side by side nearer than this part of the size that was asked for (wider strips get smaller triangles).
constexpr double kDetail = 0.35, kStrip = 0.08;
constexpr double kStraight = 1e-9, kOnLine = 1e-9;
/// Straight lines shorter than this many of the sizes asked for may be noise to the remesher.
constexpr double kLongLine = 4;
/// A bend at the end of a straight line, where the curve goes on, may be cut by this many sizes.
constexpr double kCutBend = 1.5;
constexpr double kBendCosine = 0.766;

struct Arguments {
  std::string model, made, output;
  std::optional<double> size;
  std::optional<double> triangles;
  bool only_times = false;
};

struct Judged {
  SurfaceMesh surface;
  SizeField sizes = SizeField::uniform(1);
  SizeField asked = SizeField::uniform(1);
  Report report;
};

double cpu_of(const Report& report, const std::string& stage) {
  for (const StageReport& s : report.stages)
    if (s.name == stage) return s.cpu_seconds;
  return 0;
}

/// Feature edges of a mesh, and which vertices lie on one.
struct FeatureMarks {
  std::vector<Edge> edges;
  std::vector<char> on;

  FeatureMarks(std::vector<Edge> sorted, std::size_t vertices) : edges(std::move(sorted)), on(vertices, 0) {
    for (const Edge& e : edges) on[e[0]] = on[e[1]] = 1;
  }
  bool is_feature(VertexIndex a, VertexIndex b) const {
    return std::binary_search(edges.begin(), edges.end(), Edge{std::min(a, b), std::max(a, b)});
  }
};

/// Whether the features leave no room for a good triangle: they enclose less than kForcing degrees, are divided by
/// corners closer than kDetail of the size, or run past each other closer than kStrip of the size asked.
bool is_forced(const SurfaceMesh& s, const Triangle& t, const FeatureMarks& features, const Judged& made) {
  for (int i = 0; i < 3; ++i) {
    const VertexIndex a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    const Vec3 pa = s.points[a], pb = s.points[b], pc = s.points[c];
    const Vec3 middle = (pa + pb) * 0.5;
    const double l = distance(pa, pb), strip = kStrip * made.asked.at(middle);
    if (features.on[a] && features.on[b] && l < strip) return true;
    if (!features.is_feature(a, b)) continue;
    if (l < kDetail * made.sizes.at(middle)) return true;
    if (features.is_feature(a, c) && angle_at(pa, pb, pc) < kForcing * std::numbers::pi / 180) return true;
    const bool is_longest = l >= distance(pb, pc) && l >= distance(pc, pa);
    if (is_longest && features.on[c] && 2 * triangle_area(pa, pb, pc) < strip * l) return true;
  }
  return false;
}

Json shapes(const Judged& made, const std::vector<Edge>& feature_edges) {
  const SurfaceMesh& s = made.surface;
  const SizeField& sizes = made.sizes;
  const FeatureMarks features(feature_edges, s.points.size());
  double sum = 0, least = 2, least_free = 2;
  std::size_t bad = 0, bad_free = 0, worst = 0;
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    const Triangle& t = s.triangles[i];
    const double q = triangle_radius_ratio(s.points[t[0]], s.points[t[1]], s.points[t[2]]);
    sum += q;
    least = std::min(least, q);
    if (q >= least_free && q >= kBad) continue;
    bad += q < kBad;
    if (is_forced(s, t, features, made)) continue;
    bad_free += q < kBad;
    if (q < least_free) worst = i;
    least_free = std::min(least_free, q);
  }
  const Triangle& w = s.triangles[worst];
  const Vec3 at = (s.points[w[0]] + s.points[w[1]] + s.points[w[2]]) / 3;
  return {{"quality_mean", sum / static_cast<double>(s.triangles.size())},
          {"quality_min", least},
          {"quality_min_free", std::min(1.0, least_free)},
          {"bad", bad},
          {"bad_free", bad_free},
          {"worst_at", {at.x, at.y, at.z}},
          {"worst_size", sizes.at(at)}};
}

struct Line {
  Vec3 a, b;
  double allowed = 0;  ///< length that may be missing: where the line goes on around a bend, the new edges cut the bend
  double covered = 0;
};

/// Straight lines of the input: chains of feature edges without a bend, longer than a few sizes.
std::vector<Line> straight_lines(const SurfaceMesh& s, const Features& features, const SizeField& sizes) {
  std::map<VertexIndex, std::vector<VertexIndex>> across;
  for (const Edge& e : features.edges) {
    across[e[0]].push_back(e[1]);
    across[e[1]].push_back(e[0]);
  }
  const auto straight_on = [&](VertexIndex from, VertexIndex v) {
    const auto& next = across[v];
    if (next.size() != 2) return kNone;
    const VertexIndex to = next[0] == from ? next[1] : next[0];
    const Vec3 u = normalized(s.points[v] - s.points[from]), w = normalized(s.points[to] - s.points[v]);
    return dot(u, w) > 0 && length(cross(u, w)) < kStraight ? to : kNone;
  };
  std::vector<Line> lines;
  for (const auto& [start, nexts] : across) {
    for (const VertexIndex first : nexts) {
      if (nexts.size() == 2 && straight_on(first, start) != kNone) continue;  // not an end
      VertexIndex from = start, v = first;
      for (VertexIndex to; (to = straight_on(from, v)) != kNone; v = to) from = v;
      if (start > v) continue;
      const Vec3 a = s.points[start], b = s.points[v];
      const double h = sizes.at((a + b) * 0.5);
      if (distance(a, b) <= kLongLine * h) continue;
      const auto goes_on = [&](VertexIndex end, Vec3 inward) {
        if (across[end].size() != 2) return false;
        for (const VertexIndex w : across[end])
          if (dot(normalized(s.points[w] - s.points[end]), inward) < -kBendCosine) return true;
        return false;
      };
      const Vec3 d = normalized(b - a);
      lines.push_back({a, b, kCutBend * h * (goes_on(start, d) + goes_on(v, -d))});
    }
  }
  return lines;
}

/// How many of the lines are not covered by feature edges of the result within kOnLine of the diagonal.
std::size_t lines_missing(std::vector<Line>& lines, const SurfaceMesh& made, const std::vector<Edge>& edges,
                          double diagonal) {
  const double near = kOnLine * diagonal;
  std::size_t missing = 0;
  for (Line& line : lines) {
    for (const Edge& e : edges) {
      const Vec3 p = made.points[e[0]], q = made.points[e[1]];
      if (distance(closest_point_on_segment(p, line.a, line.b), p) > near) continue;
      if (distance(closest_point_on_segment(q, line.a, line.b), q) > near) continue;
      line.covered += distance(p, q);
    }
    missing += line.covered < distance(line.a, line.b) - line.allowed - 100 * near;
  }
  return missing;
}

Json judge(const Judged& made, const SurfaceMesh& input, double feature_angle) {
  const double diagonal = bounding_box(input.points).diagonal();
  const HausdorffBounds h = hausdorff_distance(made.surface, input, kHausdorffTolerance * diagonal);
  const auto defect = first_surface_defect(made.surface, input);
  const SizeSummary edges = summarize_surface_edges(made.surface.points, made.surface.triangles, made.sizes);
  const Features wanted = detect_features(input, feature_angle), found = detect_features(made.surface, 20);
  std::vector<Line> lines = straight_lines(input, wanted, made.asked);
  Json j{{"triangles", made.surface.triangles.size()},
         {"defect", defect ? Json(*defect) : Json(nullptr)},
         {"hausdorff_percent", 100 * h.upper / diagonal},
         {"hausdorff_lower_percent", 100 * h.lower / diagonal},
         {"edge_ratio", edges.mean_ratio},
         {"edges_within", edges.share_within},
         {"straight_lines", lines.size()}};
  j["straight_lines_missing"] = lines_missing(lines, made.surface, found.edges, diagonal);
  j.update(shapes(made, found.edges));
  return j;
}

Judged make(const SurfaceMesh& input, const Arguments& a) {
  Options options;
  options.size.size = a.size;
  // Equilateral triangles: area = sqrt(3) / 4 h^2.
  if (a.triangles) options.size.size = std::sqrt(area(input) * 4 / std::sqrt(3.0) / *a.triangles);
  SurfaceResult result = generate_surface(input, options);
  StageReport ignored;
  const KnownSurface known(input, options.surface.angle_of_features());
  SizeField asked = make_size_field(known, options.size, {{}, ignored});
  return {std::move(result.surface), result.sizes, std::move(asked), std::move(result.report)};
}

Arguments parse(int argc, char** argv) {
  Arguments a;
  a.model = argv[1];
  for (int i = 2; i + 1 < argc; i += 2) {
    const std::string key = argv[i], value = argv[i + 1];
    if (key == "--size") a.size = std::stod(value);
    if (key == "--triangles") a.triangles = std::stod(value);
    if (key == "--made") a.made = value;
    if (key == "-o") a.output = value;
    if (key == "--only") a.only_times = value == "times";
  }
  return a;
}

Json run(const Arguments& a) {
  const SurfaceMesh input = repair_surface(read_surface(a.model).surface).surface;
  Judged made;
  if (a.made.empty()) {
    made = make(input, a);
  } else {
    // STL files repeat the corners of every triangle; repair merges what is equal and changes nothing else here.
    made.surface = repair_surface(read_surface(a.made).surface).surface;
    made.sizes = made.asked = SizeField::uniform(a.size.value());
  }
  if (!a.output.empty()) write_surface(a.output, made.surface);
  Json j{{"triangles", made.surface.triangles.size()}, {"defect", nullptr}};
  if (!a.only_times) j = judge(made, input, kDefaultFeatureAngle);
  j["input_triangles"] = input.triangles.size();
  j["size_seconds"] = cpu_of(made.report, "size field");
  j["front_seconds"] = cpu_of(made.report, "surface front");
  Json notes = Json::array(), counters = Json::object();
  for (const StageReport& s : made.report.stages) {
    for (const std::string& n : s.notes) notes.push_back(n);
    if (s.name != "surface front") continue;
    for (const auto& [key, value] : s.counters) counters[key] = value;
  }
  j["counters"] = counters;
  j["notes"] = notes;
  return j;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("octafront_judge_surface MODEL [--size H | --triangles N] [--made FILE] [-o FILE] [--only times]\n",
               stderr);
    return 2;
  }
  try {
    fmt::print("{}\n", run(parse(argc, argv)).dump());
  } catch (const Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 3;
  }
  return 0;
}
