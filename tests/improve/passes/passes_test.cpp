#include "improve/passes/passes.h"

#include <octafront/no_context.h>

#include "base/core/thread_limit.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "improve/passes/explain.h"
#include "improve/passes/fewest_poor.h"
#include "improve/passes/poor_tets.h"
#include "improve/passes/vertex_stars.h"
#include "improve/shape/input_force.h"
#include "improve/start_meshes.h"
#include "support/complexes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include <gtest/gtest.h>

namespace octafront::improve {
namespace {

using namespace octafront::testing;

std::vector<Vec3> boundary_corners(const TetMesh& mesh) {
  std::vector<Vec3> corners;
  for (const Triangle& t : mesh.boundary)
    for (const VertexIndex v : t) corners.push_back(mesh.points[v]);
  return corners;
}

void expect_laws(const TetMesh& before, const TetMesh& after) {
  for (const Tet& t : after.tets)
    ASSERT_EQ(orient3d(after.points[t[0]], after.points[t[1]], after.points[t[2]], after.points[t[3]]), 1);
  EXPECT_NO_THROW(EditMesh(TetMesh{after}));  // faces match each other and the boundary
  EXPECT_NEAR(volume(after), volume(before), 1e-12 * volume(before));
  EXPECT_EQ(boundary_corners(before), boundary_corners(after));
  EXPECT_EQ(before.patch, after.patch);
  EXPECT_EQ(before.source, after.source);
}

double worst_beta(const TetMesh& mesh) {
  double worst = 2;
  for (const Tet& t : mesh.tets)
    worst =
        std::min(worst, tet_radius_ratio(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]));
  return worst;
}

TEST(EditMesh, GivesBackWhatItTook) {
  const TetMesh mesh = perturbed(kuhn_cube(4), 0.3, 1);
  TetMesh back = EditMesh(TetMesh{mesh}).release();
  EXPECT_EQ(std::set(back.tets.begin(), back.tets.end()), std::set(mesh.tets.begin(), mesh.tets.end()));
  back.tets = mesh.tets;  // only their order may differ
  EXPECT_EQ(back, mesh);
}

TEST(EditMesh, TellsWhatBecameOfIt) {
  TetMesh start = perturbed(kuhn_cube(8), 0.6, 2);
  for (const Tet& t : start.tets) start.region.push_back(start.points[t[0]].x > 0.4);
  EditMesh mesh{TetMesh{start}};
  mesh.remember();
  EXPECT_GT(reconnect(mesh, 0.6f, Goal::kWorst, {}).done, 10u);
  EXPECT_GT(smooth_mean(mesh, 1, {}).done, 10u);
  EXPECT_GT(insert_vertices(mesh, 0.5f, Goal::kFewestPoor, {}).done, 0u);
  const EditMesh::Change change = mesh.change();
  // What was there, with all that is told, is what it gives back, but for vertices without elements.
  TetMesh changed = start;
  for (const auto& [v, at] : change.moved) changed.points[v] = at;
  changed.points.insert(changed.points.end(), change.added.begin(), change.added.end());
  changed.tets.clear(), changed.region.clear();
  for (TetIndex t = 0; t < start.tets.size(); ++t) {
    if (std::ranges::find(change.gone, t) != change.gone.end()) continue;
    changed.tets.push_back(start.tets[t]);
    changed.region.push_back(start.region[t]);
  }
  changed.tets.insert(changed.tets.end(), change.made.begin(), change.made.end());
  changed.region.insert(changed.region.end(), change.region_of_made.begin(), change.region_of_made.end());
  const auto in_places = [](const TetMesh& m) {
    std::set<std::pair<std::array<std::array<double, 3>, 4>, std::uint32_t>> all;
    for (TetIndex t = 0; t < m.tets.size(); ++t) {
      std::array<std::array<double, 3>, 4> corners;
      for (int i = 0; i < 4; ++i)
        corners[i] = {m.points[m.tets[t][i]].x, m.points[m.tets[t][i]].y, m.points[m.tets[t][i]].z};
      all.insert({corners, m.region[t]});
    }
    return all;
  };
  EXPECT_EQ(in_places(mesh.release()) == in_places(changed), true);
  EXPECT_GT(change.added.size(), 0u);
  EXPECT_TRUE(change.boundary.empty());
}

TEST(EditMesh, RefusesFacesThatDoNotMatch) {
  TetMesh mesh = kuhn_cube(2);
  mesh.tets.pop_back();
  EXPECT_ANY_THROW(EditMesh(std::move(mesh)));
}

TEST(EditMesh, FindsShapesThatAreNotTrue) {
  EditMesh mesh(perturbed(kuhn_cube(3), 0.2, 1));
  EXPECT_EQ(mesh.first_inconsistency(), std::nullopt);
  mesh.move(0, mesh.point(0) + Vec3{1e-3, 1e-3, 1e-3}, {}, ShapeBatch());  // and no shape set
  EXPECT_NE(mesh.first_inconsistency(), std::nullopt);
}

TEST(EditMesh, FindsStarsAndRings) {
  EditMesh mesh(kuhn_cube(2));
  MeshEditor editor(mesh);
  std::vector<HalfFace> star;
  for (VertexIndex v = 0; v < mesh.vertices(); ++v)
    if (!mesh.on_boundary(v)) {
      editor.star(v, star);
      EXPECT_EQ(star.size(), 24u);
    }
  EdgeRing ring;
  for (TetIndex t = 0; t < mesh.slots(); ++t)
    for (const auto& [i, j] : kTetEdges) {
      editor.edge_ring(t, i, j, ring);
      ASSERT_EQ(ring.ring.size(), ring.tets.size() + (ring.closed ? 0 : 1));
      const VertexIndex a = mesh.tet(t)[i], b = mesh.tet(t)[j];
      for (std::size_t k = 0; k < ring.tets.size(); ++k)
        ASSERT_EQ(orient3d(mesh.point(a), mesh.point(b), mesh.point(ring.ring[k]),
                           mesh.point(ring.ring[(k + 1) % ring.ring.size()])),
                  1);
    }
}

TEST(VertexStars, AreOfTheInnerVerticesOfElementsThatNeedWork) {
  EditMesh mesh(perturbed(kuhn_cube(6), 0.3, 5));
  const float limit = 0.5f;
  const auto needs_work = [&](const Shape& s) { return s.beta < limit; };
  const VertexStars stars(mesh, nullptr, needs_work);
  MeshEditor editor(mesh);
  std::size_t left_out = 0;
  for (VertexIndex v = 0; v < mesh.vertices(); ++v) {
    if (mesh.on_boundary(v)) continue;
    std::vector<HalfFace> star;
    editor.star(v, star);
    const bool wanted = std::ranges::any_of(star, [&](HalfFace h) { return needs_work(mesh.shape(h / 4)); });
    ASSERT_EQ(std::ranges::count(stars.vertices(), v), wanted ? 1 : 0);
    left_out += !wanted;
    std::sort(star.begin(), star.end());
    ASSERT_TRUE(!wanted || std::ranges::equal(stars.star(v), star));
  }
  EXPECT_GT(left_out, 0u);
  EXPECT_FALSE(stars.vertices().empty());
}

TEST(Passes, LeaveNothingUndoneThatTheyCanDo) {
  const TetMesh start = perturbed(kuhn_cube(12), 0.45, 9);
  EditMesh edit{TetMesh{start}};
  while (reconnect(edit, 0.5f, Goal::kWorst, {}).done != 0) {
  }
  EXPECT_EQ(reconnect(edit, 0.5f, Goal::kWorst, {}).done, 0u);
  EXPECT_GT(optimize_vertices(edit, 0.5f, {}).done, 0u);
  insert_vertices(edit, 0.5f, Goal::kWorst, {});
  expect_laws(start, edit.release());
}

TEST(Shape, AgreesWithTheMeasuresOfTheLibrary) {
  const TetMesh mesh = perturbed(kuhn_cube(3), 0.5, 3);
  const EditMesh edit{TetMesh{mesh}};
  for (TetIndex t = 0; t < edit.slots(); ++t) {
    const Tet& c = edit.tet(t);
    const Vec3 a = edit.point(c[0]), b = edit.point(c[1]), p = edit.point(c[2]), q = edit.point(c[3]);
    const auto cosines = dihedral_cosines(a, b, p, q);
    EXPECT_NEAR(edit.shape(t).beta, tet_radius_ratio(a, b, p, q), 1e-6);
    EXPECT_NEAR(edit.shape(t).small, 1 - *std::max_element(cosines.begin(), cosines.end()), 1e-6);
    EXPECT_NEAR(edit.shape(t).large, 1 + *std::min_element(cosines.begin(), cosines.end()), 1e-6);
    const Shape alone = shape_of(a, b, p, q);
    EXPECT_EQ(edit.shape(t).beta, alone.beta);
    EXPECT_EQ(edit.shape(t).small, alone.small);
    EXPECT_EQ(edit.shape(t).large, alone.large);
  }
}

TEST(Reconnect, RemovesTheEdgeOfARing) {
  for (int ring = 3; ring <= kLongestRing; ++ring) {
    SCOPED_TRACE(ring);
    const TetMesh before = edge_ring_mesh(ring, 0.9);
    EditMesh edit{TetMesh{before}};
    const float worst = edit.floor().score;
    const PassResult result = reconnect(edit, 1.0f, Goal::kWorst, {});
    const float better = edit.floor().score;
    const TetMesh after = edit.release();
    expect_laws(before, after);
    EXPECT_GT(better, worst);
    EXPECT_EQ(result.done, 1u);
    EXPECT_EQ(after.tets.size(), 2u * (ring - 2));
  }
}

TEST(Reconnect, FlipsTheFaceBetweenTwoFlatTetrahedra) {
  TetMesh before;
  before.points = {{2, 0, 0}, {-1, 1.8, 0}, {-1, -1.8, 0}, {0, 0, 0.6}, {0, 0, -0.6}};
  before.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  before = with_boundary(std::move(before));
  EditMesh edit{TetMesh{before}};
  EXPECT_EQ(reconnect(edit, 1.0f, Goal::kWorst, {}).done, 1u);
  const TetMesh after = edit.release();
  EXPECT_EQ(after.tets.size(), 3u);
  EXPECT_GT(worst_beta(after), worst_beta(before));
  expect_laws(before, after);
}

TEST(Laplacian, RestoresAPerturbedGrid) {
  const TetMesh before = perturbed(kuhn_cube(6), 0.45, 5);
  EditMesh edit{TetMesh{before}};
  laplacian_sweeps(edit, 30, 1, MoveRule::kMeanRises, {});
  const TetMesh after = edit.release();
  expect_laws(before, after);
  EXPECT_GT(worst_beta(after), 0.5);  // the grid itself has .717
}

TEST(Insert, PutsAVertexWhereNoReconnectionHelps) {
  const TetMesh before = edge_ring_mesh(kLongestRing + 3, 0.95);
  EditMesh edit{TetMesh{before}};
  const float worst = edit.floor().score;
  EXPECT_GT(insert_vertices(edit, 1.0f, Goal::kWorst, {}).done, 0u);
  EXPECT_GT(edit.floor().score, worst);
  const TetMesh after = edit.release();
  EXPECT_GT(after.points.size(), before.points.size());
  expect_laws(before, after);
}

double lack(const EditMesh& mesh) {
  double sum = 0;
  for (TetIndex t = 0; t < mesh.slots(); ++t)
    if (mesh.alive(t)) sum += lack_of(mesh.shape(t).score);
  return sum;
}

TEST(FewestPoor, LackIsNothingForGoodElementsAndRisesAsTheyGetWorse) {
  EXPECT_EQ(lack_of(kComfort), 0);
  EXPECT_EQ(lack_of(1), 0);
  double before = 0;
  for (double score = 0.39; score > -0.5; score -= 0.01) {
    EXPECT_GT(lack_of(score), before);
    before = lack_of(score);
  }
}

TEST(FewestPoor, DescentLeadsOutOfInvertedElements) {
  // The star of a regular octahedron's middle, begun outside of it.
  const Vec3 corners[6]{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  ShapeBatch star;
  star.size = 0;
  for (int i = 0; i < 4; ++i) {
    star.add(corners[(i + 1) % 4], corners[i], corners[4]);
    star.add(corners[i], corners[(i + 1) % 4], corners[5]);
  }
  star.evaluate_star({0, 0, 0});
  if (star.worst() <= 0)
    for (int i = 0; i < star.size; ++i)
      for (int axis = 0; axis < 3; ++axis) std::swap(star.corner[1][axis][i], star.corner[2][axis][i]);
  star.evaluate_star({0, 0, 0});
  ASSERT_GT(star.worst(), 0.4);
  LackDescent descent;
  descent.descend(star, {1.1, 0.3, 0.2}, 30, [](Vec3) { return true; });
  EXPECT_TRUE(descent.moved());
  star.evaluate_star(descent.place());
  EXPECT_GT(star.worst(), 0.2);
}

TEST(FewestPoor, EveryPassLowersTheSumThatElementsLack) {
  const TetMesh start = perturbed(kuhn_cube(6), 0.49, 11);
  EditMesh edit{TetMesh{start}};
  double before = lack(edit);
  const auto expect_less = [&](const PassResult& result) {
    const double now = lack(edit);
    EXPECT_EQ(result.done > 0, now < before);
    EXPECT_LE(now, before);
    before = now;
    return result.done;
  };
  std::uint64_t moved = 0, turned = 0;
  for (int round = 0; round < 2; ++round) {
    turned += expect_less(reconnect(edit, 0.4f, Goal::kFewestPoor, {}));
    expect_less(collapse_vertices(edit, 0.4f, Goal::kFewestPoor, {}));
    expect_less(insert_vertices(edit, 0.4f, Goal::kFewestPoor, {}));
    moved += expect_less(relieve_vertices(edit, 0.4f, {}));
  }
  EXPECT_GT(moved, 0u);
  EXPECT_GT(turned, 0u);
  expect_laws(start, edit.release());
}

Shortfall shortfall_of(TetMesh mesh) {
  EditMesh edit(std::move(mesh));
  return explain_shortfall(edit, 0.4f, nullptr, no_context());
}

TEST(Explain, NamesWhatTheBoundaryForces) {
  TetMesh wedge;  // two faces at five degrees
  wedge.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 1, 0.0875}};
  wedge.tets = {{0, 1, 2, 3}};
  const Shortfall angle = shortfall_of(with_boundary(wedge));
  EXPECT_EQ(angle.elements, 1u);
  EXPECT_EQ(angle.by_cause[Shortfall::kWedge].elements, 1u);

