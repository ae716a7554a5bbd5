// Boundary layers: heights as asked where there is room, fewer or thinner ones where there is none, and a valid mesh in
// any case.

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include "base/geometry/measures.h"
#include "layers/grow.h"
#include "layers/with_layers.h"
#include "support/named_surfaces.h"
#include "support/test_folder.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using namespace octafront::testing;

layers::Columns grown_on(const SurfaceMesh& surface, std::uint32_t count, double first, double growth = 1.2,
                         std::vector<std::uint8_t> is_wall = {}) {
  if (is_wall.empty()) is_wall.assign(surface.triangles.size(), 1);
  StageReport report;
  const RunContext context;
  layers::RegionWall wall = layers::walls_of_regions(surface, is_wall, {0}).front();
  return layers::grow(wall, {count, growth, std::vector<double>(surface.points.size(), first), 0.3}, {context, report});
}

bool is_full(const layers::Columns& columns, VertexIndex v) {
  return columns.reason[v] == layers::Reason::kNone && columns.count[v] == columns.asked && columns.part[v] == 1;
}

Result meshed(const SurfaceMesh& surface, const LayersOptions& layers, double size, int order = 1) {
  Domain domain;
  domain.surface = surface;
  Options options;
  options.size.size = size;
  options.layers = layers;
  options.order = order;
  return generate(domain, options, RunContext{});
}

double volume_of(const TetMesh& mesh, std::uint32_t region) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto [a, b, c, d] = mesh.tets[t];
    if (mesh.region[t] == region) sum += signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  }
  return sum;
}

TEST(Layers, AreAsHighAsAskedOnSimpleBodies) {
  for (const SurfaceMesh& surface : {cube(8), icosphere(3), torus(60, 24)}) {
    const layers::Columns columns = grown_on(surface, 3, 0.01);
    for (VertexIndex v = 0; v < surface.points.size(); ++v) EXPECT_TRUE(is_full(columns, v));
  }
}

TEST(Layers, GrowByTheirFactor) {
  const SurfaceMesh surface = icosphere(3);
  const layers::Columns columns = grown_on(surface, 5, 0.01, 1.3);
  for (VertexIndex v = 0; v < surface.points.size(); ++v)
    for (std::uint32_t k = 1; k < 5; ++k) {
      const Vec3 a = columns.place(surface, {v, k - 1}), b = columns.place(surface, {v, k}),
                 c = columns.place(surface, {v, k + 1});
      EXPECT_NEAR(distance(b, c) / distance(a, b), 1.3, 1e-9);
    }
}

TEST(Layers, ReachTheHeightOnFlatFacesBesideEdges) {
  const SurfaceMesh surface = cube(8);
  const layers::Columns columns = grown_on(surface, 1, 0.02);
  for (VertexIndex v = 0; v < surface.points.size(); ++v) {
    const Vec3 p = surface.points[v], q = columns.top(surface, v);
    for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(p[axis] != 0 || q[axis] > 0.011);  // smoothed directions lean
  }
}

TEST(Layers, GiveWayInAGap) {
  const SurfaceMesh plate = box(1, 1, 0.05, 8);
  const layers::Columns columns = grown_on(plate, 3, 0.02);
  for (VertexIndex v = 0; v < plate.points.size(); ++v) {
    const double height = std::abs(columns.top(plate, v).z - plate.points[v].z);
    EXPECT_LT(height, 0.025);
  }
  EXPECT_TRUE(std::ranges::any_of(columns.reason, [](layers::Reason r) { return r == layers::Reason::kGap; }));
}

TEST(Layers, AMeshOfBothIsValidAndKeepsTheVolume) {
  LayersOptions asked;
  asked.count = 3;
  asked.first = 0.01;
  for (const SurfaceMesh& surface : {cube(2), icosphere(3), torus(60, 24)}) {
    const Result made = meshed(surface, asked, 0.15);
    EXPECT_EQ(first_defect(made.mesh), std::nullopt);
    ASSERT_EQ(made.mesh.region_names, (std::vector<std::string>{"volume", "layers"}));
    const double height = 0.01 * (1 + 1.2 + 1.44);
    double wall = 0;
    for (const Triangle& t : made.mesh.boundary) wall += triangle_area(made.mesh.points, t);
    EXPECT_NEAR(volume_of(made.mesh, 1) / (wall * height), 1, 0.12);
    ASSERT_FALSE(made.report.layers.empty());
    for (const LayerSummary& on : made.report.layers) {
      EXPECT_EQ(on.full, 1);
      EXPECT_EQ(on.mean_count, 3);
      EXPECT_GT(on.min_scaled_jacobian, 0.3);
    }
  }
}

