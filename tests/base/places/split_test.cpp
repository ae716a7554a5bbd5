#include <octafront/error.h>
#include <octafront/split.h>
#include <octafront/validity.h>

#include "support/rich_mesh.h"

#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

constexpr int kSize = 4;

/// The rich mesh, with the wall inside for a part of its rows only, and a second wall across it.
TetMesh with_walls(const std::vector<std::array<double, 4>>& walls) {
  TetMesh mesh = testing::rich_mesh(kSize);
  mesh.region.clear();
  mesh.region_names = {"body"};
  mesh.interfaces.clear();
  mesh.interface_patch.clear();
  mesh.sets.clear();
  std::set<Triangle> seen;
  for (std::uint32_t w = 0; w < walls.size(); ++w) {
    // No structured binding: Clang 14 cannot capture them.
    const auto& wall = walls[w];
    const double at = wall[1], lo = wall[2], hi = wall[3];
    const int a = static_cast<int>(wall[0]), other = (a + 1) % 3;
    for (const Tet& t : mesh.tets)
      for (const auto& f : kTetFaces) {
        const Triangle face{t[static_cast<std::size_t>(f[0])], t[static_cast<std::size_t>(f[1])],
                            t[static_cast<std::size_t>(f[2])]};
        const bool on = std::all_of(face.begin(), face.end(), [&](VertexIndex v) {
          const Vec3 p = mesh.points[v];
          return p[a] == at && p[other] >= lo && p[other] <= hi;
        });
        Triangle key = face;
        std::sort(key.begin(), key.end());
        if (!on || !seen.insert(key).second) continue;
        mesh.interfaces.push_back(face);
        mesh.interface_patch.push_back(static_cast<std::uint32_t>(mesh.patch_names.size()));
      }
    mesh.patch_names.push_back("wall_" + std::to_string(w + 1));
  }
  return mesh;
}

std::size_t faces_of(const TetMesh& mesh, const std::string& patch) {
  const auto at = std::find(mesh.patch_names.begin(), mesh.patch_names.end(), patch) - mesh.patch_names.begin();
  return static_cast<std::size_t>(std::count(mesh.patch.begin(), mesh.patch.end(), static_cast<std::uint32_t>(at)));
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.tets) {
    const auto& p = mesh.points;
    sum += dot(cross(p[b] - p[a], p[c] - p[a]), p[d] - p[a]) / 6;
  }
  return sum;
}

TEST(Split, AWallThroughDoublesAllItsNodes) {
  TetMesh mesh = with_walls({{0, 2, 0, 4}});
  const std::size_t before = mesh.points.size();
  split_patches(mesh, {"wall_1"});
  EXPECT_EQ(mesh.points.size(), before + 25);
  EXPECT_EQ(faces_of(mesh, "wall_1_plus"), 32U);
  EXPECT_EQ(faces_of(mesh, "wall_1_minus"), 32U);
  EXPECT_TRUE(mesh.interfaces.empty());
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_NEAR(volume(mesh), 64, 1e-9);
}

TEST(Split, TheTipOfACrackStaysOneNode) {
  TetMesh mesh = with_walls({{0, 2, 1, 3}});  // 1 <= y <= 3, through in z
  const std::size_t before = mesh.points.size();
  split_patches(mesh, {"wall_1"});
  EXPECT_EQ(mesh.points.size(), before + 5);  // y = 2
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Split, WhereWallsCrossThereAreFourNodes) {
  TetMesh mesh = with_walls({{0, 2, 0, 4}, {1, 2, 0, 4}});
  const std::size_t before = mesh.points.size();
  split_patches(mesh, {"wall_1", "wall_2"});
  EXPECT_EQ(mesh.points.size(), before + 2 * 20 + 3 * 5);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Split, OneOfTwoThatCrossOpensAlone) {
  TetMesh mesh = with_walls({{0, 2, 0, 4}, {1, 2, 0, 4}});
  const std::size_t before = mesh.points.size(), faces = mesh.interfaces.size();
  split_patches(mesh, {"wall_1"});
  EXPECT_EQ(mesh.points.size(), before + 25);
  EXPECT_EQ(mesh.interfaces.size(), faces - 32);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Split, PairsLieOnEachOtherAndFaceEachOther) {
  TetMesh mesh = with_walls({{0, 2, 0, 2}});
  split_patches(mesh, {"wall_1"});
  ASSERT_EQ(mesh.split_faces.size(), 16U);
  std::size_t tips = 0;
  for (const SplitFace& f : mesh.split_faces)
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(mesh.points[f.nodes[i]], mesh.points[f.nodes[3 + i]]);
      tips += f.nodes[i] == f.nodes[3 + i];
    }
  EXPECT_GT(tips, 0U);
}