  TetMesh needle;  // upright on a needle of a triangle
  needle.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.02, 0}, {0.5, 0.01, 0.8}};
  needle.tets = {{0, 1, 2, 3}};
  const Shortfall triangle = shortfall_of(with_boundary(needle));
  EXPECT_EQ(triangle.elements, 1u);
  EXPECT_EQ(triangle.by_cause[Shortfall::kNotForced].elements, 0u);

  EXPECT_EQ(shortfall_of(kuhn_cube(2)).elements, 0u);
}

/// What lies around curves of a complex: two boxes upon each other, and curves far from their walls.
class ForceOfCurves {
 public:
  ForceOfCurves(const std::vector<Vec3>& points, const std::vector<Edge>& edges, std::vector<VertexIndex> corners)
      : surface_(stacked_layers({10, 10}).surface), features_{{}, std::move(corners)} {
    for (Vec3& p : surface_.points) p = p * 10 - Vec3{5, 5, 50};
    const auto first = static_cast<VertexIndex>(surface_.points.size());
    surface_.points.insert(surface_.points.end(), points.begin(), points.end());
    for (const auto& [a, b] : edges) features_.edges.push_back({first + a, first + b});
    for (VertexIndex& v : features_.corners) v += first;
    tree_.emplace(surface_);
  }
  InputForce::Cause at(Vec3 center, double h) const {
    return InputForce(BoundaryInput{surface_, *tree_, features_, features_}).cause_at(center, h);
  }

