// Periods that are no axes of a box: sectors by rotation, oblique and hexagonal cells by translations.

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/quality.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using ::testing::HasSubstr;

constexpr double kPi = 3.14159265358979323846;

/// Triangles by the places of their corners.
class Grid {
 public:
  explicit Grid(std::vector<std::string> patches) { surface_.patch_names = std::move(patches); }

  void quad(std::uint32_t patch, Vec3 a, Vec3 b, Vec3 c, Vec3 d, bool turned = false) {
    if (turned)
      add(patch, a, b, d), add(patch, b, c, d);
    else
      add(patch, a, b, c), add(patch, a, c, d);
  }
  void add(std::uint32_t patch, Vec3 a, Vec3 b, Vec3 c) {
    const Triangle t{vertex(a), vertex(b), vertex(c)};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return;
    surface_.triangles.push_back(t), surface_.patch.push_back(patch);
  }
  SurfaceMesh take() { return std::move(surface_); }

 private:
  VertexIndex vertex(Vec3 p) {
    const auto rounded = [](double x) { return std::round(x * 1e9); };
    const auto [at, is_new] = number_.try_emplace({rounded(p.x), rounded(p.y), rounded(p.z)},
                                                  static_cast<VertexIndex>(surface_.points.size()));
    if (is_new) surface_.points.push_back(p);
    return at->second;
  }
  SurfaceMesh surface_;
  std::map<std::array<double, 3>, VertexIndex> number_;
};

/// A sector of a ring from radius `inner` (0: a piece of pie) to 2, .8 high; `twist`: by radius and height. `turned`:
/// the high face has other diagonals than the low one.
SurfaceMesh sector(double degrees, double inner, const std::function<double(double, double)>& twist, bool turned) {
  constexpr int kRadial = 6, kAround = 8, kUp = 5;
  const auto at = [&](int i, int j, int k) {
    const double r = inner + (2 - inner) * i / kRadial, z = 0.8 * k / kUp;
    const double angle = degrees * kPi / 180 * j / kAround + twist(r, z);
    return Vec3{r * std::cos(angle), r * std::sin(angle), z};
  };
  Grid grid({"left", "right", "rims"});
  for (int i = 0; i < kRadial; ++i)
    for (int k = 0; k < kUp; ++k) {
      grid.quad(0, at(i, 0, k), at(i + 1, 0, k), at(i + 1, 0, k + 1), at(i, 0, k + 1));
      grid.quad(1, at(i, kAround, k), at(i, kAround, k + 1), at(i + 1, kAround, k + 1), at(i + 1, kAround, k), turned);
    }
  for (int j = 0; j < kAround; ++j) {
    for (int k = 0; k < kUp; ++k) {
      grid.quad(2, at(kRadial, j, k), at(kRadial, j + 1, k), at(kRadial, j + 1, k + 1), at(kRadial, j, k + 1));
      grid.quad(2, at(0, j, k), at(0, j, k + 1), at(0, j + 1, k + 1), at(0, j + 1, k));
    }
    for (int i = 0; i < kRadial; ++i) {
      grid.quad(2, at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
      grid.quad(2, at(i, j, kUp), at(i + 1, j, kUp), at(i + 1, j + 1, kUp), at(i, j + 1, kUp));
    }
  }
  return grid.take();
}

/// The cell that three vectors span, with other diagonals on opposite faces.
SurfaceMesh spanned(Vec3 u, Vec3 v, Vec3 w) {
  constexpr int kParts = 3;
  const auto at = [&](int i, int j, int k) {
    return Vec3{0.1, 0.2, -0.3} + (u * i + v * j + w * k) / static_cast<double>(kParts);
  };
  Grid grid({"walls"});
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; j < kParts; ++j) {
      const int n = kParts;
      grid.quad(0, at(0, i, j), at(0, i, j + 1), at(0, i + 1, j + 1), at(0, i + 1, j));
      grid.quad(0, at(n, i, j), at(n, i + 1, j), at(n, i + 1, j + 1), at(n, i, j + 1), true);
      grid.quad(0, at(i, 0, j), at(i + 1, 0, j), at(i + 1, 0, j + 1), at(i, 0, j + 1));
      grid.quad(0, at(i, n, j), at(i, n, j + 1), at(i + 1, n, j + 1), at(i + 1, n, j));
      grid.quad(0, at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
      grid.quad(0, at(i, j, n), at(i + 1, j, n), at(i + 1, j + 1, n), at(i, j + 1, n), true);
    }
  return grid.take();
}

/// A regular hexagon of side 1, .7 high, each side in three.
SurfaceMesh hexagon() {
  constexpr int kParts = 3, kUp = 2;
  Grid grid({"walls"});
  const auto corner = [](int s) { return Vec3{std::cos(s * kPi / 3), std::sin(s * kPi / 3), 0}; };
  const Vec3 up{0, 0, 0.7};
  for (int s = 0; s < 6; ++s)
    for (int i = 0; i < kParts; ++i) {
      const auto on = [&](int k) { return corner(s) + (corner(s + 1) - corner(s)) * (double(k) / kParts); };
      const Vec3 a = on(i), b = on(i + 1);
      for (int k = 0; k < kUp; ++k) {
        const Vec3 low = up * (double(k) / kUp), high = up * (double(k + 1) / kUp);
        grid.quad(0, a + low, b + low, b + high, a + high);
      }
      grid.add(0, {}, b, a);
      grid.add(0, up, a + up, b + up);
    }
  return grid.take();
}

Options by(double h, const char* periods) {
  Options o;
  o.size.size = h;
  o.periodic = periods;
  return o;
}

Vec3 led(const TetMesh& mesh, std::uint32_t period, Vec3 p) {
  const Vec3 t = mesh.periods.at(period);
  if (mesh.period_rotations.empty()) return {p.x + t.x, p.y + t.y, p.z + t.z};
  const auto& r = mesh.period_rotations.at(period);
  const auto row = [&](int i) { return (r[i].x * p.x + r[i].y * p.y) + r[i].z * p.z; };
  return {row(0) + t.x, row(1) + t.y, row(2) + t.z};
}

std::set<std::array<VertexIndex, 3>> faces_of(const TetMesh& mesh, const std::string& patch,
                                              const std::map<VertexIndex, VertexIndex>& renamed) {
  std::set<std::array<VertexIndex, 3>> found;
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
    if (mesh.patch_names.at(mesh.patch.at(f)) != patch) continue;
    Triangle t = mesh.boundary[f];
    for (VertexIndex& v : t)
      if (const auto at = renamed.find(v); at != renamed.end()) v = at->second;
    std::sort(t.begin(), t.end());
    found.insert(t);
  }
  return found;
}

