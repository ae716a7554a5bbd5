#include "base/mesh/face_table.h"

#include "base/mesh/adjacency.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace octafront {
namespace {

TEST(FaceKey, SortsAndTheParityTellsTheSides) {
  Triangle t{4, 7, 9};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(face_key(t), (Triangle{4, 7, 9}));
    EXPECT_EQ(face_key({t[1], t[0], t[2]}), (Triangle{4, 7, 9}));
    EXPECT_TRUE(is_even(t));
    EXPECT_FALSE(is_even({t[1], t[0], t[2]}));
    t = {t[1], t[2], t[0]};
  }
}

RC_GTEST_PROP(FaceTable, HoldsEachFaceOnceAndGroupsByVertices, ()) {
  // Any tets, meaningful or not.
  std::vector<Tet> tets(*rc::gen::inRange<std::size_t>(0, 30));
  for (Tet& t : tets)
    for (VertexIndex& v : t) v = *rc::gen::inRange<VertexIndex>(0, 9);
  const FaceTable table = half_face_table(tets, 9);
  std::set<HalfFace> seen;
  Triangle last_key{};
  table.for_each_group([&](const Triangle& key, std::span<const FaceTable::Entry> on_face) {
    RC_ASSERT(seen.empty() || last_key < key);
    last_key = key;
    HalfFace last = 0;
    for (const auto& entry : on_face) {
      RC_ASSERT(face_key(corners_of(tets, entry.face)) == key);
      RC_ASSERT(seen.insert(entry.face).second);
      RC_ASSERT(last <= entry.face);
      last = entry.face;
    }
    const auto found = table.group_of({key[2], key[0], key[1]});
    RC_ASSERT(found.data() == on_face.data() && found.size() == on_face.size());
  });
  RC_ASSERT(seen.size() == 4 * tets.size());
}

TEST(FaceTable, KnowsWhichFacesAreNotInAList) {
  const std::vector<Triangle> faces{{0, 1, 2}, {1, 2, 3}, {2, 1, 0}};
  const FaceTable table = face_table(4, faces);
  EXPECT_EQ(table.group_of({1, 0, 2}).size(), 2u);
  EXPECT_EQ(table.group_of({3, 2, 1})[0].face, 1u);
  EXPECT_TRUE(table.group_of({0, 1, 3}).empty());
}

}  // namespace
}  // namespace octafront
