#include "base/mesh/adjacency.h"

#include "base/core/index_range.h"
#include "base/mesh/tet_meshes.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

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
    const Triangle mine = corners_of(mesh.tets, h), other = corners_of(mesh.tets, across[h]);
    EXPECT_NE(is_even(mine), is_even(other));
    EXPECT_EQ(face_key(mine), face_key(other));
  }
  EXPECT_EQ(outer, 6u * 9 * 2);
  EXPECT_EQ(mesh.boundary.size(), outer);
}

TEST(HalfFaceNeighbors, AreNoneOnFacesOfThreeTets) {
  const std::vector<Tet> tets{{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 1, 5}};
  for (const HalfFace h : half_face_neighbors(tets, 6)) EXPECT_EQ(h, kNone);
}

}  // namespace
}  // namespace octafront