/// Every node of the high faces is where its original leads, and the triangles are the same.
void expect_copies(const TetMesh& mesh, const std::vector<std::array<std::string, 2>>& faces) {
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  ASSERT_EQ(mesh.periods.size(), faces.size());
  for (std::uint32_t k = 0; k < faces.size(); ++k) {
    SCOPED_TRACE(k);
    std::map<VertexIndex, VertexIndex> original_of;
    for (const auto& [period, copy, original] : mesh.periodic_nodes) {
      if (period != k) continue;
      EXPECT_EQ(mesh.points[copy], led(mesh, k, mesh.points[original]));
      EXPECT_NE(copy, original);
      original_of[copy] = original;
    }
    const auto low = faces_of(mesh, faces[k][0], {});
    EXPECT_GT(low.size(), 2u);
    EXPECT_EQ(low, faces_of(mesh, faces[k][1], original_of));
  }
}

double straight(double, double) {
  return 0;
}
double twisted(double r, double z) {
  return 0.3 * z + 0.25 * (r - 1) * (r - 1);
}

TEST(PeriodicMaps, SectorsHaveTheSameFaces) {
  for (const double h : {0.5, 0.15})
    for (const double inner : {1.0, 0.0}) {
      SCOPED_TRACE(::testing::Message() << h << " " << inner);
      const SurfaceMesh surface = sector(30, inner, straight, true);
      const Result r = generate(surface, by(h, "30@z"));
      expect_copies(r.mesh, {{"left", "right"}});
      EXPECT_NEAR(r.report.volume, enclosed_volume(surface), 0.02 * r.report.volume);
      EXPECT_GT(r.report.quality.dihedral_min, 10);
    }
}

TEST(PeriodicMaps, CurvedFacesAreFoundOrNamed) {
  const SurfaceMesh alike = sector(30, 1, twisted, false), other = sector(30, 1, twisted, true);
  for (const auto& [surface, words] : {std::pair{alike, "360/12@0,0,-5,0,0,3"}, std::pair{other, "left:right=30@z"}}) {
    SCOPED_TRACE(words);
    const Result r = generate(surface, by(0.2, words));
    expect_copies(r.mesh, {{"left", "right"}});
    EXPECT_NEAR(r.report.volume, enclosed_volume(surface), 0.02 * r.report.volume);
  }
}

