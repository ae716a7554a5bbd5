#include <octafront/validity.h>

#include "base/mesh/features.h"
#include "base/mesh/tet_key.h"
#include "base/shared/virtual_ranks.h"
#include "improve/passes/passes.h"
#include "improve/schedule/mesh_of_pieces.h"
#include "improve/start_meshes.h"

#include <algorithm>
#include <mutex>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace octafront::improve {
namespace {

using namespace octafront::testing;

constexpr auto kBalanced = ImproveOptions::Objective::kBalanced;

const auto no_notes = [](std::span<const Bytes>) {};
const auto no_progress = [](double) {};

/// Several pieces of up to kMost vertices.
const TetMesh& many_pieces() {
  static const TetMesh mesh = perturbed(kuhn_cube(14), 0.5, 1);
  return mesh;
}
constexpr std::size_t kMost = 600;

TEST(Pieces, OfOneStageShareNoVertexAndAllAreOnceInOneWithAllAround) {
  const TetMesh& start = many_pieces();
  std::vector<int> star(start.points.size(), 0), seen_inside(start.points.size(), 0), of_piece;
  for (const Tet& t : start.tets)
    for (const VertexIndex v : t) ++star[v];
  MeshOfPieces mesh(TetMesh{start}, kBalanced, nullptr, Comm(nullptr), Tets::kAll, kMost);
  std::vector<std::size_t> counts;
  std::mutex mutex;
  int pieces = 0;
  of_piece.assign(start.points.size(), -1);
  const auto look = [&](MeshPiece& piece) {
    const std::scoped_lock lock(mutex);
    ++pieces;
    EXPECT_EQ(piece.mesh->first_inconsistency(), std::nullopt);
    std::vector<int> here(piece.vertices.size(), 0);
    for (TetIndex t = 0; t < piece.mesh->slots(); ++t)
      for (const VertexIndex v : piece.mesh->tet(t)) ++here[v];
    for (VertexIndex v = 0; v < here.size(); ++v) {
      int& owner = of_piece[piece.vertices[v]];
      EXPECT_EQ(owner, -1);
      owner = pieces;
      const bool at_rim = std::ranges::binary_search(piece.at_rim, v);
      EXPECT_TRUE(here[v] == star[piece.vertices[v]] || (at_rim && piece.mesh->on_boundary(v)));
      seen_inside[piece.vertices[v]] += !at_rim;
    }
    return Bytes(1);
  };
  const auto notes = [&](std::span<const Bytes> of_pieces) {
    EXPECT_EQ(std::ranges::count(of_pieces, Bytes(1)), pieces);
    counts.push_back(static_cast<std::size_t>(std::exchange(pieces, 0)));
    of_piece.assign(start.points.size(), -1);
  };
  mesh.work(mesh.all(), 1, look, notes, no_progress);
  ASSERT_GE(counts.size(), 3u);
  EXPECT_GT(counts[0], 2u);
  EXPECT_GT(counts[1], 1u);
  EXPECT_EQ(std::ranges::count(seen_inside, 0), 0);
}

TEST(Pieces, LookedAtAloneGiveTheMeshBack) {
  const TetMesh& start = many_pieces();
  MeshOfPieces mesh(TetMesh{start}, kBalanced, nullptr, Comm(nullptr), Tets::kAll, kMost);
  mesh.work(
      mesh.all(), 0, [](MeshPiece&) { return Bytes(); }, no_notes, no_progress);
  TetMesh back = mesh.release(nullptr);
  const auto keys = [](const TetMesh& m) {
    std::vector<Tet> all;
    for (const Tet& t : m.tets) all.push_back(tet_key(t));
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_EQ(keys(back), keys(start));
  back.tets = start.tets;
  EXPECT_EQ(back, start);
}

TEST(Pieces, AreMendedAcrossTheirRims) {
  TetMesh start = many_pieces();
  for (const Tet& t : start.tets) start.region.push_back(start.points[t[0]].x > 0.4);
  MeshOfPieces mesh(TetMesh{start}, kBalanced, nullptr, Comm(nullptr), Tets::kAll, kMost);
  const auto mend = [](MeshPiece& piece) {
    insert_vertices(*piece.mesh, 0.3f, Goal::kWorst, {});
    while (reconnect(*piece.mesh, 0.3f, Goal::kWorst, {}).done != 0) {
    }
    return Bytes();
  };
  mesh.work(mesh.all(), 1, mend, no_notes, no_progress);
  EXPECT_NE(mesh.tets(), start.tets.size());
  const TetMesh made = mesh.release(nullptr);
  EXPECT_EQ(first_defect(made), std::nullopt);
  EXPECT_EQ(made.region.size(), made.tets.size());
  // What a pass over the whole finds to do is next to nothing of what it found before.
  EditMesh before{TetMesh{start}}, after{TetMesh{made}};
  EXPECT_LT(50 * reconnect(after, 0.3f, Goal::kWorst, {}).done, reconnect(before, 0.3f, Goal::kWorst, {}).done);
}

/// Two rounds of changes, the first one taken back.
TetMesh mended_by(const TetMesh& start, const BoundaryInput& input, Ranks* ranks, Tets tets) {
  const Comm comm(ranks);
  TetMesh mine = start;
  if (tets == Tets::kShare) keep_share(mine, comm);
  MeshOfPieces mesh(std::move(mine), kBalanced, &input, comm, tets, kMost);
  const auto change = [](MeshPiece& piece) {
    insert_vertices(*piece.mesh, 0.4f, Goal::kWorst, {});
    reconnect(*piece.mesh, 0.6f, Goal::kWorst, {});
    smooth_mean(*piece.mesh, 1, {});
    return Bytes(piece.vertices.size());
  };
  for (int round = 0; round < 2; ++round) {
    std::size_t noted = 0;
    mesh.work(
        mesh.all(), 1, change,
        [&](std::span<const Bytes> notes) {
          for (const Bytes& of_piece : notes) noted += of_piece.size();
        },
        no_progress);
    EXPECT_GE(noted, start.points.size());
    const Bytes of_one = mesh.work_on_one(mesh.corners_below(0.5f), 1, change);
    EXPECT_GT(of_one.size(), 0u);
    if (round == 1) break;
    mesh.rewind();
    EXPECT_EQ(mesh.tets(), start.tets.size());
  }
  TetMesh made = mesh.release(nullptr);
  if (tets == Tets::kShare) gather_tets(made, comm);
  return made;
}

TEST(Pieces, AreTheSameOfSharesOfRanks) {
  TetMesh start = perturbed(kuhn_cube(14), 0.6, 5);
  for (const Tet& t : start.tets) start.region.push_back(start.points[t[0]].x > 0.4);
  const SurfaceMesh surface{start.points, start.boundary, start.patch, {}, {}};
  const Features features = detect_features(surface, 40);
  const TriangleTree tree(surface);
  const BoundaryInput input{surface, tree, features, features};
  const TetMesh alone = mended_by(start, input, nullptr, Tets::kAll);
  EXPECT_EQ(first_defect(alone), std::nullopt);
  for (const int count : {2, 3, 5})
    run_virtual_ranks(count, [&](Ranks& ranks) {
      EXPECT_EQ(mended_by(start, input, &ranks, Tets::kShare), alone);
      EXPECT_EQ(mended_by(start, input, &ranks, Tets::kAll), alone);
    });
}

TEST(Pieces, FindThePoorAndThoseThatCross) {
  const TetMesh& start = many_pieces();
  MeshOfPieces mesh(TetMesh{start}, kBalanced, nullptr, Comm(nullptr), Tets::kAll, kMost);
  EXPECT_TRUE(mesh.corners_of_crossings().empty());
  EXPECT_TRUE(mesh.corners_below(-1).empty());
  const float threshold = 0.1f;
  std::vector<std::uint8_t> expected(start.points.size(), 0);
  for (const auto& [a, b, c, d] : start.tets)
    if (shape_of(start.points[a], start.points[b], start.points[c], start.points[d]).score < threshold)
      expected[a] = expected[b] = expected[c] = expected[d] = 1;
  EXPECT_GT(std::ranges::count(expected, 1), 0);
  EXPECT_EQ(mesh.corners_below(threshold), expected);
}

TEST(Pieces, WithAnInputCanBeTakenBack) {
  const TetMesh start = perturbed(kuhn_cube(8), 0.6, 3);
  const SurfaceMesh surface{start.points, start.boundary, start.patch, {}, {}};
  const Features features = detect_features(surface, 40);
  const TriangleTree tree(surface);
  const BoundaryInput input{surface, tree, features, features};
  MeshOfPieces mesh(TetMesh{start}, kBalanced, &input);
  EXPECT_FALSE(mesh.moved_boundary());
  const auto change = [](MeshPiece& piece) {
    reconnect(*piece.mesh, 0.6f, Goal::kWorst, {});
    insert_vertices(*piece.mesh, 0.5f, Goal::kWorst, {});
    smooth_mean(*piece.mesh, 1, {});
    return Bytes();
  };
  for (int round = 0; round < 2; ++round) {
    mesh.work(mesh.all(), 1, change, no_notes, no_progress);
    EXPECT_NE(mesh.tets(), start.tets.size());
    mesh.rewind();
    EXPECT_EQ(mesh.tets(), start.tets.size());
  }
  TetMesh back = mesh.release(nullptr);
  EXPECT_EQ(std::set(back.tets.begin(), back.tets.end()), std::set(start.tets.begin(), start.tets.end()));
  back.tets = start.tets;
  EXPECT_EQ(back, start);
}

}  // namespace
}  // namespace octafront::improve
