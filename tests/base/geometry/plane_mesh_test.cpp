#include "base/geometry/plane_mesh.h"

#include <octafront/error.h>

#include "support/random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace octafront::arrangement {
namespace {

double area_of_piece(const PlaneMesh& mesh, const PlaneMesh::Piece& piece) {
  const Vec3 a = mesh.place(piece.corners[0]).at, b = mesh.place(piece.corners[1]).at,
             c = mesh.place(piece.corners[2]).at;
  return cross(b - a, c - a).z / 2;
}

/// The plane z = 0.
PlaneMesh::Node node(PlaneMesh& mesh, double x, double y) {
  return mesh.add_point({{x, y, 0}});
}

void add_triangle(PlaneMesh& mesh, const std::array<Vec3, 3>& t, std::uint32_t face) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 a = t[i], b = t[(i + 1) % 3];
    mesh.add_segment(mesh.add_point({a}), mesh.add_point({b}), plane_along_axis(a, b, 2), face);
  }
}

const Homogeneous kGround = plane_through({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
const Box3 kBox{{0, 0, 0}, {10, 10, 0}};

TEST(PlaneMesh, APlaceHasOneNode) {
  PlaneMesh mesh(kGround, 2, kBox);
  const auto a = node(mesh, 1, 1), b = node(mesh, 3, 1), c = node(mesh, 2, 1);
  EXPECT_NE(a, b);
  EXPECT_EQ(node(mesh, 2, 1), c);
  EXPECT_EQ(node(mesh, 1, 1), a);
}

TEST(PlaneMesh, SegmentsThatCrossMeetInAnExactPoint) {
  PlaneMesh mesh(kGround, 2, kBox);
  const Vec3 a{0, 0, 0}, b{3, 1, 0}, c{0, 1, 0}, d{3, 0, 0};
  mesh.add_segment(mesh.add_point({a}), mesh.add_point({b}), plane_along_axis(a, b, 2));
  mesh.add_segment(mesh.add_point({c}), mesh.add_point({d}), plane_along_axis(c, d, 2));
  ASSERT_EQ(mesh.crossings().size(), 1U);
  EXPECT_EQ(mesh.crossings()[0].at, (Vec3{1.5, 0.5, 0}));
}

TEST(PlaneMesh, PiecesKnowWhatCoversThem) {
  PlaneMesh mesh(kGround, 2, kBox);
  add_triangle(mesh, {Vec3{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 0);
  add_triangle(mesh, {Vec3{0, 0, 0}, {4, 0, 0}, {4, 4, 0}}, 1);
  mesh.improve();
  std::array<double, 3> area{};
  for (const auto& piece : mesh.pieces()) {
    EXPECT_GT(area_of_piece(mesh, piece), 0);
    area[piece.faces.size() == 2 ? 2 : piece.faces[0]] += area_of_piece(mesh, piece);
  }
  EXPECT_DOUBLE_EQ(area[0], 4);
  EXPECT_DOUBLE_EQ(area[1], 4);
  EXPECT_DOUBLE_EQ(area[2], 4);
}

TEST(PlaneMesh, CoversEveryFaceByItsArea) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    testing::Random random(seed);
    PlaneMesh mesh(kGround, 2, kBox);
    // A small lattice, so that corners lie on edges, and edges on each other.
    const int side = seed % 2 == 0 ? 4 : 10;
    std::vector<double> wanted, covered;
    for (std::uint32_t face = 0; face < 8; ++face) {
      std::array<Vec3, 3> t;
      double area = 0;
      while (area == 0) {
        for (Vec3& p : t) p = {1.0 * random.integer(0, side), 1.0 * random.integer(0, side), 0};
        area = cross(t[1] - t[0], t[2] - t[0]).z / 2;
      }
      add_triangle(mesh, t, face);
      wanted.push_back(std::abs(area));
    }
    mesh.improve();
    covered.resize(wanted.size());
    for (const auto& piece : mesh.pieces()) {
      EXPECT_GT(area_of_piece(mesh, piece), 0);
      for (const std::uint32_t face : piece.faces) covered[face] += area_of_piece(mesh, piece);
    }
    for (std::size_t f = 0; f < wanted.size(); ++f) EXPECT_NEAR(covered[f], wanted[f], 1e-12);
  }
}

TEST(PlaneMesh, TakesNoMoreCrossingsThanItMay) {
  CrossingBudget budget(3);
  PlaneMesh mesh(kGround, 2, kBox, &budget);
  const auto cross = [&](double y) {
    const auto a = mesh.add_point({Vec3{0.1, y, 0}}), b = mesh.add_point({Vec3{0.9, y, 0}});
    mesh.add_segment(a, b, plane_along_axis({0.1, y, 0}, {0.9, y, 0}, 2));
  };
  const auto a = mesh.add_point({Vec3{0.5, 0.05, 0}}), b = mesh.add_point({Vec3{0.5, 0.95, 0}});
  mesh.add_segment(a, b, plane_along_axis({0.5, 0.05, 0}, {0.5, 0.95, 0}, 2));
  for (const double y : {0.2, 0.4, 0.6}) cross(y);
  EXPECT_EQ(mesh.crossings().size(), 3);
  EXPECT_THROW(cross(0.8), InputError);
}

}  // namespace
}  // namespace octafront::arrangement