 private:
  SurfaceMesh surface_;
  Features features_;
  std::optional<TriangleTree> tree_;
};

TEST(InputForce, CurvesOfAComplexThatRunSideBySide) {
  const ForceOfCurves beside({{0, 0, 0}, {2, 0, 0}, {0, 0.02, 0}, {2, 0.02, 0}}, {{0, 1}, {2, 3}}, {0, 1, 2, 3});
  EXPECT_EQ(beside.at({1, 0.01, 0}, 0.3), InputForce::Cause::kThin);
  EXPECT_EQ(beside.at({1, 0.01, 0}, 0.1), InputForce::Cause::kNone);  // small enough to fit between them
  // At three degrees from one corner, far behind it: 20 degrees would let them part by .18 within the element.
  const ForceOfCurves wedge({{0, 0, 0}, {2, 0, 0}, {2, 0.1, 0}}, {{0, 1}, {0, 2}}, {0, 1, 2});
  EXPECT_EQ(wedge.at({1.3, 0.03, 0}, 0.5), InputForce::Cause::kCorner);
  EXPECT_EQ(wedge.at({1.3, 0.03, 0}, 0.1), InputForce::Cause::kNone);
  const ForceOfCurves straight({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1}, {1, 2}}, {0, 1, 2});
  EXPECT_EQ(straight.at({1, 0.03, 0}, 0.5), InputForce::Cause::kNone);
}