TEST(Layers, EndOnFlatPatchesWithout) {
  LayersOptions asked;
  asked.count = 4;
  asked.first = 0.02;
  asked.on = "wall";
  const Result made = meshed(pipe(48, 20), asked, 0.25);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  ASSERT_EQ(made.report.layers.size(), 1u);
  EXPECT_EQ(made.report.layers[0].patch, "wall");
  EXPECT_EQ(made.report.layers[0].full, 1);
  double inlet = 0, wall = 0;
  for (std::size_t f = 0; f < made.mesh.boundary.size(); ++f) {
    const Triangle& t = made.mesh.boundary[f];
    const std::string& patch = made.mesh.patch_names[made.mesh.patch[f]];
    (patch == "inlet" ? inlet : wall) += patch == "outlet" ? 0 : triangle_area(made.mesh.points, t);
    for (const VertexIndex v : t) {
      if (patch != "wall") {
        EXPECT_NEAR(made.mesh.points[v].z, patch == "inlet" ? 0 : 4, 1e-12);
      }
    }
  }
  EXPECT_NEAR(inlet, std::numbers::pi, 0.05);
  EXPECT_NEAR(wall, 8 * std::numbers::pi, 0.3);
}

class LayerFiles : public InItsFolder {
 protected:
  std::string text_of(const char* name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(LayerFiles, HaveWedgesWhereTheFormatDoes) {
  LayersOptions asked;
  asked.count = 6;
  asked.first = 0.04;  // some are left out in the corners of the ends
  asked.on = "wall";
  const TetMesh mesh = meshed(pipe(24, 10), asked, 0.4).mesh;
  ASSERT_FALSE(mesh.wide_cells.empty());
  ASSERT_FALSE(mesh.wide_faces.empty());
  for (const char* name : {"a.vtu", "a.vtk", "a.msh", "a.bdf", "a.inp"}) {
    const std::string file = folder_ / name;
    write_mesh(file, mesh);
    const MeshFile read = read_mesh_file(file);
    EXPECT_TRUE(read.notes.empty()) << name << read.notes.front();  // none is inverted
    EXPECT_EQ(first_defect(read.mesh), std::nullopt) << name;
    EXPECT_EQ(read.mesh.tets.size(), mesh.tets.size());
    EXPECT_EQ(read.mesh.wide_cells.size(), mesh.wide_cells.size());
    EXPECT_EQ(read.mesh.wide_faces.size(), mesh.wide_faces.size());
    EXPECT_EQ(first_wide_defect(read.mesh), std::nullopt);
    EXPECT_EQ(read.mesh.boundary.size(), mesh.boundary.size());
    EXPECT_EQ(read.mesh.region_names, mesh.region_names);
    EXPECT_EQ(read.mesh.patch_names, mesh.patch_names);
    EXPECT_EQ(std::ranges::count(read.mesh.patch, 1u), std::ranges::count(mesh.patch, 1u)) << name;
  }
  EXPECT_TRUE(std::ranges::any_of(write_mesh(folder_ / "a.vol", mesh),
                                  [](const std::string& note) { return note.find("tetrahedra") != note.npos; }));
  TetMesh broken = mesh;
  std::swap(broken.wide_cells[0].nodes, broken.wide_cells[1].nodes);
  EXPECT_NE(first_defect(broken), std::nullopt);
}

TEST_F(LayerFiles, SayHowManyLayersStandOnEachFace) {
  LayersOptions asked;
  asked.count = 3;
  asked.first = 0.02;
  asked.on = "wall";
  const TetMesh mesh = meshed(pipe(24, 10), asked, 0.4).mesh;
  ASSERT_EQ(mesh.face_layers.size(), mesh.boundary.size());
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) EXPECT_EQ(mesh.face_layers[f], mesh.patch[f] == 0 ? 3 : kNone);
  WriteOptions text;
  text.ascii = true;
  write_mesh(folder_ / "a.vtu", mesh, {}, text);
  EXPECT_NE(text_of("a.vtu").find("Name=\"layers\""), std::string::npos);
  write_mesh(folder_ / "polyMesh", mesh, {}, {.format = "openfoam"});
  const std::string patches = text_of("polyMesh/boundary");
  EXPECT_NE(patches.find("wall\n    {\n        type wall;"), std::string::npos);
  EXPECT_NE(patches.find("inlet\n    {\n        type patch;"), std::string::npos);
}

/// Three quarters of an edge: the triangles of the ends must go along, or the first row of them has no area left.
TEST(Layers, ThickOnesFindRoomOnFlatPatches) {
  LayersOptions asked;
  asked.count = 5;
  asked.first = 0.025;
  asked.on = "wall";
  const Result made = meshed(pipe(48, 20), asked, 0.25);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_EQ(made.report.layers.at(0).full, 1);
  for (std::size_t f = 0; f < made.mesh.boundary.size(); ++f)
    for (const VertexIndex v : made.mesh.boundary[f]) {
      EXPECT_TRUE(made.mesh.patch[f] == 0 || made.mesh.points[v].z == 0 || made.mesh.points[v].z == 4);
    }
}

TEST(Layers, CountAsElementsThatAreAskedFor) {
  Domain domain;
  domain.surface = icosphere(3);
  Options options;
  options.size.elements = 30'000;
  options.layers.count = 3, options.layers.first_part = 0.1;
  const Result made = generate(domain, options, RunContext{});
  EXPECT_NEAR(static_cast<double>(made.report.tets) / 30'000, 1, 0.2);
  EXPECT_NEAR(made.report.expected_tets / static_cast<double>(made.report.tets), 1, 0.3);
}

/// What touches a flat end from outside stays where it is while the end makes room.
TEST(Layers, LeaveWhatTouchesTheirEnds) {
  SurfaceMesh both = pipe(48, 20);
  both.sides.assign(both.triangles.size(), {kNone, 0});
  const Vec3 touch{0.6, 0, 0};
  const auto low = static_cast<VertexIndex>(both.points.size() - 2), first = low + 2;
  both.points[low] = touch;
  for (const Vec3 p : {Vec3{1.2, 0, -1}, {0, 0.6, -1}, {0, -0.6, -1}}) both.points.push_back(p);
  for (const Triangle& t : {Triangle{low, first, first + 1},
                            {low, first + 1, first + 2},
                            {low, first + 2, first},
                            {first, first + 2, first + 1}})
    both.triangles.push_back(t), both.patch.push_back(3), both.sides.push_back({kNone, 1});
  both.patch_names.push_back("tip");
  LayersOptions asked;
  asked.count = 3;
  asked.first = 0.04;
  asked.on = "wall";
  const Result made = meshed(both, asked, 0.25);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_NE(std::ranges::find(made.mesh.points, touch), made.mesh.points.end());
  EXPECT_NEAR(volume_of(made.mesh, 1), 0.24, 1e-9);
}

TEST(Layers, HeightsByYplusAndByTotal) {
  LayersOptions asked;
  asked.count = 3;
  asked.first = 0.01;
  asked.total = 0.05;
  const Result by_total = meshed(icosphere(3), asked, 0.2);
  ASSERT_EQ(by_total.report.layers.size(), 1u);
  EXPECT_NEAR(by_total.report.layers[0].first_median, 0.01, 1e-9);
  EXPECT_NEAR(volume_of(by_total.mesh, 1) / (4 * std::numbers::pi * 0.05), 1, 0.1);
  LayersOptions flow;
  flow.count = 3;
  flow.yplus = 30, flow.reynolds = 1e5, flow.reference_length = 2;
  // u_tau / U = sqrt(.013 Re^(-1/7)), y = 30 nu / u_tau
  const double y = 30 * 2 / (1e5 * std::sqrt(0.013 * std::pow(1e5, -1.0 / 7)));
  EXPECT_NEAR(meshed(icosphere(3), flow, 0.2).report.layers.at(0).first_median, y, 1e-12);
}

TEST(Layers, ContradictionsAreRefused) {
  const SurfaceMesh ball = icosphere(2);
  const auto refused = [&](const LayersOptions& o) { EXPECT_THROW(meshed(ball, o, 0.3), OptionError); };
  LayersOptions o;
  o.first = 0.01;
  refused(o);  // no count
  o.count = 3, o.total = 0.1, o.growth = 1.2;
  refused(o);
  o.growth.reset(), o.total.reset(), o.on = "nowhere";
  refused(o);
  o.on = "", o.first.reset();
  refused(o);
  o.first = 0.01, o.yplus = 1;
  refused(o);
}

TEST(Layers, CoverageMayBeRequired) {
  LayersOptions asked;
  asked.count = 3;
  asked.first = 0.05;
  asked.require_coverage = 95;
  EXPECT_NO_THROW(meshed(icosphere(3), asked, 0.3));
  EXPECT_THROW(meshed(box(1, 1, 0.1, 2), asked, 0.2), MeshingError);
}

/// Region 1 is the inner ball, region 0 what is around it.
SurfaceMesh ball_in_ball() {
  SurfaceMesh s = icosphere(3);
  const auto n = static_cast<VertexIndex>(s.points.size());
  const std::vector<Triangle> outer = s.triangles;
  for (VertexIndex v = 0; v < n; ++v) s.points.push_back(s.points[v] * 0.5);
  s.sides.assign(outer.size(), {kNone, 0});
  for (const auto& [a, b, c] : outer) s.triangles.push_back({a + n, b + n, c + n}), s.sides.push_back({0, 1});
  s.patch.assign(outer.size(), 0);
  s.patch.resize(s.triangles.size(), 1);
  s.patch_names = {"skin", "core"};
  s.region_names = {"flesh", "stone"};
  return s;
}

TEST(Layers, GrowInTheRegionsThatAreNamed) {
  LayersOptions asked;
  asked.count = 3;
  asked.first = 0.01;
  const double height = 0.01 * (1 + 1.2 + 1.44);
  const Result both = meshed(ball_in_ball(), asked, 0.15);
  EXPECT_EQ(first_defect(both.mesh), std::nullopt);
  EXPECT_EQ(both.mesh.region_names, (std::vector<std::string>{"flesh", "stone", "flesh layers", "stone layers"}));
  EXPECT_NEAR(volume_of(both.mesh, 2) / (5 * std::numbers::pi * height), 1, 0.05);
  EXPECT_NEAR(volume_of(both.mesh, 3) / (std::numbers::pi * height), 1, 0.1);
  ASSERT_EQ(both.report.layers.size(), 3u);
  asked.in = "flesh", asked.on = "core";
  const Result one = meshed(ball_in_ball(), asked, 0.15);
  EXPECT_EQ(first_defect(one.mesh), std::nullopt);
  EXPECT_EQ(one.mesh.region_names, (std::vector<std::string>{"flesh", "stone", "flesh layers"}));
  EXPECT_NEAR(volume_of(one.mesh, 1) / (4 * std::numbers::pi / 24), 1, 0.05);
  ASSERT_EQ(one.report.layers.size(), 1u);
  EXPECT_EQ(one.report.layers[0].full, 1);
  asked.in = "bone";
  EXPECT_THROW(meshed(ball_in_ball(), asked, 0.15), OptionError);
}

/// Between regions a wall that has no layers must stay.
TEST(Layers, EndBesideInnerWalls) {
  SurfaceMesh boxes;
  for (int i = 0; i < 3; ++i)
    for (const auto& [y, z] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
      boxes.points.push_back({double(i), double(y), double(z)});
  const auto add = [&](VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d, std::uint32_t patch, Sides sides) {
    for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, d}})
      boxes.triangles.push_back(t), boxes.patch.push_back(patch), boxes.sides.push_back(sides);
  };
  add(0, 3, 2, 1, 0, {kNone, 0}), add(8, 9, 10, 11, 0, {kNone, 1}), add(4, 5, 6, 7, 1, {1, 0});
  for (VertexIndex i = 0; i < 2; ++i)
    for (VertexIndex k = 0; k < 4; ++k) {
      const VertexIndex a = 4 * i + k, b = 4 * i + (k + 1) % 4;
      add(a, b, b + 4, a + 4, k == 0 ? 2 : 0, {kNone, i});
    }
  boxes.patch_names = {"rest", "between", "floor"};
  boxes.region_names = {"left", "right"};
  LayersOptions asked;
  asked.count = 3;
  asked.first = 0.01;
  asked.on = "floor (left)";
  const Result made = meshed(boxes, asked, 0.1);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  for (const Vec3 p : made.mesh.points) EXPECT_TRUE(p.y > -1e-12 && p.y < 1 + 1e-12);
  ASSERT_EQ(made.report.layers.size(), 1u);
  EXPECT_GT(made.report.layers[0].full, 0.5);
  EXPECT_EQ(made.report.layers[0].stopped.front().first, "bent patch beside");
}

