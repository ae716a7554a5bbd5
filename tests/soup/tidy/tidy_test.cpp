#include <octafront/error.h>
#include <octafront/repair.h>

#include "support/named_surfaces.h"

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Corner = std::tuple<double, double, double>;

/// What a surface is, apart from numbering: its triangles as corners, each started at its least one.
std::multiset<std::array<Corner, 3>> shape(const SurfaceMesh& s) {
  std::multiset<std::array<Corner, 3>> shape;
  for (const Triangle& t : s.triangles) {
    std::array<Corner, 3> corners;
    for (int i = 0; i < 3; ++i) corners[i] = {s.points[t[i]].x, s.points[t[i]].y, s.points[t[i]].z};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    shape.insert(corners);
  }
  return shape;
}

SurfaceMesh shuffled(const SurfaceMesh& s, std::mt19937& random) {
  SurfaceMesh result = s;
  std::vector<VertexIndex> old_to_new(s.points.size());
  for (VertexIndex v = 0; v < old_to_new.size(); ++v) old_to_new[v] = v;
  std::shuffle(old_to_new.begin(), old_to_new.end(), random);
  for (VertexIndex v = 0; v < old_to_new.size(); ++v) result.points[old_to_new[v]] = s.points[v];
  std::shuffle(result.triangles.begin(), result.triangles.end(), random);
  for (Triangle& t : result.triangles) {
    for (VertexIndex& v : t) v = old_to_new[v];
    std::rotate(t.begin(), t.begin() + random() % 3, t.end());
  }
  result.patch.clear();
  return result;
}

SurfaceMesh with_random_faces_turned(SurfaceMesh s, std::mt19937& random) {
  for (Triangle& t : s.triangles)
    if (random() % 2) std::swap(t[0], t[1]);
  return s;
}

/// Every triangle with corners of its own, as STL has it.
SurfaceMesh soup_of(const SurfaceMesh& s) {
  SurfaceMesh soup;
  for (const Triangle& t : s.triangles) {
    const auto v = static_cast<VertexIndex>(soup.points.size());
    for (const VertexIndex corner : t) soup.points.push_back(s.points[corner]);
    soup.triangles.push_back({v, v + 1, v + 2});
  }
  return soup;
}

std::vector<SurfaceMesh> samples_to_repair() {
  return {testing::cube(3), testing::unit_tetrahedron(), testing::icosphere(2), testing::torus(12, 8),
          testing::hollow_sphere(1)};
}

TEST(Repair, LeavesCleanSurfacesAlone) {
  for (const SurfaceMesh& s : samples_to_repair()) {
    const RepairedSurface repaired = repair_surface(s);
    EXPECT_EQ(repaired.surface, s);
    EXPECT_TRUE(repaired.notes.empty()) << repaired.notes.front();
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) EXPECT_EQ(repaired.surface.source_of(t), t);
  }
}

TEST(Repair, UndoesTurnedFacesSoupAndOrder) {
  std::mt19937 random(1);
  for (const SurfaceMesh& s : samples_to_repair()) {
    for (int round = 0; round < 5; ++round) {
      const SurfaceMesh broken = soup_of(with_random_faces_turned(shuffled(s, random), random));
      const RepairedSurface repaired = repair_surface(broken);
      EXPECT_EQ(shape(repaired.surface), shape(s));
      EXPECT_EQ(repaired.surface.points.size(), s.points.size());
      EXPECT_EQ(repaired.merged_vertices, broken.points.size() - s.points.size());
      EXPECT_TRUE(find_defects(repaired).clean()) << find_defects(repaired).describe();
    }
  }
}

TEST(Repair, ScaleAndShiftChangeNothing) {
  std::mt19937 random(2);
  for (const SurfaceMesh& s : samples_to_repair()) {
    for (const double scale : {1e-6, 1e6}) {
      const SurfaceMesh moved = testing::transformed(s, scale, Vec3{100, -20, 3} * scale);
      const RepairedSurface repaired = repair_surface(soup_of(with_random_faces_turned(moved, random)));
      EXPECT_EQ(shape(repaired.surface), shape(moved));
      EXPECT_TRUE(find_defects(repaired).clean());
    }
  }
}