TEST(Split, MidSideNodesAreDoubledToo) {
  TetMesh mesh = testing::with_mid_nodes(with_walls({{0, 2, 1, 3}}));
  const std::size_t before = mesh.points.size();
  split_patches(mesh, {"wall_1"});
  // Of the strip of 2 by 4 squares: the line in the middle with 4 edges, and the edges that lead to it from the tips,
  // 2 x 5 straight ones and 2 x 4 diagonals.
  EXPECT_EQ(mesh.points.size(), before + 5 + 4 + 10 + 8);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

TEST(Split, SetsAndCurvesHaveTheCopies) {
  TetMesh mesh = with_walls({{0, 2, 0, 4}});
  NamedSet nodes{"wall", NamedSet::Kind::kNodes, {}};
  for (VertexIndex v = 0; v < mesh.points.size(); ++v)
    if (mesh.points[v].x == 2) nodes.members.push_back(v);
  mesh.sets = {nodes, {"inside", NamedSet::Kind::kFaces, {static_cast<std::uint32_t>(mesh.boundary.size())}}};
  mesh.curve_edges.clear();
  mesh.curve.clear();
  for (const Triangle& t : mesh.interfaces)
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge{t[i], t[(i + 1) % 3]};
      if (mesh.points[edge[0]].y == 0 && mesh.points[edge[1]].y == 0) mesh.curve_edges.push_back(edge);
    }
  const std::size_t edges = mesh.curve_edges.size();
  ASSERT_GT(edges, 0U);
  split_patches(mesh, {"wall_1"});
  ASSERT_EQ(mesh.sets.size(), 2U);
  EXPECT_EQ(mesh.sets[0].members.size(), 50U);
  EXPECT_EQ(mesh.sets[1].members.size(), 2U);
  EXPECT_EQ(mesh.curve_edges.size(), 2 * edges);
  EXPECT_EQ(first_defect(mesh), std::nullopt);
}

/// The rich mesh: left and right, which meet in a wall that has this name.
TetMesh two_parts(const std::string& contact) {
  TetMesh mesh = testing::rich_mesh(kSize);
  mesh.region_names = {"left", "right"};
  mesh.patch_names.resize(6);
  mesh.patch_names.push_back(contact);
  return mesh;
}

std::set<VertexIndex> nodes_of(const TetMesh& mesh, std::uint32_t region) {
  std::set<VertexIndex> nodes;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.region[t] != region) continue;
    nodes.insert(mesh.tets[t].begin(), mesh.tets[t].end());
    if (mesh.is_second_order()) nodes.insert(mesh.mid_nodes[t].begin(), mesh.mid_nodes[t].end());
  }
  return nodes;
}

TEST(Split, PartsComeApartAtAContactAndSharedNoNode) {
  for (const bool second_order : {false, true}) {
    TetMesh mesh = two_parts("left|right");
    if (second_order) mesh = testing::with_mid_nodes(mesh);
    const TetMesh before = mesh;
    split_contacts(mesh, contacts_of(mesh));
    EXPECT_EQ(first_defect(mesh), std::nullopt);
    EXPECT_EQ(mesh.tets.size(), before.tets.size());
    EXPECT_NEAR(volume(mesh), 64, 1e-9);
    const std::set<VertexIndex> left = nodes_of(mesh, 0), right = nodes_of(mesh, 1);
    EXPECT_EQ(left.size() + right.size(), mesh.points.size());
    EXPECT_TRUE(std::ranges::none_of(left, [&](VertexIndex v) { return right.contains(v); }));
  }
}

