#include "cad/shapes/cad_places.h"

#include "../half_pipe.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// With the other edges of the lid: lines at its ends.
CadModel pipe() {
  CadModel model = half_pipe(4);
  const auto line = [&](VertexIndex a, VertexIndex b, double length) {
    CadEdge edge;
    edge.curve.kind = CurveRecord::Kind::kLine;
    edge.vertices = {a, b}, edge.parameters = {0, length}, edge.faces = {2}, edge.length = length;
    model.edges.push_back(edge);
  };
  line(0, 5, 2), line(6, 11, 2), line(5, 11, 4);
  model.solids.resize(1);
  model.solids[0].labels.name = "pipe";
  for (Face& face : model.faces) face.sides = {kNone, 0};
  return model;
}

TEST(CadPlaces, AreNamesBeforeWhatTheyAreLike) {
  CadModel model = pipe();
  model.faces[0].labels.layer = "rough";
  const CadPlaces places(model);
  EXPECT_EQ(places.faces("left"), Numbers{1});
  EXPECT_EQ(places.faces("layer rough"), Numbers{0});
  EXPECT_EQ(places.faces("face 2"), Numbers{1}) << "whatever it is called";
  EXPECT_EQ(places.faces("face 4"), Numbers{});
  model.faces[2].labels.name = "cylinders";
  EXPECT_EQ(CadPlaces(model).faces("cylinders"), Numbers{2});
}

TEST(CadPlaces, FindFacesByWhatTheyAreLike) {
  const CadModel model = pipe();
  const CadPlaces places(model);
  EXPECT_EQ(places.faces("faces"), (Numbers{0, 1, 2}));
  EXPECT_EQ(places.faces("cylinders"), (Numbers{0, 1}));
  EXPECT_EQ(places.faces("cylinders of radius 1"), (Numbers{0, 1}));
  EXPECT_EQ(places.faces("cylinders of radius 1.01"), Numbers{});
  EXPECT_EQ(CadPlaces(model, 25.4).faces("cylinders of radius .03937"), (Numbers{0, 1})) << "in inches";
  EXPECT_EQ(places.faces("plane"), Numbers{2});
  EXPECT_EQ(places.faces("spheres"), Numbers{});
  EXPECT_EQ(places.faces("largest face"), Numbers{2}) << "2 x 4 beside quarters of a cylinder";
  EXPECT_EQ(places.faces("smallest face"), (Numbers{0, 1})) << "equals are all of them";
  EXPECT_EQ(places.faces("cylinders at x min"), Numbers{1});
  EXPECT_EQ(places.faces("faces of left"), Numbers{1});
  EXPECT_EQ(places.faces("planes of pipe"), Numbers{2});
  EXPECT_EQ(places.faces("planes of nothing"), Numbers{});
}

TEST(CadPlaces, FindEdgesAndPoints) {
  const CadModel model = pipe();
  const CadPlaces places(model, 2);
  const auto lines = [&](const char* place) {
    Numbers numbers;
    for (const FoundLine& line : places.find(place).lines) numbers.push_back(line.number);
    return numbers;
  };
  EXPECT_EQ(lines("edges"), (Numbers{0, 1, 2, 3, 4}));
  EXPECT_EQ(lines("circles"), Numbers{});
  EXPECT_EQ(lines("longest lines"), Numbers{});
  EXPECT_EQ(lines("smallest line"), (Numbers{2, 3}));
  EXPECT_EQ(lines("lines at z max"), Numbers{3});
  EXPECT_EQ(lines("lines of left"), Numbers{0});
  const FoundShapes ends = places.find("lines at x max");
  ASSERT_EQ(ends.lines.size(), 1U);
  EXPECT_EQ(ends.lines[0].points, (std::vector<Vec3>{{1.5, 0, 0}, {1.5, 0, 2}}));
  EXPECT_TRUE(ends.parts.empty() && ends.points.empty());
  EXPECT_EQ(places.find("points at z min").points, (std::vector<Vec3>{{0.5, 0, 0}, {1.5, 0, 0}}))
      << "where edges meet, not where one ends";
}

TEST(CadPlaces, LeaveOutWhatBelongsToNoSolid) {
  CadModel model = pipe();
  model.faces[2].sides = {kNone, kNone};
  EXPECT_EQ(CadPlaces(model).faces("planes"), Numbers{});
}

}  // namespace
}  // namespace octafront::cad