TEST(Layers, GrowOutsideAsAShell) {
  LayersOptions asked;
  asked.count = 2;
  asked.total = 0.1;
  asked.outside = true;
  const double shell = 4 * std::numbers::pi / 3 * (1.1 * 1.1 * 1.1 - 1);
  for (const int order : {1, 2}) {
    const Result made = meshed(icosphere(3), asked, 0.15, order);
    EXPECT_EQ(first_defect(made.mesh), std::nullopt);
    EXPECT_EQ(made.mesh.region_names, (std::vector<std::string>{"volume", "layers"}));
    EXPECT_NEAR(made.report.volume / (4 * std::numbers::pi / 3 + shell), 1, order == 1 ? 0.03 : 0.002);
    ASSERT_EQ(made.report.layers.size(), 1u);
    EXPECT_EQ(made.report.layers[0].full, 1);
  }
  asked.on = "wall";
  const Result pipe_with_lagging = meshed(pipe(48, 20), asked, 0.25);
  EXPECT_EQ(first_defect(pipe_with_lagging.mesh), std::nullopt);
  EXPECT_EQ(pipe_with_lagging.report.layers.at(0).full, 1);
  for (const Vec3 p : pipe_with_lagging.mesh.points) EXPECT_TRUE(p.z > -1e-12 && p.z < 4 + 1e-12);
  EXPECT_NEAR(volume_of(pipe_with_lagging.mesh, 1) / (4 * std::numbers::pi * (1.1 * 1.1 - 1)), 1, 0.03);
}