TEST(Split, BothSidesOfAContactAreCalledByTheirParts) {
  TetMesh mesh = two_parts("left|right#2");
  split_contacts(mesh, contacts_of(mesh));
  ASSERT_EQ(mesh.opened_contacts.size(), 1U);
  const auto [first, second, conforming] = mesh.opened_contacts[0];
  EXPECT_EQ(mesh.patch_names.at(first), "left|right#2");
  EXPECT_EQ(first, 6U);
  EXPECT_EQ(mesh.patch_names.at(second), "right|left#2");
  EXPECT_EQ(conforming, 1U);
  EXPECT_EQ(faces_of(mesh, "left|right#2"), 32U);
  EXPECT_EQ(faces_of(mesh, "right|left#2"), 32U);
  const std::set<VertexIndex> left = nodes_of(mesh, 0);
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f)
    if (mesh.patch[f] == first || mesh.patch[f] == second) {
      EXPECT_EQ(left.contains(mesh.boundary[f][0]), mesh.patch[f] == first);
    }
}

TEST(Split, AContactWithANameKeepsIt) {
  TetMesh mesh = two_parts("seat");
  split_contacts(mesh, contacts_of(mesh));
  EXPECT_EQ(faces_of(mesh, "seat (left|right)"), 32U);
  EXPECT_EQ(faces_of(mesh, "seat (right|left)"), 32U);
}

TEST(Split, TheSidesOfAContactFaceEachOther) {
  TetMesh mesh = two_parts("right|left");  // the other way round than regions have their numbers
  split_contacts(mesh, contacts_of(mesh));
  ASSERT_EQ(mesh.split_faces.size(), 32U);
  for (const SplitFace& f : mesh.split_faces)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(mesh.points[f.nodes[i]], mesh.points[f.nodes[3 + i]]);
  EXPECT_EQ(mesh.patch_names.at(6), "right|left");
}

TEST(Split, WhatWasSplitBeforeKeepsItsPairs) {
  TetMesh mesh = with_walls({{0, 2, 0, 4}, {1, 2, 0, 4}});
  split_patches(mesh, {"wall_1"});
  split_patches(mesh, {"wall_2"});
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  std::set<Triangle> boundary;
  for (Triangle f : mesh.boundary) std::ranges::sort(f), boundary.insert(f);
  ASSERT_EQ(mesh.split_faces.size(), 64U);
  for (const SplitFace& f : mesh.split_faces)
    for (const std::size_t first : {0, 3}) {
      Triangle side{f.nodes[first], f.nodes[first + 1], f.nodes[first + 2]};
      std::ranges::sort(side);
      EXPECT_TRUE(boundary.contains(side));
    }
}

TEST(Split, NamesOfOtherSides) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(other_sides("fault_plus"), Names{"fault_minus"});
  EXPECT_EQ(other_sides("left|right"), Names{"right|left"});
  EXPECT_EQ(other_sides("left|right#2"), (Names{"right#2|left", "right|left#2"}));
  EXPECT_EQ(other_sides("seat (left|right)"), Names{"seat (right|left)"});
  EXPECT_EQ(other_sides("wall"), Names());
}

TEST(Split, WhatIsNotInsideIsRefusedBeforeAnyChange) {
  TetMesh mesh = with_walls({{0, 2, 0, 4}});
  const TetMesh before = mesh;
  EXPECT_THROW(split_patches(mesh, {"wall_1", "lid"}), OptionError);
  EXPECT_EQ(mesh, before);
}

}  // namespace
}  // namespace octafront