TEST(Repair, ZeroAndMinusZeroAreOnePlace) {
  SurfaceMesh s = soup_of(testing::unit_tetrahedron());
  for (std::size_t v = 0; v < s.points.size(); v += 2)
    for (int axis = 0; axis < 3; ++axis)
      if (s.points[v][axis] == 0) s.points[v][axis] = -0.0;
  const RepairedSurface repaired = repair_surface(s);
  EXPECT_EQ(repaired.surface.points.size(), 4u);
  EXPECT_TRUE(find_defects(repaired).clean());
}

TEST(Repair, InsideOutShellIsTurned) {
  const RepairedSurface repaired = repair_surface(testing::reversed(testing::torus(12, 8)));
  EXPECT_EQ(shape(repaired.surface), shape(testing::torus(12, 8)));
  EXPECT_EQ(repaired.turned_shells, 1u);
  EXPECT_EQ(repaired.turned_faces, 0u);
  ASSERT_EQ(repaired.notes.size(), 1u);
}

TEST(Repair, NestedShellsFaceByTheirDepth) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    // Concentric shells with a second family beside them, each turned at random, in random order.
    const int depth = 1 + static_cast<int>(random() % 6);
    SurfaceMesh s;
    double expected = 0;
    for (const double x : {0., 10.}) {
      for (int k = 0; k < depth; ++k) {
        SurfaceMesh shell = testing::transformed(testing::icosphere(1), 4 - 0.5 * k, {x, 0.01 * k, 0});
        expected += (k % 2 == 0 ? 1 : -1) * enclosed_volume(shell);
        s = testing::joined(s, random() % 2 ? testing::reversed(shell) : shell);
      }
    }
    const RepairedSurface repaired = repair_surface(shuffled(s, random));
    EXPECT_NEAR(enclosed_volume(repaired.surface), expected, 1e-9);
    EXPECT_EQ(repaired.shells, 2u * depth);
    EXPECT_EQ(repaired.cavities, 2u * (depth / 2));
    EXPECT_EQ(repaired.bodies, 2u * ((depth + 1) / 2));
    EXPECT_TRUE(find_defects(repaired).clean());
    for (const std::uint32_t body : repaired.body_of_triangle) EXPECT_LT(body, repaired.bodies);
  }
}

TEST(Repair, CavityBelongsToTheBodyAroundIt) {
  const SurfaceMesh one = testing::hollow_sphere(1);
  const SurfaceMesh ball = testing::transformed(testing::icosphere(1), 0.2, {0, 0, 0});
  const SurfaceMesh other = testing::transformed(one, 1, {5, 0, 0});
  const SurfaceMesh s = testing::joined(testing::joined(one, ball), other);
  const RepairedSurface repaired = repair_surface(s);
  EXPECT_EQ(repaired.surface, s);
  EXPECT_EQ(repaired.bodies, 3u);
  EXPECT_EQ(repaired.cavities, 2u);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const Vec3 p = s.points[s.triangles[t][0]];
    EXPECT_EQ(repaired.body_of_triangle[t], p.x > 2 ? 2u : length(p) < 0.3 ? 1u : 0u);
  }
}

TEST(Repair, DuplicatesAndUnusedVerticesGo) {
  std::mt19937 random(4);
  SurfaceMesh s = testing::cube(2);
  s.patch.clear();
  const SurfaceMesh clean = s;
  s.points.push_back({7, 7, 7});
  for (int k = 0; k < 10; ++k) {
    Triangle copy = clean.triangles[random() % clean.triangles.size()];
    std::rotate(copy.begin(), copy.begin() + random() % 3, copy.end());
    if (k % 2) std::swap(copy[0], copy[1]);
    s.triangles.push_back(copy);
  }
  const RepairedSurface repaired = repair_surface(s);
  EXPECT_EQ(repaired.surface, clean);
  EXPECT_EQ(repaired.duplicate_faces, 10u);
  EXPECT_EQ(repaired.unused_vertices, 1u);
}

TEST(Repair, DoubledSurfacesBecomeSingle) {
  const SurfaceMesh s = testing::icosphere(1);
  for (const SurfaceMesh& copy : {s, testing::reversed(s)}) {
    const RepairedSurface repaired = repair_surface(testing::joined(s, copy));
    EXPECT_EQ(repaired.surface, s);
    EXPECT_EQ(repaired.duplicate_faces, s.triangles.size());
  }
}

