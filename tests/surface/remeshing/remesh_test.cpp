#include "surface/remeshing/remesh.h"

#include <octafront/error.h>
#include <octafront/quality.h>

#include "base/geometry/hausdorff.h"
#include "base/geometry/measures.h"
#include "base/mesh/feature_patches.h"
#include "base/mesh/half_edge_mesh.h"
#include "sizing/sources/make_size_field.h"
#include "support/faceted.h"
#include "support/named_surfaces.h"
#include "support/random.h"
#include "surface/edits/coarsen.h"
#include "surface/edits/working_mesh.h"
#include "surface/front/front_steps.h"
#include "surface/front/surface_front.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using namespace octafront::testing;

struct NamedSurface {
  std::string name;
  SurfaceMesh surface;
  double h;
};

/// A closed cylinder of n side needles and two fans, as CAD programs write it.
SurfaceMesh needle_cylinder(int n, double radius, double height) {
  SurfaceMesh s;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    s.points.push_back({radius * std::cos(a), radius * std::sin(a), 0});
    s.points.push_back({radius * std::cos(a), radius * std::sin(a), height});
  }
  const auto at = [&](int i, int top) { return static_cast<VertexIndex>(2 * (i % n) + top); };
  for (int i = 0; i < n; ++i) {
    s.triangles.push_back({at(i, 0), at(i + 1, 0), at(i + 1, 1)});
    s.triangles.push_back({at(i, 0), at(i + 1, 1), at(i, 1)});
  }
  for (int i = 1; i + 1 < n; ++i) {
    s.triangles.push_back({at(0, 0), at(i + 1, 0), at(i, 0)});
    s.triangles.push_back({at(0, 1), at(i, 1), at(i + 1, 1)});
  }
  return s;
}

/// Of needles from a fan to the tip.
SurfaceMesh sharp_cone(int sides, double radius, double height) {
  SurfaceMesh s;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * std::numbers::pi * i / sides;
    s.points.push_back({radius * std::cos(a), radius * std::sin(a), 0});
  }
  s.points.push_back({0, 0, 0});
  s.points.push_back({0, 0, height});
  const auto n = static_cast<VertexIndex>(sides);
  for (VertexIndex i = 0; i < n; ++i) {
    s.triangles.push_back({i, (i + 1) % n, n + 1});
    s.triangles.push_back({(i + 1) % n, i, n});
  }
  return s;
}

/// A rod of length 1 that tapers to tips over `taper` at both ends.
SurfaceMesh rod_with_tips(int sides, double radius, double taper) {
  SurfaceMesh s;
  for (const double z : {taper, 1 - taper})
    for (int i = 0; i < sides; ++i) {
      const double a = 2 * std::numbers::pi * i / sides;
      s.points.push_back({radius * std::cos(a), radius * std::sin(a), z});
    }
  s.points.push_back({0, 0, 0});
  s.points.push_back({0, 0, 1});
  const auto n = static_cast<VertexIndex>(sides);
  for (VertexIndex i = 0, k = 1; i < n; ++i, k = (i + 1) % n) {
    s.triangles.push_back({k, i, 2 * n});
    s.triangles.push_back({i, k, n + k});
    s.triangles.push_back({i, n + k, n + i});
    s.triangles.push_back({n + i, n + k, 2 * n + 1});
  }
  return s;
}

SurfaceMesh box(double x, double y, double z) {
  SurfaceMesh s = cube(1);
  for (Vec3& p : s.points) p = {p.x * x, p.y * y, p.z * z};
  return s;
}

Remeshed remesh(const SurfaceMesh& surface, double h, const SurfaceOptions& options = {}) {
  StageReport report;
  return remesh_surface(KnownSurface(surface, 40), SizeField::uniform(h), options, {{}, report});
}

/// Two spheres, one inside the other, closer than the elements are long.
SurfaceMesh close_sheets() {
  return joined(icosphere(4, 1), reversed(icosphere(4, 0.93)));
}

