#include "improve/curved/node_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace octafront::curved {
namespace {

/// At t from -1 to 1, through nodes that are evenly spaced there.
Vec3 on_polynomial(const std::vector<Vec3>& nodes, double t) {
  Vec3 sum;
  const auto at = [&](std::size_t k) {
    return 2.0 * static_cast<double>(k) / static_cast<double>(nodes.size() - 1) - 1;
  };
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    double share = 1;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (i != k) share *= (t - at(i)) / (at(k) - at(i));
    sum += share * nodes[k];
  }
  return sum;
}

/// How far a polynomial leaves the unit circle's arc of this half-angle, whose nodes are looked for from `part` of the
/// way to the parabola.
double missed(int order, double angle, double part) {
  const std::array<Vec3, 2> ends{Vec3{-std::sin(angle), std::cos(angle), 0}, Vec3{std::sin(angle), std::cos(angle), 0}};
  const std::array<Vec3, 1> bulge{Vec3{0, 1 - std::cos(angle), 0}};
  std::vector<Vec3> nodes{ends[0]};
  for (std::size_t k = 0; k < nodes_in_edge(order); ++k) {
    const NodePlace<2> place = in_edge(order, k);
    nodes.push_back(normalized(place.mean_of(ends) + part * place.on_parabolas(bulge)));
  }
  nodes.push_back(ends[1]);
  double most = 0;
  for (int i = -100; i <= 100; ++i) most = std::max(most, std::abs(length(on_polynomial(nodes, i / 100.0)) - 1));
  return most;
}

TEST(NodePlaces, AnArcIsMissedByAHigherPower) {
  EXPECT_NEAR(missed(3, 0.2, 0) / std::pow(0.2, 4), 1 / 13.4, 1e-3);
  EXPECT_NEAR(missed(4, 0.2, 0) / std::pow(0.2, 6), 1 / 166.0, 1e-4);
  EXPECT_NEAR(std::log2(missed(3, 0.4, part_of_parabola(3)) / missed(3, 0.2, part_of_parabola(3))), 6, 0.1);
  EXPECT_NEAR(std::log2(missed(4, 0.8, part_of_parabola(4)) / missed(4, 0.4, part_of_parabola(4))), 8, 0.4);
  EXPECT_LT(missed(3, 0.4, part_of_parabola(3)), missed(3, 0.4, 0) / 250);
  EXPECT_LT(missed(4, 0.4, part_of_parabola(4)), missed(4, 0.4, 0) / 5000);
}

TEST(NodePlaces, ParabolasOfAFaceAreThoseOfItsEdges) {
  const std::array<Vec3, 3> off{Vec3{0, 0, 1}, Vec3{0, 2, 0}, Vec3{4, 0, 0}};
  const Vec3 middle = in_face(3, 0).on_parabolas(off);
  EXPECT_NEAR(middle.z, 4.0 / 9, 1e-15);
  EXPECT_NEAR(middle.y, 8.0 / 9, 1e-15);
  const NodePlace<3> on_edge{{2, 0, 2}, 4};
  EXPECT_EQ(on_edge.on_parabolas(off), (Vec3{0, 2, 0}));
}

}  // namespace
}  // namespace octafront::curved
