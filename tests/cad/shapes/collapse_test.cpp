#include "cad/shapes/collapse_tiny.h"
#include "cad/shapes/face_groups.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

/// A step of height .01 between two squares, the lower behind x = 1 and the upper before it: faces 0, 1 (the step), 2,
/// seen from above. The upper line of the step has a sample in its middle.
CadModel step() {
  CadModel m;
  m.points = {{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},   {1, 0, .01},
              {2, 0, .01}, {2, 1, .01}, {1, 1, .01}, {1, .5, .01}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 8}, {1, 8, 2}, {2, 8, 7}, {4, 5, 8}, {5, 6, 8}, {6, 7, 8}};
  m.face_of = {0, 0, 1, 1, 1, 2, 2, 2};
  m.corners.resize(m.triangles.size());
  m.faces.resize(3);
  for (Face& face : m.faces) face.sides = {kNone, 0}, face.area = 1;
  m.faces[0].area = 2, m.faces[1].area = .01;
  m.solids.resize(1);
  const auto edge = [&](std::vector<VertexIndex> vertices, std::vector<std::uint32_t> faces, double length) {
    CadEdge& made = m.edges.emplace_back();
    for (std::size_t k = 0; k < vertices.size(); ++k) made.parameters.push_back(length * static_cast<double>(k));
    made.vertices = std::move(vertices), made.faces = std::move(faces), made.length = length;
  };
  edge({1, 2}, {0, 1}, 1), edge({4, 8, 7}, {1, 2}, 1);
  edge({1, 4}, {1}, .01), edge({2, 7}, {1}, .01);
  edge({0, 1}, {0}, 1), edge({2, 3}, {0}, 1), edge({3, 0}, {0}, 1);
  edge({4, 5}, {2}, 1), edge({5, 6}, {2}, 1), edge({6, 7}, {2}, 1);
  m.vertices = {0, 1, 2, 3, 4, 5, 6, 7};
  return m;
}

TEST(CollapseTiny, TakesAStepOut) {
  CadModel m = step();
  const Collapsed made = collapse_tiny(m, .05);
  EXPECT_EQ(made.faces, std::vector<std::uint32_t>{1});
  EXPECT_EQ(made.edges, 2u);
  EXPECT_EQ(std::count(m.face_of.begin(), m.face_of.end(), 0u), 3);  // one was divided by the sample of the upper line
  EXPECT_EQ(std::count(m.face_of.begin(), m.face_of.end(), 2u), 3);
  for (const Triangle& t : m.triangles)
    for (const VertexIndex v : t) EXPECT_TRUE(v != 4 && v != 7) << "the upper ones go to the face that is larger";
}

TEST(CollapseTiny, LeavesOneLineBetweenTheFacesThatAreLeft) {
  CadModel m = step();
  collapse_tiny(m, .05);
  std::vector<CadEdge> between;
  for (const CadEdge& edge : m.edges)
    if (edge.faces == std::vector<std::uint32_t>{0, 2}) between.push_back(edge);
  ASSERT_EQ(between.size(), 1u);
  EXPECT_EQ(between[0].vertices, (std::vector<VertexIndex>{1, 8, 2}));
  EXPECT_EQ(between[0].parameters, (std::vector<double>{0, .5, 1}));
  EXPECT_TRUE(between[0].is_smooth);
}

TEST(CollapseTiny, LeavesWhatIsLarger) {
  CadModel m = step();
  EXPECT_TRUE(collapse_tiny(m, .005).faces.empty());
  EXPECT_EQ(m.triangles, step().triangles);
}

TEST(CollapseTiny, SparesFacesWithTheirEdges) {
  CadModel m = step();
  m.faces[1].labels.name = "step";
  const std::vector<std::string> named{"step"};
  const std::vector<std::uint32_t> spared = faces_at(m, named);
  EXPECT_EQ(spared, std::vector<std::uint32_t>{1});
  const Collapsed made = collapse_tiny(m, .05, spared);
  EXPECT_TRUE(made.faces.empty());
  EXPECT_EQ(made.edges, 0u);
  EXPECT_EQ(m.triangles, step().triangles);
}

TEST(CollapseTiny, DoesNotCloseAThinPlate) {
  CadModel m = step();
  for (const VertexIndex v : {5u, 6u}) m.points[v].x = 0;  // the upper face is above the lower, which looks down
  for (Triangle& t : m.triangles) std::swap(t[1], t[2]);
  EXPECT_TRUE(collapse_tiny(m, .05).faces.empty());
  EXPECT_EQ(std::count(m.face_of.begin(), m.face_of.end(), 1u), 3);
}

/// Faces that belong to no solid: nobody knows which side of them is out.
CadModel loose(CadModel m) {
  m.solids.clear();
  for (Face& face : m.faces) face.sides = {kNone, kNone};
  return m;
}

TEST(CollapseTiny, TakesAStepOutOfLooseFacesWhereTheyTurn) {
  CadModel m = loose(step());
  for (const VertexIndex v : {5u, 6u}) m.points[v].x = 1, m.points[v].z = 1;
  EXPECT_EQ(collapse_tiny(m, .05).faces, std::vector<std::uint32_t>{1});
}