std::vector<NamedSurface> samples_to_remesh() {
  return {{"fine sphere", icosphere(4), 0.25},
          {"coarse sphere", icosphere(1), 0.15},
          {"torus", torus(60, 24), 0.12},
          {"cube of twelve triangles", cube(1), 0.1},
          {"cube of many", cube(12), 0.3},
          {"cube smaller than its size", cube(3), 3},
          {"cylinder of needles", needle_cylinder(180, 1, 5), 0.2},
          {"cylinder, finer than its needles", needle_cylinder(12, 1, 2), 0.08},
          {"thin plate", box(1, 1, 0.01), 0.1},
          {"nested shells", hollow_sphere(3), 0.2},
          {"close sheets", close_sheets(), 0.2},
          {"two bodies", joined(cube(2), transformed(icosphere(3), 0.5, {3, 0, 0})), 0.15},
          {"tetrahedron", unit_tetrahedron(), 0.1}};
}

/// V - E + F, after checking that every edge has two sides and every vertex one fan.
long euler_characteristic(const SurfaceMesh& s) {
  std::map<Edge, int> half_edges;
  for (const Triangle& t : s.triangles) {
    for (int i = 0; i < 3; ++i) ++half_edges[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [e, n] : half_edges) {
    EXPECT_EQ(n, 1) << "edge " << e[0] << " " << e[1];
    EXPECT_TRUE(half_edges.contains({e[1], e[0]})) << "edge " << e[0] << " " << e[1];
  }
  const HalfEdgeMesh mesh = make_half_edge_mesh(s);
  std::vector<int> triangles_at(s.points.size(), 0);
  for (const Triangle& t : s.triangles) {
    for (const VertexIndex v : t) ++triangles_at[v];
  }
  for (VertexIndex v = 0; v < s.points.size(); ++v) {
    int fan = 0;
    mesh.for_each_outgoing(v, [&](std::uint32_t) { ++fan; });
    EXPECT_EQ(fan, triangles_at[v]) << "vertex " << v;
  }
  return static_cast<long>(s.points.size()) - static_cast<long>(half_edges.size() / 2) +
         static_cast<long>(s.triangles.size());
}

std::uint32_t component_count(const SurfaceMesh& s) {
  std::uint32_t n = 0;
  component_of_triangle(make_half_edge_mesh(s), n);
  return n;
}

TEST(Remesh, KeepsTopologyAndNeverCrossesItself) {
  for (const NamedSurface& sample : samples_to_remesh()) {
    SCOPED_TRACE(sample.name);
    const Remeshed r = remesh(sample.surface, sample.h);
    EXPECT_EQ(euler_characteristic(r.surface), euler_characteristic(sample.surface));
    EXPECT_EQ(component_count(r.surface), component_count(sample.surface));
    EXPECT_TRUE(surface::find_crossings(r.surface).empty());
    EXPECT_GT(enclosed_volume(r.surface), 0);
    EXPECT_EQ(r.source.size(), r.surface.triangles.size());
  }
}

TEST(Remesh, MakesEdgesOfTheWantedLengthAndGoodTriangles) {
  for (const NamedSurface& sample : {NamedSurface{"sphere", icosphere(4), 0.12},
                                     {"coarse sphere", icosphere(1), 0.08},
                                     {"torus", torus(90, 40), 0.1},
                                     {"cube", cube(1), 0.05},
                                     {"cylinder of needles", needle_cylinder(180, 1, 5), 0.12}}) {
    SCOPED_TRACE(sample.name);
    const SurfaceMesh s = remesh(sample.surface, sample.h).surface;
    double quality = 0, length = 0, within = 0;
    for (const auto& [a, b, c] : s.triangles) {
      quality += radius_ratio(s.points[a], s.points[b], s.points[c]);
      for (const double l : {distance(s.points[a], s.points[b]), distance(s.points[b], s.points[c]),
                             distance(s.points[c], s.points[a])}) {
        length += l / sample.h;
        within += l >= 0.7 * sample.h && l <= 1.4 * sample.h;
      }
    }
    const auto triangles = static_cast<double>(s.triangles.size());
    EXPECT_GT(quality / triangles, 0.97);
    EXPECT_NEAR(length / triangles / 3, 1, 0.05);
    EXPECT_GT(within / triangles / 3, 0.98);
  }
}

TEST(Remesh, CubeStaysACube) {
  const SurfaceMesh input = cube(1);
  const Remeshed r = remesh(input, 0.13);
  EXPECT_NEAR(enclosed_volume(r.surface), 1, 1e-12);
  EXPECT_EQ(r.features.corners.size(), 8u);
  for (const auto& [a, b] : r.features.edges) {
    for (const VertexIndex v : {a, b}) {
      const Vec3 p = r.surface.points[v];
      int on = 0;
      for (int axis = 0; axis < 3; ++axis) on += std::min(std::abs(p[axis]), std::abs(p[axis] - 1)) < 1e-12;
      EXPECT_GE(on, 2);
    }
  }
  double feature_length = 0;
  for (const auto& [a, b] : r.features.edges) feature_length += distance(r.surface.points[a], r.surface.points[b]);
  EXPECT_NEAR(feature_length, 12, 1e-9);
  std::map<std::uint32_t, double> patch_area;
  for (std::size_t t = 0; t < r.surface.triangles.size(); ++t) {
    const auto [a, b, c] = r.surface.triangles[t];
    const Vec3 p = r.surface.points[a];
    patch_area[r.surface.patch_of(t)] += 0.5 * length(cross(r.surface.points[b] - p, r.surface.points[c] - p));
    EXPECT_EQ(input.patch_of(r.source[t]), r.surface.patch_of(t));
  }
  EXPECT_EQ(patch_area.size(), 6u);
  for (const auto& [patch, a] : patch_area) EXPECT_NEAR(a, 1, 1e-12) << "patch " << patch;
}

TEST(Remesh, KeepsPatchBordersInsideFlatSides) {
  SurfaceMesh input = cube(8);
  for (std::size_t t = 0; t < input.triangles.size(); ++t) {
    const auto [a, b, c] = input.triangles[t];
    input.patch[t] = (input.points[a].x + input.points[b].x + input.points[c].x) / 3 < 0.5 ? 0 : 1;
  }
  const Remeshed r = remesh(input, 0.07);
  double left = 0;
  for (std::size_t t = 0; t < r.surface.triangles.size(); ++t) {
    const auto [a, b, c] = r.surface.triangles[t];
    const Vec3 p = r.surface.points[a];
    if (r.surface.patch_of(t) == 0) left += 0.5 * length(cross(r.surface.points[b] - p, r.surface.points[c] - p));
  }
  EXPECT_NEAR(left, 3, 1e-9);
}

TEST(Remesh, IsDeterministic) {
  const SurfaceMesh input = torus(40, 20);
  EXPECT_EQ(remesh(input, 0.1).surface, remesh(input, 0.1).surface);
}

TEST(Remesh, ScaleByAPowerOfTwoChangesNothing) {
  const SurfaceMesh input = needle_cylinder(40, 1, 3);
  const SurfaceMesh small = remesh(input, 0.2).surface;
  const SurfaceMesh large = remesh(transformed(input, 1024, {}), 0.2 * 1024).surface;
  EXPECT_EQ(transformed(small, 1024, {}), large);
}

TEST(Remesh, FarFromTheOriginThingsAreAlike) {
  const SurfaceMesh input = icosphere(3);
  const SurfaceMesh here = remesh(input, 0.1).surface;
  const SurfaceMesh there = remesh(transformed(input, 1, {1000, -2000, 500}), 0.1).surface;
  EXPECT_NEAR(static_cast<double>(there.triangles.size()) / static_cast<double>(here.triangles.size()), 1, 0.03);
  EXPECT_NEAR(enclosed_volume(there), enclosed_volume(here), 0.01 * enclosed_volume(here));
}

TEST(Remesh, FollowsAGradedField) {
  const SurfaceMesh input = icosphere(5);
  const auto h = [](Vec3 p) { return 0.05 + 0.1 * (p.z + 1); };
  StageReport report;
  const SizeField sizes = SizeField::from_function(h, 0.05, 0.25);
  const SurfaceMesh s = remesh_surface(KnownSurface(input, Features{}), sizes, {}, {{}, report}).surface;
  double sum = 0;
  for (const auto& [a, b, c] : s.triangles) {
    sum += distance(s.points[a], s.points[b]) / h((s.points[a] + s.points[b]) * 0.5);
  }
  EXPECT_NEAR(sum / static_cast<double>(s.triangles.size()), 1, 0.06);
}

/// The steepest slope of the sizes between points of the box, near each other and far.
double steepest(const SizeField& sizes, const Box3& box) {
  testing::Random random(7);
  const auto anywhere = [&] {
    return Vec3{random.between(box.lo.x, box.hi.x), random.between(box.lo.y, box.hi.y),
                random.between(box.lo.z, box.hi.z)};
  };
  double slope = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = anywhere(), q = p + (anywhere() - p) * (n % 2 == 0 ? 1 : 0.05);
    slope = std::max(slope, std::abs(sizes.at(p) - sizes.at(q)) / distance(p, q));
  }
  return slope;
}