/// Nodes over a curved edge of the wall curve with it: thin elements stay as good as they were.
TEST(Layers, HigherOrdersCurveThemWithTheirWall) {
  LayersOptions asked;
  asked.count = 4;
  asked.first = 0.001;  // the wall bends ten times as far
  for (const int order : {2, 3, 4}) {
    const Result made = meshed(icosphere(4), asked, 0.3, order);
    EXPECT_EQ(made.mesh.order(), order);
    EXPECT_EQ(first_defect(made.mesh), std::nullopt);
    EXPECT_EQ(check_jacobians(made.mesh).invalid, 0u);
    EXPECT_EQ(made.report.second_order.eased + made.report.second_order.eased_faces, 0u) << order;
    EXPECT_GT(made.report.second_order.largest_bend, 0.01);
    EXPECT_GT(made.report.second_order.least_scaled_jacobian, 0.5) << order;
    EXPECT_NEAR(made.report.volume / (4 * std::numbers::pi / 3), 1, order == 2 ? 0.002 : 1e-4) << order;
  }
}

/// Ends are hardly ever flat to the last bit.
TEST(Layers, EndOnPatchesThatLieAskew) {
  SurfaceMesh turned = pipe(48, 20);
  for (Vec3& p : turned.points) {
    const double a = 0.3, b = 0.7;
    p = {std::cos(a) * p.x - std::sin(a) * p.z, p.y, std::sin(a) * p.x + std::cos(a) * p.z};
    p = {std::cos(b) * p.x - std::sin(b) * p.y, std::sin(b) * p.x + std::cos(b) * p.y, p.z};
    p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  }
  LayersOptions asked;
  asked.count = 3;
  asked.first = 0.02;
  asked.on = "wall";
  const Result made = meshed(turned, asked, 0.25);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_EQ(made.report.layers.at(0).full, 1);
}

TEST(Layers, SharpRidgesAreLeftOut) {
  SurfaceMesh blade;  // an edge of .6 degrees
  blade.points = {{0, 0, 0}, {1, -0.005, 0}, {1, 0.005, 0}, {0, 0, 1}, {1, -0.005, 1}, {1, 0.005, 1}};
  blade.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  LayersOptions asked;
  asked.count = 2;
  asked.first = 0.001;
  const Result made = meshed(blade, asked, 0.05);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  ASSERT_EQ(made.report.layers.size(), 1u);
  EXPECT_LT(made.report.layers[0].full, 1);
  EXPECT_FALSE(made.report.layers[0].stopped.empty());
}

}  // namespace
}  // namespace octafront