TEST(Repair, WallBetweenBodiesGoes) {
  const SurfaceMesh right = testing::transformed(testing::cube(2), 1, {1, 0, 0});
  const RepairedSurface repaired = repair_surface(testing::joined(testing::cube(2), right));
  EXPECT_EQ(repaired.duplicate_faces, 16u);
  EXPECT_EQ(repaired.bodies, 1u);
  EXPECT_TRUE(find_defects(repaired).clean()) << find_defects(repaired).describe();
  EXPECT_DOUBLE_EQ(enclosed_volume(repaired.surface), 2);
}

TEST(Repair, SheetWithoutThicknessGoesUnlessItIsAllThereIs) {
  SurfaceMesh sheet;
  sheet.points = {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}};
  const SurfaceMesh ball = testing::icosphere(1);
  EXPECT_EQ(repair_surface(testing::joined(ball, sheet)).surface, ball);
  EXPECT_EQ(find_defects(repair_surface(sheet)).open_edges.count, 4u);
}

/// Divides the edge a-b of face t by a vertex on it, on the side of t only, and closes the gap by a flat face.
void add_flat_face(SurfaceMesh& s, std::size_t t, int i, double where) {
  const VertexIndex a = s.triangles[t][i], b = s.triangles[t][(i + 1) % 3], c = s.triangles[t][(i + 2) % 3];
  const auto m = static_cast<VertexIndex>(s.points.size());
  s.points.push_back(s.points[a] + (s.points[b] - s.points[a]) * where);
  s.triangles[t] = {a, m, c};
  s.triangles.push_back({m, b, c});
  s.triangles.push_back({a, b, m});
}

TEST(Repair, FlatFacesAreClosedUp) {
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    // Coordinates are small multiples of powers of two: points on edges are exactly on them.
    SurfaceMesh s = testing::transformed(testing::cube(4), 64, {0, 0, 0});
    s.patch.clear();
    for (int k = 0; k < 30; ++k) {
      const std::size_t t = random() % s.triangles.size();
      const auto [a, b, c] = s.triangles[t];
      const Vec3 n = cross(s.points[b] - s.points[a], s.points[c] - s.points[a]);
      if (squared_length(n) > 0) add_flat_face(s, t, static_cast<int>(random() % 3), 0.5);
    }
    const std::size_t added = s.points.size() - testing::cube(4).points.size();
    for (const SurfaceMesh& input : {s, soup_of(with_random_faces_turned(s, random))}) {
      const RepairedSurface repaired = repair_surface(input);
      const SurfaceDefects defects = find_defects(repaired);
      EXPECT_TRUE(defects.clean()) << defects.describe();
      EXPECT_DOUBLE_EQ(enclosed_volume(repaired.surface), 64. * 64 * 64);
      EXPECT_EQ(repaired.degenerate_faces, added);
      EXPECT_LE(repaired.divided_faces, added);
    }
  }
}

TEST(Repair, RowOfFlatFacesOnOneLineIsClosedUp) {
  // A side of the triangle is a fan of flat faces about its end, as triangulators of polygons leave them.
  SurfaceMesh s = testing::transformed(testing::unit_tetrahedron(), 1024, {0, 0, 0});
  const int n = 200;
  const std::size_t t = 0;
  const auto [a, b, c] = s.triangles[t];
  const VertexIndex first = static_cast<VertexIndex>(s.points.size());
  for (int k = 1; k < n; ++k) s.points.push_back(s.points[a] + (s.points[b] - s.points[a]) * (k / 256.0));
  const auto on = [&](int k) { return k == 0 ? a : k == n ? b : static_cast<VertexIndex>(first + k - 1); };
  s.triangles.erase(s.triangles.begin());
  for (int k = 0; k < n; ++k) s.triangles.push_back({on(k), on(k + 1), c});
  for (int k = 1; k < n; ++k) s.triangles.push_back({a, on(k + 1), on(k)});
  const RepairedSurface repaired = repair_surface(s);
  EXPECT_TRUE(find_defects(repaired).clean()) << find_defects(repaired).describe();
  EXPECT_EQ(repaired.surface.points.size(), s.points.size());
}

TEST(Repair, FacesWithARepeatedVertexGo) {
  SurfaceMesh s = testing::cube(2);
  s.patch.clear();
  const SurfaceMesh clean = s;
  s.triangles.push_back({3, 3, 5});
  s.triangles.push_back({3, 3, 3});
  const RepairedSurface repaired = repair_surface(s);
  EXPECT_EQ(repaired.surface, clean);
  EXPECT_EQ(repaired.degenerate_faces, 2u);
}

