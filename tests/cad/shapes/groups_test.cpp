#include "cad/shapes/groups.h"

#include "../half_pipe.h"
#include "cad/shapes/names.h"

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

TEST(Groups, JoinNarrowFacesThatMeetSmoothly) {
  const CadModel model = half_pipe(4);
  EXPECT_EQ(group_faces(model, 3).group_of, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(group_faces(model, 0.5).group_of, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(group_faces(model, std::nullopt).names.size(), 3u);
}

TEST(Groups, DoNotReachAcrossSolids) {
  CadModel model = half_pipe(4);
  model.faces[1].sides = {kNone, 1};
  EXPECT_EQ(group_faces(model, 3).names.size(), 3u);
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

TEST(Names, AreAllDifferent) {
  CadModel model;
  for (const char* name : {"a", "", "a", "face 2", "a"}) model.faces.emplace_back().labels.name = name;
  EXPECT_EQ(face_names(model), (std::vector<std::string>{"a", "face 2#2", "a#2", "face 2", "a#3"}));
}

}  // namespace
}  // namespace octafront::cad