TEST(Remesh, CappedSizesKeepTheGradationAskedFor) {
  // Strips and the deviation asked for cap the sizes; the region makes them rise.
  const KnownSurface input(joined(box(1, 0.5, 0.04), transformed(icosphere(3), 0.2, {0.5, 0.2, 0.5})), 40);
  SurfaceOptions options;
  options.max_deviation = 0.002;
  for (const double gradation : {0.05, 0.2, 0.8}) {
    SCOPED_TRACE(gradation);
    SizeOptions size;
    size.size = 0.2;
    size.gradation = gradation;
    size.regions.push_back({{}, {}, 0, 0.04});
    StageReport report;
    const SizeField asked = make_size_field(input, size, {{}, report});
    const SizeField made = remesh_surface(input, asked, options, {{}, report}).sizes;
    ASSERT_LT(made.at({0.5, 0.2, 0.7}), 0.9 * asked.at({0.5, 0.2, 0.7})) << "nothing was capped";
    const double slope = steepest(made, bounding_box(input.mesh().points));
    EXPECT_LE(slope, gradation * (1 + 1e-9));
    EXPECT_GT(slope, 0.5 * gradation) << "rises more slowly than it may";
  }
}

TEST(Remesh, StaysWithinTheAskedDeviation) {
  const SurfaceMesh input = torus(60, 24);
  SurfaceOptions options;
  options.max_deviation = 0.01;
  StageReport loose, tight;
  const auto h = SizeField::uniform(0.4);
  const SurfaceMesh coarse = remesh_surface(KnownSurface(input, Features{}), h, {}, {{}, loose}).surface;
  const Remeshed fine = remesh_surface(KnownSurface(input, Features{}), h, options, {{}, tight});
  EXPECT_GT(hausdorff_distance(coarse, input, 1e-3).lower, 0.02);
  EXPECT_LT(hausdorff_distance(fine.surface, input, 1e-3).upper, 0.015);
  EXPECT_LT(fine.sizes.min_size(), 0.4);
}