TEST(Repair, PatchesAndFacesFollow) {
  SurfaceMesh s = testing::cube(2);
  s.patch_names = {"left", "right", "front", "back", "bottom", "top"};
  SurfaceMesh input = s;
  input.triangles.insert(input.triangles.begin(), s.triangles[7]);
  input.patch.insert(input.patch.begin(), s.patch[7]);
  const RepairedSurface repaired = repair_surface(input);
  EXPECT_EQ(repaired.surface.patch_names, s.patch_names);
  for (std::size_t t = 0; t < repaired.surface.triangles.size(); ++t) {
    const std::uint32_t face = repaired.surface.source_of(t);
    EXPECT_EQ(repaired.surface.triangles[t], input.triangles[face]);
    EXPECT_EQ(repaired.surface.patch[t], input.patch[face]);
  }
}

/// Triangles between few points of a lattice: every kind of trouble at once.
SurfaceMesh soup_on_lattice(std::mt19937& random) {
  SurfaceMesh s;
  const int points = 4 + static_cast<int>(random() % 30), side = 2 + static_cast<int>(random() % 3);
  for (int k = 0; k < points; ++k)
    s.points.push_back({double(random() % side), double(random() % side), double(random() % side)});
  const int triangles = 1 + static_cast<int>(random() % 200);
  for (int k = 0; k < triangles; ++k) {
    Triangle t;
    for (VertexIndex& v : t) v = static_cast<VertexIndex>(random() % points);
    s.triangles.push_back(t);
  }
  return s;
}

TEST(Repair, OfAnySoupLeavesNothingToRepair) {
  std::mt19937 random(6);
  for (int round = 0; round < 300; ++round) {
    const SurfaceMesh soup = soup_on_lattice(random);
    const RepairedSurface once = repair_surface(soup);
    const RepairedSurface twice = repair_surface(once.surface);
    EXPECT_EQ(twice.surface, once.surface);
    EXPECT_EQ(twice.bodies, once.bodies);
    EXPECT_EQ(twice.cavities, once.cavities);
    const SurfaceDefects defects = find_defects(once);
    EXPECT_EQ(defects.degenerate_faces.count, 0u);
    EXPECT_EQ(defects.clean(), defects.describe().empty());
    std::set<std::set<VertexIndex>> faces;
    for (const Triangle& t : once.surface.triangles) faces.insert({t[0], t[1], t[2]});
    EXPECT_EQ(faces.size(), once.surface.triangles.size());
  }
}

TEST(Repair, NeverOpensWhatHasOnlyEvenEdges) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    // Sums of closed shells, however they touch, overlap or coincide, have an even number of faces at each edge.
    SurfaceMesh s;
    const int shells = 1 + static_cast<int>(random() % 6);
    for (int k = 0; k < shells; ++k) {
      const Vec3 shift{double(random() % 3), double(random() % 3), double(random() % 2)};
      const SurfaceMesh cube = testing::transformed(testing::cube(1 + static_cast<int>(random() % 2)), 2, shift);
      s = testing::joined(s, random() % 2 ? cube : testing::reversed(cube));
    }
    s.patch.clear();
    EXPECT_EQ(find_defects(repair_surface(s)).open_edges.count, 0u);
  }
}

TEST(Repair, NothingLeftIsADefect) {
  SurfaceMesh flat;
  flat.points = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  flat.triangles = {{0, 1, 2}, {2, 2, 1}};
  for (const SurfaceMesh& s : {SurfaceMesh{}, flat}) {
    const RepairedSurface repaired = repair_surface(s);
    EXPECT_TRUE(repaired.surface.triangles.empty());
    EXPECT_TRUE(repaired.surface.points.empty());
    EXPECT_FALSE(find_defects(repaired).clean());
    EXPECT_NE(find_defects(repaired).describe(), "");
  }
}

TEST(Repair, DamagedInputIsRefused) {
  SurfaceMesh s = testing::cube();
  s.triangles[3][1] = 1000;
  EXPECT_THROW(repair_surface(s), InputError);
  s = testing::cube();
  s.points[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(repair_surface(s), InputError);
  s.points[2].y = 1e200;
  EXPECT_THROW(repair_surface(s), InputError);
  s = testing::cube();
  s.source = {1, 2};
  EXPECT_THROW(repair_surface(s), InputError);
}

}  // namespace
}  // namespace octafront
