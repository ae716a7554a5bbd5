#include "base/mesh/labels.h"

#include <octafront/validity.h>

#include "support/mixed_mesh.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Kind = NamedSet::Kind;

std::vector<std::uint32_t> first_numbers(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

Origins all_items(const TetMesh& mesh) {
  return {first_numbers(mesh.points.size()), first_numbers(mesh.curve_edges.size()),
          first_numbers(mesh.count(Kind::kFaces)), first_numbers(mesh.tets.size())};
}

/// A mesh with all that a mesh may have.
std::vector<TetMesh> rich_meshes() {
  TetMesh mesh = testing::rich_mesh(4), mixed = testing::mixed_mesh(3);
  mesh.source.assign(mesh.boundary.size(), 7);
  mesh.source[3] = kNone;
  mesh.face_layers.assign(mesh.count(Kind::kFaces), 2);
  mesh.periods = {{4, 0, 0}};
  mesh.periodic_nodes = {{0, 120, 20}, {0, 124, 24}};
  mesh.split_faces = {{{0, 1, 5, 25, 26, 30}, 1}};
  mesh.opened_contacts = {{0, 1, 0}};
  return {mesh, mixed};
}

TEST(Labels, TheWholeIsAPartOfItself) {
  for (const TetMesh& mesh : rich_meshes()) {
    std::vector<VertexIndex> here(mesh.points.size(), kNone);
    EXPECT_EQ(part_of(mesh, all_items(mesh), here), mesh);
    EXPECT_EQ(here, std::vector<VertexIndex>(mesh.points.size(), kNone));
  }
}

TEST(Labels, GoAlongInAnyOrder) {
  for (const TetMesh& mesh : rich_meshes()) {
    if (!mesh.wide_cells.empty()) continue;  // their elements stand side by side
    Origins back = all_items(mesh);
    std::ranges::reverse(back.nodes), std::ranges::reverse(back.edges), std::ranges::reverse(back.tets);
    const auto outer = back.faces.begin() + static_cast<std::ptrdiff_t>(mesh.boundary.size());
    std::reverse(back.faces.begin(), outer), std::reverse(outer, back.faces.end());
    std::vector<VertexIndex> here(mesh.points.size(), kNone);
    const TetMesh turned = part_of(mesh, back, here);
    EXPECT_NE(turned.tets, mesh.tets);
    EXPECT_EQ(first_defect(turned), std::nullopt);
    for (const NamedSet& set : turned.sets) EXPECT_TRUE(std::ranges::is_sorted(set.members)) << set.name;
    EXPECT_EQ(part_of(turned, back, here), mesh);
  }
}

TEST(Labels, WhatComesOfAMemberIsAMember) {
  TetMesh before;
  before.tets.resize(3);
  before.region = {5, 6, 7};
  before.sets = {{"s", Kind::kElements, {0, 2}}, {"n", Kind::kNodes, {4}}};
  TetMesh mesh = before;
  inherit(mesh, before, Kind::kElements, std::vector<std::uint32_t>{2, 0, 1, 0, kNone});
  EXPECT_EQ(mesh.region, (std::vector<std::uint32_t>{7, 5, 6, 5, 0}));
  EXPECT_EQ(mesh.sets[0].members, (std::vector<std::uint32_t>{0, 1, 3}));
  EXPECT_EQ(mesh.sets[1].members, before.sets[1].members);
}

TEST(Labels, ItemsOfOneNumberHaveTheSamePartAndSets) {
  TetMesh mesh;
  mesh.tets.resize(6);
  mesh.region = {3, 3, 0, 3, 0, 0};
  mesh.sets = {{"a", Kind::kElements, {1, 2, 3}}, {"b", Kind::kElements, {3, 4}}, {"c", Kind::kNodes, {0}}};
  const Labels labels = labels_of(mesh, Kind::kElements);
  EXPECT_EQ(labels.of, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  mesh.sets.pop_back();
  mesh.sets.pop_back();
  EXPECT_EQ(labels_of(mesh, Kind::kElements).of, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 3}));
  EXPECT_EQ(labels_of(mesh, Kind::kElements).like, (std::vector<std::uint32_t>{0, 1, 2, 4}));
}

TEST(Labels, NodesStayWhereTheirSetEnds) {
  TetMesh mesh = testing::rich_mesh(4);  // 5 x 5 x 5 nodes
  mesh.sets = {{"all", Kind::kNodes, first_numbers(mesh.points.size())}};
  EXPECT_TRUE(nodes_that_stay(mesh).empty());
  const auto probe = static_cast<VertexIndex>(mesh.points.size() / 2);
  mesh.sets.push_back({"probe", Kind::kNodes, {probe}});
  EXPECT_EQ(nodes_that_stay(mesh), std::vector<VertexIndex>{probe});
  // On a wall only what else is on walls counts.
  NamedSet side{"side", Kind::kNodes, {}};
  for (VertexIndex v = 0; v < mesh.points.size(); ++v)
    if (mesh.points[v].x == 0) side.members.push_back(v);
  mesh.sets = {side};
  std::vector<VertexIndex> rim;
  for (const VertexIndex v : side.members) {
    const Vec3 p = mesh.points[v];
    if (p.y == 0 || p.y == 4 || p.z == 0 || p.z == 4) rim.push_back(v);
  }
  EXPECT_EQ(nodes_that_stay(mesh), rim);
}

}  // namespace
}  // namespace octafront
