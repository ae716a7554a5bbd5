// Second order, measured: octafront_second_order shapes | FILE [SIZE]
//   shapes   balls, tori and cylinders at three sizes, made of first and of second order: how far their boundaries are
//            from the true surface; one JSON object a line
//   FILE     a surface meshed at an automatic size, or SIZE, of first and of second order: is every element proven, and
//            what does it cost? one JSON object

#include <octafront/octafront.h>

#include "support/named_surfaces.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace {

using namespace octafront;
using Json = nlohmann::ordered_json;

// --- true surfaces

constexpr double kMajor = 1, kMinor = 0.35, kHeight = 2;

double from_ball(Vec3 p) {
  return std::abs(length(p) - 1);
}
double from_torus(Vec3 p) {
  return std::abs(std::hypot(std::hypot(p.x, p.y) - kMajor, p.z) - kMinor);
}
double from_cylinder(Vec3 p) {
  return std::min({std::abs(std::hypot(p.x, p.y) - 1), std::abs(p.z), std::abs(p.z - kHeight)});
}

Vec3 to_ball(Vec3 p) {
  return normalized(p);
}
Vec3 to_torus(Vec3 p) {
  const Vec3 center = kMajor * normalized(Vec3{p.x, p.y, 0});
  return center + kMinor * normalized(p - center);
}
Vec3 to_cylinder(Vec3 p) {
  const double r = std::hypot(p.x, p.y), side = std::abs(r - 1), bottom = std::abs(p.z), top = std::abs(p.z - kHeight);
  const double near = 1e-9;  // of the front: vertices lie on the fine input, whose rims are on both
  if (bottom < side || bottom < near) p.z = 0;
  if (top < side || top < near) p.z = kHeight;
  if (side <= std::min(bottom, top) + near) p = {p.x / r, p.y / r, p.z};
  return p;
}

/// A closed cylinder about the z axis, of n sides, as CAD writes it: sides from rim to rim.
SurfaceMesh cylinder(VertexIndex n) {
  SurfaceMesh s;
  for (const double z : {0.0, kHeight})
    for (VertexIndex i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n;
      s.points.push_back({std::cos(a), std::sin(a), z});
    }
  s.points.push_back({0, 0, 0});
  s.points.push_back({0, 0, kHeight});
  for (VertexIndex i = 0; i < n; ++i) {
    const VertexIndex j = (i + 1) % n;
    s.triangles.insert(s.triangles.end(), {{i, j, n + j}, {i, n + j, n + i}, {j, i, 2 * n}, {n + i, n + j, 2 * n + 1}});
  }
  return s;
}

struct Shape {
  const char* name;
  SurfaceMesh input;
  std::function<double(Vec3)> distance;
};

/// As a mesher or a scanner would leave it: irregular triangles, with vertices exactly on the true surface.
SurfaceMesh irregular(const SurfaceMesh& fine, double size, Vec3 (*onto)(Vec3)) {
  Options options;
  options.size.size = size;
  SurfaceMesh made = generate_surface(fine, options).surface;
  for (Vec3& p : made.points) p = onto(p);
  made.source.clear();
  return made;
}

std::vector<Shape> shapes() {
  std::vector<Shape> all;
  all.push_back({"ball, 81920 regular triangles", octafront::testing::icosphere(6), from_ball});
  all.push_back(
      {"ball, irregular triangles of .025", irregular(octafront::testing::icosphere(7), 0.025, to_ball), from_ball});
  all.push_back({"torus, 384 x 144 regular", octafront::testing::torus(384, 144, kMajor, kMinor), from_torus});
  all.push_back({"torus, irregular triangles of .025",
                 irregular(octafront::testing::torus(900, 360, kMajor, kMinor), 0.025, to_torus), from_torus});
  all.push_back({"cylinder, 256 strips from CAD", cylinder(256), from_cylinder});
  all.push_back(
      {"cylinder, irregular triangles of .025", irregular(cylinder(2048), 0.025, to_cylinder), from_cylinder});
  return all;
}

// --- distances

struct Distance {
  double most = 0, squares = 0;
  std::size_t samples = 0;
  double mean() const { return std::sqrt(squares / static_cast<double>(samples)); }
};

