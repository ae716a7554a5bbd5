#include "mesh/adjacency.h"

#include "mesh/index_range.h"
#include "mesh/tet_meshes.h"

#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

TEST(FaceKey, SortsAndKnowsTheParity) {
  Triangle t{4, 7, 9};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(FaceKey(t), FaceKey({4, 7, 9}));
    EXPECT_TRUE(FaceKey(t).even);
    EXPECT_FALSE(FaceKey({t[1], t[0], t[2]}).even);
    t = {t[1], t[2], t[0]};
  }
}

TEST(IndexRange, TellsWhatDoesNotFit) {
  EXPECT_NO_THROW(require_in_range(kMostVertices, kMostVertices, "vertices"));
  try {
    require_in_range((std::uint64_t{1} << 32) + 5, kMostVertices, "vertices");
    FAIL();
  } catch (const MeshingError& e) {
    EXPECT_NE(std::string(e.what()).find("4294967301 vertices"), std::string::npos) << e.what();
  }
}

TEST(IndexRange, HalfFacesOfTooManyTetsAreRefusedBeforeAnyIsTouched) {
  // A span that claims more than it has: whoever looks at an element, crashes.
  const Tet tet{0, 1, 2, 3};
  const std::span<const Tet> many(&tet, kMostTetsWithHalfFaces + 1);
  EXPECT_THROW(half_face_neighbors(many, 4), MeshingError);
}

TEST(HalfFaceNeighbors, LieOnTheSameFaceFromTheOtherSide) {
  const TetMesh mesh = testing::tet_cube(3);
  const auto across = half_face_neighbors(mesh.tets, mesh.points.size());
  std::size_t outer = 0;
  for (HalfFace h = 0; h < across.size(); ++h) {
    if (across[h] == kNone) {
      ++outer;
      continue;
    }
    EXPECT_EQ(across[across[h]], h);
    FaceKey mine(corners_of(mesh.tets, h)), other(corners_of(mesh.tets, across[h]));
    EXPECT_NE(mine.even, other.even);
    other.even = mine.even;
    EXPECT_EQ(mine, other);
  }
  EXPECT_EQ(outer, 6u * 9 * 2);
  EXPECT_EQ(mesh.boundary.size(), outer);
}

TEST(HalfFaceNeighbors, AreNoneOnFacesOfThreeTets) {
  const std::vector<Tet> tets{{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 1, 5}};
  for (const HalfFace h : half_face_neighbors(tets, 6)) EXPECT_EQ(h, kNone);
}

RC_GTEST_PROP(FaceTable, HoldsEachHalfFaceOnceAndGroupsByVertices, ()) {
  // Any tets, meaningful or not.
  const auto any_vertex = [] { return *rc::gen::inRange<VertexIndex>(0, 9); };
  std::vector<Tet> tets(*rc::gen::inRange<std::size_t>(0, 30));
  for (Tet& t : tets)
    for (VertexIndex& v : t) v = any_vertex();
  std::set<HalfFace> seen;
  std::set<std::array<VertexIndex, 3>> faces;
  FaceTable(tets, 9).for_each_face([&](VertexIndex low, std::span<const FaceTable::Entry> on_face) {
    RC_ASSERT(faces.insert({low, on_face[0].middle, on_face[0].high}).second);
    HalfFace last = 0;
    for (const auto& entry : on_face) {
      const FaceKey key(corners_of(tets, entry.half_face));
      RC_ASSERT(key.low == low && key.middle == on_face[0].middle && key.high == on_face[0].high);
      RC_ASSERT(seen.insert(entry.half_face).second);
      RC_ASSERT(last <= entry.half_face);
      last = entry.half_face;
    }
  });
  RC_ASSERT(seen.size() == 4 * tets.size());
}

}  // namespace
}  // namespace octafront
