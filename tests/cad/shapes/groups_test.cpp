#include "../half_pipe.h"
#include "cad/shapes/face_groups.h"
#include "cad/shapes/names.h"

#include <cmath>

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

TEST(Groups, JoinNarrowFacesThatMeetSmoothly) {
  const CadModel model = half_pipe(4);
  EXPECT_EQ(group_faces(model, 3).group_of, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(group_faces(model, 0.5).group_of, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(group_faces(model, std::nullopt).names.size(), 3u);
}

/// A flat face with a wedge beside it, whose line runs into its border at so many degrees.
CadModel wedge(double degrees) {
  CadModel m;
  const double rise = 10 * std::tan(degrees * M_PI / 180);
  m.points = {{0, 0, 0}, {10, rise, 0}, {10, 0, 0}, {0, 20, 0}};
  m.triangles = {{0, 2, 1}, {0, 1, 3}}, m.face_of = {0, 1}, m.corners.resize(2);
  m.faces.resize(2);
  m.faces[0].area = 5 * rise, m.faces[1].area = 100;
  const auto line = [&](VertexIndex a, VertexIndex b, std::vector<std::uint32_t> faces) {
    CadEdge& edge = m.edges.emplace_back();
    edge.vertices = {a, b}, edge.parameters = {0, 1}, edge.faces = std::move(faces);
    edge.length = 10, edge.is_smooth = edge.faces.size() == 2;
  };
  line(0, 1, {0, 1}), line(0, 2, {0}), line(2, 1, {0}), line(1, 3, {1}), line(3, 0, {1});
  return m;
}

TEST(Groups, JoinFacesThatPartInACusp) {
  EXPECT_EQ(group_faces(wedge(10), std::nullopt).names.size(), 1u);
  EXPECT_EQ(group_faces(wedge(10), 0.1).names.size(), 1u);
  EXPECT_EQ(group_faces(wedge(30), std::nullopt).names.size(), 2u);
  EXPECT_EQ(faces_as_they_are(wedge(10)).names.size(), 2u);
  CadModel sharp = wedge(10);
  sharp.edges[0].is_smooth = false;
  EXPECT_EQ(group_faces(sharp, 0.1).names.size(), 2u);
}

TEST(Groups, DoNotReachAcrossSolids) {
  CadModel model = half_pipe(4);
  model.faces[1].sides = {kNone, 1};
  EXPECT_EQ(group_faces(model, 3).names.size(), 3u);
}

TEST(Groups, KeepNamedFacesApart) {
  CadModel model = half_pipe(4);
  model.faces[0].labels.colour = model.faces[1].labels.colour = Colour{255, 128, 0};
  const std::vector<std::string> one{face_names(model)[1]}, both{"color #ff8000"};
  EXPECT_EQ(group_faces(model, 3, one).names.size(), 3u);
  EXPECT_EQ(group_faces(model, 3, both).names.size(), 2u) << "those of one colour are meshed as one";
  model.faces[1].labels.colour.reset();
  EXPECT_EQ(group_faces(model, 3, both).names.size(), 3u);
}

TEST(Groups, LeaveOutFacesWithoutTriangles) {
  CadModel model = half_pipe(4);
  model.faces.push_back({});
  EXPECT_EQ(group_faces(model, std::nullopt).group_of.back(), kNone);
}

TEST(Groups, CountWhatIsTiny) {
  const CadModel model = half_pipe(4);
  EXPECT_EQ(tiny_things(model, 50).edges, 2u);
  EXPECT_EQ(tiny_things(model, 1).edges, 0u);
  EXPECT_EQ(tiny_things(model, 1).shortest_edge, 4);
}

using Words = std::vector<std::string>;

TEST(Names, OfFacesMayBeShared) {
  CadModel model;
  for (const char* name : {"a", "", "a", "face 2", "a"}) model.faces.emplace_back().labels.name = name;
  EXPECT_EQ(face_names(model), (Words{"a", "face 2#2", "a", "face 2", "a"}));
  model.face_of = {0, 1, 2, 3, 4}, model.triangles.resize(5);
  EXPECT_EQ(faces_as_they_are(model).names, (Words{"a", "face 2#2", "a#2", "face 2", "a#3"}))
      << "while they are meshed patches are apart";
}

/// Two solids, of one name or not, and faces between pairs of solids; kNone: outside.
CadModel with_sides(const Words& solids, const std::vector<Sides>& sides) {
  CadModel model;
  for (const std::string& name : solids) model.solids.emplace_back().labels.name = name;
  for (const Sides& s : sides) model.faces.emplace_back().sides = s;
  return model;
}

TEST(Names, OfContactsAreThoseOfTheirSolids) {
  CadModel model = with_sides({"plate", "bolt"}, {{kNone, 0}, {1, 0}, {0, 1}, {kNone, 1}, {0, 1}});
  EXPECT_EQ(face_names(model), (Words{"face 1", "plate|bolt", "plate|bolt#2", "face 4", "plate|bolt#3"}));
  model.faces[1].piece = model.faces[4].piece = 1;
  EXPECT_EQ(face_names(model), (Words{"face 1", "plate|bolt", "plate|bolt#2", "face 4", "plate|bolt"}));
  EXPECT_EQ(faces_between(model, "bolt|plate"), (std::vector<std::uint32_t>{1, 2, 4}));
  EXPECT_TRUE(faces_between(model, "bolt").empty());
}

TEST(Names, OfPiecesAreNoneOfOtherContacts) {
  const CadModel model = with_sides({"plate", "bolt", "bolt"}, {{0, 1}, {0, 1}, {0, 2}, {0, 2}});
  EXPECT_EQ(face_names(model), (Words{"plate|bolt", "plate|bolt#3", "plate|bolt#2", "plate|bolt#2#2"}));
}

TEST(Names, AtSeveralSolidsAreFollowedByThem) {
  CadModel model = with_sides({"nut", "bolt"}, {{kNone, 0}, {kNone, 1}, {kNone, 1}, {0, 1}});
  for (Face& face : model.faces) face.labels.name = "end";
  model.faces[2].labels.name = "head";
  EXPECT_EQ(face_names(model), (Words{"end (nut)", "end (bolt)", "head", "end (nut|bolt)"}));
  const std::vector<LabelGroup> groups = label_groups(model);
  ASSERT_EQ(groups.size(), 1U) << "a contact whose faces have names of their own";
  EXPECT_EQ(groups[0].name, "nut|bolt");
  EXPECT_EQ(groups[0].faces, std::vector<std::uint32_t>{3});
}

TEST(Names, ColoursAndLayersAreGroups) {
  CadModel model;
  model.faces.resize(3), model.solids.resize(2);
  model.faces[0].labels.colour = model.faces[2].labels.colour = model.solids[1].labels.colour = Colour{0, 10, 255};
  model.faces[2].labels.layer = "outside";
  const std::vector<LabelGroup> groups = label_groups(model);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].name, "color #000aff");
  EXPECT_EQ(groups[0].faces, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(groups[1].name, "layer outside");
  EXPECT_EQ(groups[1].faces, std::vector<std::uint32_t>{2});
  EXPECT_EQ(groups[2].name, "solids of color #000aff");
  EXPECT_EQ(groups[2].solids, std::vector<std::uint32_t>{1});
  EXPECT_TRUE(groups[2].faces.empty());
}

}  // namespace
}  // namespace octafront::cad