double deficit(const EditMesh& mesh) {
  double sum = 0;
  for (TetIndex t = 0; t < mesh.slots(); ++t)
    if (mesh.alive(t)) sum += (1 - mesh.shape(t).beta) * (1 - mesh.shape(t).beta);
  return sum;
}

TEST(Mean, EveryPassForItLowersTheSumOfSquaredDeficits) {
  const TetMesh start = perturbed(kuhn_cube(6), 0.45, 5);
  EditMesh edit{TetMesh{start}};
  double before = deficit(edit);
  for (int sweep = 0; sweep < 3; ++sweep) {
    EXPECT_GT(smooth_mean(edit, 1, {}).done, 0u);
    EXPECT_LT(deficit(edit), before);
    before = deficit(edit);
    EXPECT_GT(reconnect(edit, 0.9f, Goal::kMean, {}).done, 0u);
    EXPECT_LT(deficit(edit), before);
    before = deficit(edit);
  }
  expect_laws(start, edit.release());
}

TEST(Passes, LeaveAValidMeshWhoseWorstIsNoWorse) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const TetMesh start = perturbed(kuhn_cube(3 + seed % 4), 0.25 + 0.1 * (seed % 9), seed);
    EditMesh edit{TetMesh{start}};
    const auto run = [&](auto&& pass) {
      const Floor before = edit.floor();
      pass();
      const Floor after = edit.floor();
      EXPECT_GE(after.beta, before.beta);
      EXPECT_GE(after.small, before.small);
      EXPECT_GE(after.large, before.large);
    };
    for (int round = 0; round < 3; ++round) {
      run([&] { laplacian_sweeps(edit, 1, 0.7, round % 2 ? MoveRule::kMeanRises : MoveRule::kWorstRises, {}); });
      run([&] { reconnect(edit, 0.6f, Goal::kWorst, {}); });
      run([&] { smooth_mean(edit, 1, {}); });
      run([&] { reconnect(edit, 0.9f, Goal::kMean, {}); });
      run([&] { collapse_vertices(edit, 0.7f, Goal::kMean, {}); });
      run([&] { optimize_vertices(edit, 0.6f, {}); });
      run([&] { insert_vertices(edit, 0.4f, Goal::kWorst, {}); });
    }
    const TetMesh after = edit.release();
    expect_laws(start, after);
    EXPECT_GE(worst_beta(after), worst_beta(start));
  }
}