TEST(PeriodicMaps, SecondOrderPairsMidSideNodes) {
  Options o = by(0.3, "30@z");
  o.order = 2;
  for (const auto& twist : {straight, twisted}) {
    const Result r = generate(sector(30, 1, twist, false), o);
    EXPECT_TRUE(r.mesh.is_second_order());
    expect_copies(r.mesh, {{"left", "right"}});
    VertexIndex last_corner = 0;
    for (const Tet& t : r.mesh.tets) last_corner = std::max(last_corner, *std::max_element(t.begin(), t.end()));
    EXPECT_TRUE(std::any_of(r.mesh.periodic_nodes.begin(), r.mesh.periodic_nodes.end(),
                            [&](const auto& pair) { return pair[1] > last_corner; }));
  }
}

TEST(PeriodicMaps, ObliqueCellsGoOnInAllDirections) {
  const SurfaceMesh cell = spanned({1, 0, 0}, {0.3, 0.9, 0}, {0.2, -0.1, 0.8});
  const Result r = generate(cell, by(0.1, "1,0,0; 0.3,0.9,0; 0.2,-0.1,0.8"));
  expect_copies(r.mesh, {{"periodic_1_low", "periodic_1_high"},
                         {"periodic_2_low", "periodic_2_high"},
                         {"periodic_3_low", "periodic_3_high"}});
  EXPECT_NEAR(r.report.volume, enclosed_volume(cell), 1e-9);
  const Result without = generate(cell, by(0.1, ""));
  EXPECT_NEAR(r.report.quality.beta_mean, without.report.quality.beta_mean, 0.01);
}

TEST(PeriodicMaps, HalfATurnLeadsBothFacesToEachOther) {
  const SurfaceMesh half = sector(180, 1, straight, true);
  const Result r = generate(half, by(0.3, "180@z"));
  expect_copies(r.mesh, {{"left", "right"}});
  EXPECT_NEAR(r.report.volume, enclosed_volume(half), 0.02 * r.report.volume);
}

TEST(PeriodicMaps, HexagonsGoOnInThreeDirections) {
  const Result r = generate(hexagon(), by(0.2,
                                          "1.5,0.8660254037844386,0; 0,1.7320508075688772,0; "
                                          "-1.5,0.8660254037844386,0; 0,0,0.7"));
  expect_copies(r.mesh, {{"periodic_1_low", "periodic_1_high"},
                         {"periodic_2_low", "periodic_2_high"},
                         {"periodic_3_low", "periodic_3_high"},
                         {"periodic_4_low", "periodic_4_high"}});
}

TEST(PeriodicMaps, ImprovementKeepsPairs) {
  const SurfaceMesh surface = sector(30, 0, straight, false);
  const Result r = generate(surface, by(0.3, "30@z"));
  for (const int order : {1, 2, 3, 4})
    for (const SurfaceMesh* on : {static_cast<const SurfaceMesh*>(nullptr), &surface}) {
      SCOPED_TRACE(::testing::Message() << order << " " << (on != nullptr));
      Options o;
      o.order = order;
      const Improved better = improve_existing(r.mesh, o, on);
      expect_copies(better.mesh, {{"left", "right"}});
      EXPECT_EQ(check_jacobians(better.mesh).invalid, 0u);
      EXPECT_GE(better.mesh.periodic_nodes.size(), order * r.mesh.periodic_nodes.size());
    }
}

TEST(PeriodicMaps, WhatIsNotTheSameIsRefusedWithAPlace) {
  const auto refused = [](const SurfaceMesh& surface, const char* words) {
    try {
      generate(surface, by(0.3, words));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const SurfaceMesh ring = sector(30, 1, straight, true);
  EXPECT_THAT(refused(ring, "31@z"), HasSubstr("leads no part of the surface onto another one"));
  EXPECT_THAT(refused(ring, "left:wrong=30@z"), HasSubstr("no region or patch \"wrong\""));
  EXPECT_THAT(refused(ring, "left:rims=30@z"), HasSubstr("has a line at ("));
  EXPECT_THAT(refused(ring, "left:right=29.9@z"), HasSubstr("has a line at ("));
}

}  // namespace
}  // namespace octafront