TEST(Remesh, ABoundOfSomeTrianglesHoldsThere) {
  const SurfaceMesh input = icosphere(5, 1);
  const KnownSurface known(input, Features{});
  SurfaceOptions options;
  options.max_deviation = 0.02;
  std::vector<double> bound(input.triangles.size(), HUGE_VAL);
  for (std::size_t t = 0; t < bound.size(); ++t)
    if (input.points[input.triangles[t][0]].z > 0.8) bound[t] = 0.002;
  StageReport report;
  const auto h = SizeField::uniform(0.4);
  const auto triangles = [&](const SurfaceOptions& asked, std::span<const double> of_triangle) {
    return remesh_surface(known, h, asked, {{}, report}, of_triangle).surface.triangles.size();
  };
  const SurfaceMesh made = remesh_surface(known, h, options, {{}, report}, bound).surface;
  double above = 0, below = 0;
  for (const auto& [a, b, c] : made.triangles) {
    const Vec3 middle = (made.points[a] + made.points[b] + made.points[c]) / 3;
    double& farthest = middle.z > 0.85 * length(middle) ? above : below;
    farthest = std::max(farthest, 1 - length(middle));
  }
  EXPECT_LT(above, 0.0025);
  EXPECT_GT(below, 0.01);
  SurfaceOptions everywhere;
  everywhere.max_deviation = 0.002;
  EXPECT_GT(triangles(options, bound), triangles(options, {}));
  EXPECT_LT(triangles(options, bound), triangles(everywhere, {}) / 2);
}