TEST(CollapseTiny, LeavesAStepOfLooseFacesThatMayBeAPlate) {
  CadModel m = loose(step());
  EXPECT_TRUE(collapse_tiny(m, .05).faces.empty());
}

/// Between two squares a wedge, face 1, that begins in (0, 1) at 3 degrees and is .01, .06 and .2 wide at samples of
/// the upper line; the lower line may lack the first.
CadModel wedge_between_squares(bool has_both_samples) {
  CadModel m;
  m.points = {{0, 0, 0},   {1, 0, 0},     {1, 1, 0},     {.5, 1, 0}, {.2, 1, 0}, {0, 1, 0},
              {1, 1.2, 0}, {.5, 1.06, 0}, {.2, 1.01, 0}, {1, 2, 0},  {0, 2, 0}};
  if (has_both_samples) {
    m.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {5, 4, 8}, {4, 3, 7}, {4, 7, 8}, {3, 2, 6}, {3, 6, 7}};
    m.face_of = {0, 0, 0, 0, 1, 1, 1, 1, 1};
  } else {
    m.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {5, 3, 8}, {3, 7, 8}, {3, 2, 6}, {3, 6, 7}};
    m.face_of = {0, 0, 0, 1, 1, 1, 1};
  }
  for (const Triangle& t : {Triangle{5, 8, 10}, Triangle{8, 7, 10}, Triangle{7, 6, 10}, Triangle{6, 9, 10}})
    m.triangles.push_back(t), m.face_of.push_back(2);
  m.corners.resize(m.triangles.size());
  m.faces.resize(3);
  for (Face& face : m.faces) face.sides = {kNone, 0}, face.area = 1;
  m.faces[1].area = .1;
  m.solids.resize(1);
  const auto edge = [&](std::vector<VertexIndex> vertices, std::vector<std::uint32_t> faces) {
    CadEdge& made = m.edges.emplace_back();
    for (std::size_t k = 0; k < vertices.size(); ++k) made.parameters.push_back(static_cast<double>(k));
    made.vertices = std::move(vertices), made.faces = std::move(faces), made.length = 1;
  };
  edge(has_both_samples ? std::vector<VertexIndex>{5, 4, 3, 2} : std::vector<VertexIndex>{5, 3, 2}, {0, 1});
  edge({5, 8, 7, 6}, {1, 2});
  edge({0, 1}, {0}), edge({1, 2}, {0}), edge({2, 6}, {1}), edge({6, 9}, {2}), edge({9, 10}, {2});
  edge({10, 5}, {2}), edge({5, 0}, {0});
  return m;
}

double least_angle(const CadModel& m, std::uint32_t face) {
  double least = 180;
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (std::size_t k = 0; m.face_of[t] == face && k < 3; ++k) {
      const Vec3 a = m.points[m.triangles[t][k]];
      const Vec3 u = m.points[m.triangles[t][(k + 1) % 3]] - a, v = m.points[m.triangles[t][(k + 2) % 3]] - a;
      least = std::min(least, std::atan2(length(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi);
    }
  return least;
}

class EndNarrowParts : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Samples, EndNarrowParts, testing::Bool());

TEST_P(EndNarrowParts, EndsAWedgeWhereItIsTooNarrow) {
  CadModel m = wedge_between_squares(GetParam());
  ASSERT_LT(least_angle(m, 1), 3.1);
  const Collapsed made = end_narrow_parts(m, .05);
  EXPECT_EQ(made.narrowed, std::vector<std::uint32_t>{1});
  EXPECT_TRUE(made.faces.empty());
  EXPECT_GT(least_angle(m, 1), 6);
}

TEST_P(EndNarrowParts, LeavesALineBetweenTheFacesBeyondTheWedge) {
  const auto joins_them = [](const CadEdge& e) {
    return std::ranges::count(e.faces, 0u) + std::ranges::count(e.faces, 2u) == 2;
  };
  CadModel m = wedge_between_squares(GetParam());
  EXPECT_TRUE(std::ranges::none_of(m.edges, joins_them));
  end_narrow_parts(m, .05);
  EXPECT_TRUE(std::ranges::any_of(m.edges, joins_them));
}

TEST_P(EndNarrowParts, LeavesWhatIsWiderAndWhatIsSpared) {
  CadModel m = wedge_between_squares(GetParam());
  EXPECT_TRUE(end_narrow_parts(m, .005).narrowed.empty());
  const std::vector<std::uint32_t> spared{1};
  EXPECT_TRUE(end_narrow_parts(m, .05, spared).narrowed.empty());
  EXPECT_EQ(m.triangles, wedge_between_squares(GetParam()).triangles);
}

// What is behind face 2 then looks down on face 0, as the two sides of a plate do.
TEST_P(EndNarrowParts, KeepsAPlateThatBeginsAsAWedge) {
  CadModel m = wedge_between_squares(GetParam());
  m.points[9] = {1, .2, .2}, m.points[10] = {0, 0, .2};
  for (VertexIndex v = 6; v < 9; ++v) m.points[v].z = m.points[v].y - 1, m.points[v].y = 1;
  EXPECT_TRUE(end_narrow_parts(m, .05).narrowed.empty());
}

}  // namespace
}  // namespace octafront::cad
