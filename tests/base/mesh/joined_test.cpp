#include "base/mesh/joined.h"

#include <octafront/validity.h>

#include "support/rich_mesh.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TetMesh moved(TetMesh mesh, double along) {
  for (Vec3& p : mesh.points) p.x += along;
  return mesh;
}

TEST(JoinedMeshes, HaveAllOfTheirParts) {
  for (const bool second_order : {false, true}) {
    TetMesh first = testing::rich_mesh(4);
    first.face_layers.assign(first.count(NamedSet::Kind::kFaces), 2);
    first.opened_contacts = {{0, 1, 1}};
    first.patch_names.resize(7);
    for (std::size_t p = 0; p < 7; ++p) first.patch_names[p] = "patch " + std::to_string(p);
    first.region_names = {"left", "right"};
    if (second_order) first = testing::with_mid_nodes(first);
    TetMesh other = moved(first, 10);
    std::swap(other.patch_names[0], other.patch_names[6]);
    const TetMesh all = joined_meshes({first, other}, {});
    EXPECT_EQ(first_defect(all), std::nullopt);
    EXPECT_EQ(all.tets.size(), 2 * first.tets.size());
    EXPECT_EQ(all.region_names, first.region_names);
    EXPECT_EQ(std::ranges::count(all.region, 1U), 2 * std::ranges::count(first.region, 1U));
    EXPECT_EQ(all.opened_contacts.size(), 2U);
    const auto faces_called = [](const TetMesh& mesh, const std::string& name) {
      const auto number = std::ranges::find(mesh.patch_names, name) - mesh.patch_names.begin();
      return std::ranges::count(mesh.patch, number) + std::ranges::count(mesh.interface_patch, number);
    };
    for (const std::string& name : first.patch_names)
      EXPECT_EQ(faces_called(all, name), faces_called(first, name) + faces_called(other, name)) << name;
    ASSERT_EQ(all.sets.size(), first.sets.size());
    for (const NamedSet& set : all.sets) {
      const auto of_first =
          std::ranges::find_if(first.sets, [&](const NamedSet& s) { return s.name == set.name && s.kind == set.kind; });
      EXPECT_EQ(set.members.size(), 2 * of_first->members.size()) << set.name;
      EXPECT_LT(set.members.back(), all.count(set.kind));
      EXPECT_EQ(std::ranges::adjacent_find(set.members, std::ranges::greater_equal()), set.members.end());
    }
  }
}

TEST(JoinedMeshes, FacesInsideComeBehindAllOfTheBoundary) {
  const TetMesh first = testing::rich_mesh(4);
  const TetMesh all = joined_meshes({first, moved(first, 10)}, {});
  TetMesh inside = first;
  inside.sets = {{"wall", NamedSet::Kind::kFaces, {static_cast<std::uint32_t>(first.boundary.size())}}};
  const TetMesh marked = joined_meshes({first, moved(inside, 10)}, {});
  const auto set = std::ranges::find(marked.sets, std::string("wall"), &NamedSet::name);
  ASSERT_NE(set, marked.sets.end());
  EXPECT_EQ(set->members[0], all.boundary.size() + first.interfaces.size());
}

}  // namespace
}  // namespace octafront