TEST(Collapse, RemovesAVertexThatStandsTooClose) {
  TetMesh start = kuhn_cube(3);
  const Tet split = start.tets[80];
  const auto v = static_cast<VertexIndex>(start.points.size());
  const Vec3 p = start.points[split[0]];
  Vec3 middle;
  for (const VertexIndex corner : split) middle += start.points[corner] * 0.25;
  start.points.push_back(p + 0.05 * (middle - p));
  start.tets[80] = {v, split[1], split[2], split[3]};
  for (int i = 1; i < 4; ++i) {
    Tet t = split;
    t[i] = v;
    start.tets.push_back(t);
  }
  EditMesh edit{TetMesh{start}};
  EXPECT_EQ(collapse_vertices(edit, 0.4f, Goal::kMean, {}).done, 1u);
  const TetMesh after = edit.release();
  expect_laws(start, after);
  EXPECT_EQ(after.points.size(), start.points.size() - 1);
  EXPECT_EQ(after.tets.size(), kuhn_cube(3).tets.size());
}

TEST(Optimize, RaisesTheWorstAroundABadVertex) {
  TetMesh start = kuhn_cube(2);
  start.points[13] = {0.85, 0.7, 0.55};
  EditMesh edit{TetMesh{start}};
  const float before = edit.floor().score;
  EXPECT_EQ(optimize_vertices(edit, 1.0f, {}).done, 1u);
  EXPECT_GT(edit.floor().score, before + 0.2f);
  expect_laws(start, edit.release());
}

