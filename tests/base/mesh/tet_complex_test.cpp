#include "base/mesh/tet_complex.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

// Three positive tets around the edge (0, 1).
const std::vector<Tet> kThree{{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 2}};

TetComplex three_around_an_edge() {
  TetComplex complex;
  complex.tets = kThree;
  std::vector<Triangle> boundary;
  for (const Tet& t : kThree) {
    boundary.push_back(face_of(t, 0));
    boundary.push_back(face_of(t, 1));
  }
  complex.connect(5, boundary);
  return complex;
}

void expect_found(const TetComplex& broken, const std::string& fragment) {
  const auto wrong = broken.first_inconsistency();
  ASSERT_TRUE(wrong);
  EXPECT_NE(wrong->find(fragment), std::string::npos) << *wrong;
}

TEST(TetComplex, ConnectsNeighboursAndBoundary) {
  const TetComplex complex = three_around_an_edge();
  EXPECT_EQ(complex.first_inconsistency(), std::nullopt);
  int outside = 0;
  for (const HalfFace o : complex.across) outside += is_outside(o);
  EXPECT_EQ(outside, 6);
  EXPECT_EQ(complex.across[0], kFirstOutside);
  EXPECT_EQ(complex.across[5], kFirstOutside + 3);
}

TEST(TetComplex, TurnsAroundEdges) {
  const TetComplex complex = three_around_an_edge();
  EdgeRing ring;
  EXPECT_TRUE(complex.closed_ring(0, 0, 1, ring));
  EXPECT_EQ(ring.tets, (std::vector<TetIndex>{0, 1, 2}));
  EXPECT_EQ(ring.ring, (std::vector<VertexIndex>{2, 3, 4}));
  EXPECT_FALSE(complex.closed_ring(0, 0, 1, ring, 2));
  EXPECT_FALSE(complex.closed_ring(0, 2, 3, ring));
  EXPECT_FALSE(ring.closed);
}

TEST(TetComplex, ReplacesTetsByOthersInTheirPlace) {
  TetComplex complex = three_around_an_edge();
  const std::vector<HalfFace> before = complex.across;
  complex.replace(std::vector<TetIndex>{0, 1, 2}, std::vector<Tet>{{2, 3, 4, 1}, {2, 4, 3, 0}});
  EXPECT_EQ(complex.first_inconsistency(), std::nullopt);
  EXPECT_EQ(complex.free.size(), 1u);
  complex.replace(std::vector<TetIndex>(complex.created()), kThree);
  EXPECT_EQ(complex.first_inconsistency(), std::nullopt);
  EXPECT_EQ(complex.across.size(), before.size());
  complex = three_around_an_edge();
  EXPECT_THROW(complex.replace(std::vector<TetIndex>{0}, std::vector<Tet>{{0, 1, 2, 4}}), std::logic_error);
}

TEST(TetComplex, FindsWhatIsBroken) {
  TetComplex broken = three_around_an_edge();
  broken.across[2] = broken.across[3];
  expect_found(broken, "does not know its neighbour");
  broken = three_around_an_edge();
  std::swap(broken.tets[1][2], broken.tets[1][3]);
  expect_found(broken, "not one face seen from both sides");
  broken = three_around_an_edge();
  broken.tet_at[4] = 0;
  expect_found(broken, "vertex 4");
  broken = three_around_an_edge();
  broken.free.push_back(1);
  expect_found(broken, "slot free");
  broken = three_around_an_edge();
  broken.destroy(2);
  expect_found(broken, "gone");
  EXPECT_NE(broken.first_inconsistency(std::array<TetIndex, 1>{1}), std::nullopt);
}

}  // namespace
}  // namespace octafront