/// The largest angle between a triangle and the sphere's normal at one of its corners, degrees.
double most_turned(const SurfaceMesh& on_unit_sphere) {
  double least = 1;
  for (const auto& [a, b, c] : on_unit_sphere.triangles) {
    const Vec3 pa = on_unit_sphere.points[a], pb = on_unit_sphere.points[b], pc = on_unit_sphere.points[c];
    const Vec3 n = normalized(cross(pb - pa, pc - pa));
    for (const Vec3 p : {pa, pb, pc}) least = std::min(least, dot(n, normalized(p)));
  }
  return std::acos(least) * 180 / std::numbers::pi;
}

TEST(Remesh, StaysWithinTheAskedNormalDeviation) {
  const SurfaceMesh input = icosphere(5, 1);
  SurfaceOptions options;
  StageReport loose, tight;
  const auto h = SizeField::uniform(0.5);
  EXPECT_GT(most_turned(remesh_surface(KnownSurface(input, Features{}), h, options, {{}, loose}).surface), 14);
  options.normal_deviation = 8;
  const Remeshed fine = remesh_surface(KnownSurface(input, Features{}), h, options, {{}, tight});
  EXPECT_LT(most_turned(fine.surface), 8.5);
  EXPECT_LT(fine.sizes.min_size(), 0.4);
}

TEST(Remesh, DividesTheLinesOfNarrowStripsFiner) {
  // The rim of the plate is a strip a fifth of the size wide.
  const Remeshed r = remesh(box(2, 2, 0.02), 0.1);
  double least = 1;
  for (const auto& [a, b, c] : r.surface.triangles) {
    const Vec3 pa = r.surface.points[a], pb = r.surface.points[b], pc = r.surface.points[c];
    const double x = distance(pa, pb), y = distance(pb, pc), z = distance(pc, pa);
    least = std::min(least, 4 * squared_length(cross(pb - pa, pc - pa)) / ((x + y + z) * x * y * z));
  }
  EXPECT_GT(least, 0.4);
  EXPECT_NEAR(r.sizes.at({0, 0.5, 0.01}), 0.03, 0.005);
  EXPECT_NEAR(r.sizes.at({1, 1, 0.01}), 0.1, 0.005) << "far from the rim nothing changes";
}

TEST(Remesh, ArcsGetNoFewerEdgesThanAsked) {
  const Remeshed r = remesh(testing::faceted_pin(96, 1, 0, 1.5), 2 * std::numbers::pi / 13.3);
  const auto on_rim = [](Vec3 p) { return p.z == 0 && std::hypot(p.x, p.y) > 0.99; };
  EXPECT_EQ(std::ranges::count_if(r.surface.points, on_rim), 14);
}

TEST(Remesh, LeavesStripsAsTheyComeWhereTold) {
  SurfaceOptions options;
  options.strips = SurfaceOptions::Strips::kOff;
  const SurfaceMesh plate = box(2, 2, 0.02);
  const Remeshed coarse = remesh(plate, 0.1, options);
  EXPECT_EQ(coarse.sizes.at({0, 0.5, 0.01}), 0.1);
  EXPECT_LT(2 * coarse.surface.triangles.size(), remesh(plate, 0.1).surface.triangles.size());
}

