#include "cad/shapes/collapse.h"

#include "cad/shapes/groups.h"

#include <algorithm>

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
  const std::vector<std::uint32_t> spared = faces_named(m, named);
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

}  // namespace
}  // namespace octafront::cad
