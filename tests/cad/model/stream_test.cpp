#include "cad/model/stream.h"

#include <octafront/error.h>

#include "../half_pipe.h"

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

TEST(Stream, BringsAModelBackAsItWas) {
  CadModel model = half_pipe(2);
  model.notes = {"one", "two"};
  model.faces[1].labels.colour = Colour{1, 2, 3};
  model.faces[2].piece = 1;
  model.solids.resize(2);
  model.solids[1].product = "pipe", model.solids[1].material = "steel";
  model.shared = {{{0, 1}, 2, 0.5}};
  const std::string bytes = to_bytes(model);
  const CadModel back = model_of(bytes);
  EXPECT_EQ(back.points, model.points);
  EXPECT_EQ(back.triangles, model.triangles);
  EXPECT_EQ(back.corners, model.corners);
  EXPECT_EQ(back.notes, model.notes);
  EXPECT_EQ(back.faces[1].labels.colour, model.faces[1].labels.colour);
  EXPECT_EQ(back.edges[0].vertices, model.edges[0].vertices);
  EXPECT_EQ(back.faces[2].piece, 1U);
  EXPECT_EQ(back.solids[1].product, "pipe");
  EXPECT_EQ(back.solids[1].material, "steel");
  EXPECT_EQ(back.shared[0].depth, 0.5);
  EXPECT_EQ(to_bytes(back), bytes);
}

TEST(Stream, RefusesWhatIsCutOffAnywhere) {
  const std::string bytes = to_bytes(half_pipe(2));
  for (std::size_t n = 0; n < bytes.size(); n += 7)
    EXPECT_THROW(model_of(std::string_view(bytes).substr(0, n)), InputError);
  EXPECT_THROW(model_of(bytes + "x"), InputError);
}

TEST(Stream, RefusesNumbersThatDoNotFitTogether) {
  CadModel model = half_pipe(2);
  model.face_of.back() = 17;
  EXPECT_THROW(model_of(to_bytes(model)), InputError);
  model = half_pipe(2);
  model.faces[0].piece = 3;
  EXPECT_THROW(model_of(to_bytes(model)), InputError);
  model = half_pipe(2);
  model.edges[0].parameters.pop_back();
  EXPECT_THROW(model_of(to_bytes(model)), InputError);
}

TEST(Stream, KnowsItsFrames) {
  const std::string head = frame_head(FrameKind::kModel, 12345);
  ASSERT_EQ(head.size(), kFrameHead);
  EXPECT_EQ(head_of(head)->kind, FrameKind::kModel);
  EXPECT_EQ(head_of(head)->length, 12345u);
  EXPECT_FALSE(head_of("?23456789"));
}

}  // namespace
}  // namespace octafront::cad