/// Three faces between the tips of two pyramids over a pentagon: only all at once do they give way to the edge between
/// the tips.
TEST(SmallPolyhedra, RemoveSeveralFacesAtOnce) {
  std::vector<Vec3> p{{0, 0, -0.6}, {0, 0, 0.6}};
  for (int k = 0; k < 5; ++k)
    p.push_back({std::cos(2 * std::numbers::pi * k / 5), std::sin(2 * std::numbers::pi * k / 5), 0});
  TetMesh mesh;
  mesh.points = p;
  mesh.tets = {{2, 3, 4, 1}, {2, 4, 5, 1}, {2, 5, 6, 1}, {2, 4, 3, 0}, {2, 5, 4, 0}, {2, 6, 5, 0}};
  mesh = with_boundary(std::move(mesh));
  EditMesh edit(TetMesh{mesh});
  const PassResult result = reconnect_small_polyhedra(edit, 0.6f, {});
  EXPECT_EQ(result.done, 1u);
  const TetMesh after = edit.release();
  expect_laws(mesh, after);
  ASSERT_EQ(after.tets.size(), 5u);
  for (const Tet& t : after.tets) EXPECT_TRUE(std::count(t.begin(), t.end(), 0u) && std::count(t.begin(), t.end(), 1u));
}

TEST(SmallPolyhedra, KeepTheLawsAndRaiseTheWorst) {
  std::uint64_t done = 0;
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const TetMesh mesh = perturbed(kuhn_cube(6), 0.45, seed);
    EditMesh edit(TetMesh{mesh});
    done += reconnect_small_polyhedra(edit, 0.5f, {}).done;
    const TetMesh after = edit.release();
    expect_laws(mesh, after);
    EXPECT_GE(worst_beta(after), worst_beta(mesh));
  }
  EXPECT_GT(done, 10u);
}

}  // namespace
/// Two prisms of a wall, side by side, and between them the element on the edge 0 1 and the edge 2 3 right behind it.
/// The diagonals of each prism run around: with one turned it has no elements.
TetMesh wall_with_flat_element(double thickness) {
  TetMesh mesh;
  mesh.points = {{0, 0, thickness}, {1, 0, thickness},    {0, 0, 0},   {1, 1e-20, 0}, {0.5, 1, thickness},
                 {0.5, 1, 0},       {0.5, -1, thickness}, {0.5, -1, 0}};
  mesh.tets = {{0, 1, 2, 3}, {0, 3, 1, 4}, {0, 3, 4, 5}, {0, 3, 5, 2}, {1, 2, 0, 6}, {1, 2, 6, 7}, {1, 2, 7, 3}};
  for (Tet& t : mesh.tets)
    if (orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) < 0) std::swap(t[2], t[3]);
  return with_boundary(std::move(mesh));
}

TEST(OpenFlatElements, AVertexGoesBesideWhatSpansAnEdgeAndTheOneBehind) {
  for (const double thickness : {1e-1, 1e-3, 1e-6}) {
    const TetMesh before = wall_with_flat_element(thickness);
    EditMesh mesh(TetMesh{before});
    EXPECT_EQ(reconnect(mesh, 1, Goal::kWorst, {}).done, 0u);
    EXPECT_EQ(open_flat_elements(mesh, {}).done, 1u);
    const TetMesh after = mesh.release();
    expect_laws(before, after);
    for (const Tet& t : after.tets)
      EXPECT_GT(signed_volume(after.points[t[0]], after.points[t[1]], after.points[t[2]], after.points[t[3]]),
                0.01 * volume(after))
          << thickness;
    EditMesh again(TetMesh{after});
    EXPECT_EQ(open_flat_elements(again, {}).done, 0u);
  }
}

}  // namespace octafront::improve