/// The mid-side node of each boundary edge, by the tets.
std::vector<std::array<Vec3, 6>> boundary_nodes(const TetMesh& mesh) {
  std::map<Edge, VertexIndex> mids;
  for (std::size_t t = 0; t < mesh.mid_nodes.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const VertexIndex a = mesh.tets[t][static_cast<std::size_t>(kTetEdges[e][0])],
                        b = mesh.tets[t][static_cast<std::size_t>(kTetEdges[e][1])];
      mids[{std::min(a, b), std::max(a, b)}] = mesh.mid_nodes[t][e];
    }
  std::vector<std::array<Vec3, 6>> nodes;
  const auto middle = [&](VertexIndex a, VertexIndex b) {
    if (!mesh.is_second_order()) return 0.5 * (mesh.points[a] + mesh.points[b]);
    return mesh.points[mids.at({std::min(a, b), std::max(a, b)})];
  };
  for (const auto& [a, b, c] : mesh.boundary)
    nodes.push_back({mesh.points[a], mesh.points[b], mesh.points[c], middle(a, b), middle(b, c), middle(c, a)});
  return nodes;
}

Distance distance_of(const TetMesh& mesh, const std::function<double(Vec3)>& from_truth) {
  constexpr int kSteps = 12;
  Distance found;
  for (const auto& n : boundary_nodes(mesh))
    for (int i = 0; i <= kSteps; ++i)
      for (int k = 0; i + k <= kSteps; ++k) {
        const double x = double(i) / kSteps, y = double(k) / kSteps, w = 1 - x - y;
        const Vec3 p = w * (2 * w - 1) * n[0] + x * (2 * x - 1) * n[1] + y * (2 * y - 1) * n[2] + 4 * w * x * n[3] +
                       4 * x * y * n[4] + 4 * y * w * n[5];
        const double d = from_truth(p);
        found.most = std::max(found.most, d);
        found.squares += d * d;
        ++found.samples;
      }
  return found;
}

// --- runs

Result run(const SurfaceMesh& input, double size, int order) {
  Options options;
  if (size > 0) options.size.size = size;
  options.order = order;
  return generate(input, options);
}

/// Pairs of triangles of the boundary that cross, with straight edges.
std::uint64_t crossings(const TetMesh& mesh) {
  SurfaceMesh boundary{mesh.points, mesh.boundary, {}, {}, {}};
  return find_defects(repair_surface(boundary)).self_intersections.count;
}

Json json_of(const Result& r) {
  const SecondOrderSummary& s = r.report.second_order;
  const JacobianSummary proof = check_jacobians(r.mesh);
  const auto defect = first_defect(r.mesh);
  return {{"tets", r.mesh.tets.size()},
          {"valid", !defect},
          {"not_proven", proof.invalid},
          {"curved", s.curved},
          {"eased", s.eased},
          {"straight", s.straight},
          {"moved", s.moved},
          {"held", s.held},
          {"largest_bend", s.largest_bend},
          {"least_scaled_jacobian", proof.least_scaled_jacobian}};
}

void measure_shapes() {
  for (const Shape& shape : shapes())
    for (const double size : {0.4, 0.2, 0.1}) {
      const Result linear = run(shape.input, size, 1), curved = run(shape.input, size, 2);
      const Distance flat = distance_of(linear.mesh, shape.distance), bent = distance_of(curved.mesh, shape.distance);
      Json j{{"shape", shape.name}, {"size", size}};
      j.update(json_of(curved));
      j.update({{"linear_most", flat.most},
                {"curved_most", bent.most},
                {"linear_mean", flat.mean()},
                {"curved_mean", bent.mean()}});
      fmt::print("{}\n", j.dump());
      std::fflush(stdout);
    }
}

constexpr double kShort = 1;

void measure_model(const std::string& file, double size) {
  const SurfaceMesh input = read_surface(file).surface;
  const Result linear = run(input, size, 1), r = run(input, size, 2);
  double linear_seconds = linear.report.cpu_seconds, seconds = r.report.cpu_seconds;
  // Short runs jitter: the best of five.
  for (int again = 0; again < 4 && linear_seconds < kShort; ++again) {
    linear_seconds = std::min(linear_seconds, run(input, size, 1).report.cpu_seconds);
    seconds = std::min(seconds, run(input, size, 2).report.cpu_seconds);
  }
  Json j = json_of(r);
  j.update({{"crossings", crossings(r.mesh)},
            {"input_volume", r.report.input_volume},
            {"linear_volume", linear.report.volume},
            {"curved_volume", r.report.volume},
            {"linear_cpu_seconds", linear_seconds},
            {"cpu_seconds", seconds}});
  fmt::print("{}\n", j.dump());
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  try {
    if (what == "shapes")
      measure_shapes();
    else if (argc > 1)
      measure_model(what, argc > 2 ? std::stod(argv[2]) : 0);
    return argc > 1 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print("{}\n", Json{{"error", error.what()}}.dump());
    return 1;
  }
}