TEST(Remesh, StripsMayBeServedByWiderElements) {
  const SurfaceMesh plate = box(2, 2, 0.04);
  const KnownSurface known(plate, detect_features(plate, 40));
  const auto size_at_rim = [&](const FrontLimits& limits) {
    StageReport report;
    const Remeshed r = remesh_surface(known, SizeField::uniform(0.1), {}, {{}, report}, {}, limits);
    return r.sizes.at({0, 0.5, 0.02});
  };
  EXPECT_NEAR(size_at_rim({}), 0.06, 0.005);
  EXPECT_NEAR(size_at_rim({.per_strip = 2}), 0.08, 0.005);
}

TEST(Remesh, PointsOfLinesSideBySideFaceEachOther) {
  // A bar one element thick. Where every line keeps the division that it got by itself the mean is .853.
  const SurfaceMesh bar = box(3.05, 0.09, 0.13);
  double sum = 0;
  std::size_t count = 0;
  for (double h = 0.08; h < 0.2; h += 0.01) {
    const Remeshed r = remesh(bar, h);
    for (const auto& [a, b, c] : r.surface.triangles) {
      sum += triangle_radius_ratio(r.surface.points[a], r.surface.points[b], r.surface.points[c]);
      ++count;
    }
  }
  EXPECT_GT(sum / static_cast<double>(count), 0.95);
}

/// A working mesh of the surface by one size, as the front leaves it, with its curves.
struct Drawn {
  surface::InputSurface input;
  std::vector<surface::Curve> curves;
  surface::WorkingMesh mesh;
};

Drawn drawn(const SurfaceMesh& surface, double h) {
  using namespace surface;
  const KnownSurface known(surface, 40);
  const SizeField sizes = SizeField::uniform(h);
  InputSurface input = make_input_surface(known.mesh(), known.edges());
  set_features(input, known.features().edges);
  std::vector<Curve> curves = chain_curves(input, known.features().corners, {}, sizes);
  divide_curves(input, sizes, curves);
  InsertionCounts inserted;
  CoarsenCounts coarsened;
  WorkingMesh mesh = insert_points(input, curves, place_points(input, curves, sizes, {}), {}, inserted);
  remove_input_vertices(mesh, sizes, {}, coarsened);
  return {std::move(input), std::move(curves), std::move(mesh)};
}

double longest_edge(const surface::WorkingMesh& mesh) {
  double longest = 0;
  for (HalfEdge h = 0; h < mesh.start.size(); ++h)
    if (mesh.start[h] != kNone)
      longest = std::max(longest, distance(mesh.points[mesh.start[h]], mesh.points[mesh.end(h)]));
  return longest;
}

TEST(ImproveSurface, DividesAllLongEdgesOnceSizesAreSmaller) {
  // A bar of two elements: most of its edges lie on lines, or between a point of a line and one inside.
  Drawn d = drawn(box(8, 1, 1), 0.5);
  EXPECT_GT(longest_edge(d.mesh), 0.5);
  const double h = 0.2;
  d.mesh.size.assign(d.mesh.size.size(), h);
  surface::ImproveCounts counts;
  for (int k = 0; k < 3; ++k) improve_surface(d.mesh, d.input, d.curves, SizeField::uniform(h), {}, counts);
  EXPECT_LT(longest_edge(d.mesh), 1.6 * h);
}

TEST(FeaturePatches, EachFaceOfACubeIsOne) {
  SurfaceMesh s = cube(4);
  EXPECT_EQ(divide_into_patches(s, make_edge_table(s.points.size(), s.triangles), detect_features(s, 40)), 6u);
  const Remeshed r = remesh(s, 0.2);
  std::map<std::uint32_t, Vec3> sum;
  for (std::size_t t = 0; t < r.surface.triangles.size(); ++t) {
    const auto [a, b, c] = r.surface.triangles[t];
    sum[r.surface.patch_of(t)] +=
        cross(r.surface.points[b] - r.surface.points[a], r.surface.points[c] - r.surface.points[a]) / 2;
  }
  ASSERT_EQ(sum.size(), 6u);
  std::set<std::array<int, 3>> directions;
  for (const auto& [patch, v] : sum) {
    EXPECT_NEAR(length(v), 1, 1e-12) << "patch " << patch << " is not one whole face";
    directions.insert({int(std::lround(v.x)), int(std::lround(v.y)), int(std::lround(v.z))});
  }
  EXPECT_EQ(directions.size(), 6u);
}

TEST(FeaturePatches, PartsOfANamedPatchKeepItsName) {
  SurfaceMesh s = cube(2);
  s.patch.assign(s.triangles.size(), 0);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const auto [a, b, c] = s.triangles[t];
    s.patch[t] = s.points[a].z == 1 && s.points[b].z == 1 && s.points[c].z == 1;
  }
  s.patch_names = {"wall", "lid"};
  EXPECT_EQ(divide_into_patches(s, make_edge_table(s.points.size(), s.triangles), detect_features(s, 40)), 6u);
  std::multiset<std::string> names(s.patch_names.begin(), s.patch_names.end());
  EXPECT_EQ(names, (std::multiset<std::string>{"wall.1", "wall.2", "wall.3", "wall.4", "wall.5", "lid"}));
}

// The normal of the tip is the axis, by which every point near it would be on a sheet of its own: the front placed
// hundreds of times as many as there is room for.
TEST(Remesh, TipsOfConesAreNoPlaceForThousandsOfPoints) {
  StageReport report;
  const KnownSurface cone(sharp_cone(64, 0.05, 1), 40);
  const Remeshed r = remesh_surface(cone, make_size_field(cone, {}, {{}, report}), {}, {{}, report});
  const std::map<std::string, double> counted(report.counters.begin(), report.counters.end());
  EXPECT_LT(counted.at("places tried"), 4.0 * static_cast<double>(r.surface.triangles.size()));
}

// Where the tips cross at every size their facets return, hundreds of sizes long: mending what crosses, and the needles
// around them, took minutes.
TEST(Remesh, FacetsOfANeedleThatCrossAtEverySizeAllStay) {
  StageReport report;
  const SurfaceMesh rod = rod_with_tips(16, 0.0024, 0.33);
  const KnownSurface known(rod, 40);
  SurfaceOptions options;
  options.max_deviation = 1e-3;
  const Remeshed r =
      remesh_surface(known, SizeField::uniform(0.0025), options, {{}, report}, {}, FrontLimits{.budget = 1e6});
  const std::map<std::string, double> counted(report.counters.begin(), report.counters.end());
  EXPECT_GT(counted.at("changes judged"), 2e4);
  EXPECT_LT(counted.at("changes judged"), 1e5);
  EXPECT_TRUE(r.stays);
  EXPECT_EQ(r.surface.triangles, rod.triangles);
}

// Points of one shell stood for those of the other, which came out as a few triangles across the whole body.
TEST(Remesh, ShellsThatFaceAlikeGetPointsOfTheirOwn) {
  const Remeshed r = remesh(joined(joined(icosphere(4, 1), reversed(icosphere(4, 0.995))), icosphere(4, 0.99)), 0.1);
  std::uint32_t shells = 0;
  std::vector<int> triangles(3);
  for (const std::uint32_t c : component_of_triangle(make_half_edge_mesh(r.surface), shells)) ++triangles.at(c);
  ASSERT_EQ(shells, 3u);
  const auto [least, most] = std::minmax_element(triangles.begin(), triangles.end());
  EXPECT_LT(*most, 1.1 * *least);
}

TEST(Remesh, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  RunContext context;
  context.cancel = &stop;
  StageReport report;
  EXPECT_THROW(remesh_surface(KnownSurface(icosphere(3), Features{}), SizeField::uniform(0.1), {}, {context, report}),
               Cancelled);
}

}  // namespace
}  // namespace octafront
