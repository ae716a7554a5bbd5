// Parts that meet in opened contacts, or come apart, end to end.

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/named_groups.h>
#include <octafront/validity.h>

#include "support/labelled_walls.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box_walls;
using testing::even_planes;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// The unit cube in three layers.
Domain three_layers() {
  SurfaceMesh walls = box_walls({even_planes(5), even_planes(5), {0, 0.2, 0.5, 1}}, [](Vec3 c) {
    return c.z < 0.2 ? 0u : c.z < 0.5 ? 1u : 2u;
  });
  walls.region_names = {"low", "middle", "top"};
  return walls;
}

Domain with(ContactWay all, std::vector<ContactChoice::Rule> rules = {}) {
  Domain domain = three_layers();
  domain.contacts = {all, std::move(rules)};
  return domain;
}

Options layers_of_size(double size) {
  Options options;
  options.size.size = size;
  return options;
}

std::vector<std::array<std::string, 2>> names_of_contacts(const TetMesh& mesh) {
  std::vector<std::array<std::string, 2>> names;
  for (const OpenedContact& c : mesh.opened_contacts)
    names.push_back({mesh.patch_names.at(c.first), mesh.patch_names.at(c.second)});
  return names;
}

double volume_of_region(const TetMesh& mesh, std::uint32_t region) {
  double volume = 0;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const Vec3 p = mesh.points[a];
    if (mesh.region[t] == region) volume += dot(cross(mesh.points[b] - p, mesh.points[c] - p), mesh.points[d] - p) / 6;
  }
  return volume;
}

void expect_volumes(const TetMesh& mesh) {
  EXPECT_EQ(first_defect(mesh), std::nullopt);
  EXPECT_NEAR(volume_of_region(mesh, 0), 0.2, 1e-9);
  EXPECT_NEAR(volume_of_region(mesh, 1), 0.3, 1e-9);
  EXPECT_NEAR(volume_of_region(mesh, 2), 0.5, 1e-9);
}

TEST(Contacts, SplitOpensAllOrThoseThatAreNamed) {
  const Result all = generate(with(ContactWay::kSplit), layers_of_size(0.25));
  expect_volumes(all.mesh);
  using Pairs = std::vector<std::array<std::string, 2>>;
  EXPECT_THAT(names_of_contacts(all.mesh),
              ::testing::UnorderedElementsAre(std::array<std::string, 2>{"low|middle", "middle|low"},
                                              std::array<std::string, 2>{"middle|top", "top|middle"}));
  EXPECT_TRUE(all.mesh.interfaces.empty());
  ASSERT_EQ(all.report.contacts.size(), 2U);
  EXPECT_EQ(all.report.contacts[0].triangles[0], all.report.contacts[0].triangles[1]);
  EXPECT_NEAR(all.report.contacts[0].areas[0], 1, 1e-9);
  const Result one = generate(with(ContactWay::kShared, {{"top|middle", ContactWay::kSplit}}), layers_of_size(0.25));
  EXPECT_EQ(names_of_contacts(one.mesh), (Pairs{{"middle|top", "top|middle"}}));
  EXPECT_FALSE(one.mesh.interfaces.empty());
  const Result but_one = generate(with(ContactWay::kSplit, {{"low", ContactWay::kShared}}), layers_of_size(0.25));
  EXPECT_EQ(but_one.mesh, one.mesh);
}

TEST(Contacts, SeparatePartsHaveTheirOwnSizes) {
  Options options = layers_of_size(0.5);
  options.size.named = {{"top", 0.1}};
  const Result made = generate(with(ContactWay::kShared, {{"middle|top", ContactWay::kSeparate}}), options);
  expect_volumes(made.mesh);
  EXPECT_EQ(made.mesh.region_names, (std::vector<std::string>{"low", "middle", "top"}));
  ASSERT_EQ(made.report.contacts.size(), 1U);
  const ContactSummary& contact = made.report.contacts[0];
  EXPECT_EQ(contact.patches, (std::array<std::string, 2>{"middle|top", "top|middle"}));
  EXPECT_FALSE(contact.conforming);
  EXPECT_GT(contact.triangles[1], 5 * contact.triangles[0]);
  EXPECT_NEAR(contact.areas[0], 1, 1e-9);
  EXPECT_NEAR(contact.areas[1], 1, 1e-9);
  EXPECT_FALSE(made.mesh.interfaces.empty()) << "what low and middle share";
  ASSERT_EQ(made.report.regions.size(), 3U);
  EXPECT_EQ(made.report.regions[2].name, "top");
  EXPECT_NEAR(made.report.regions[2].volume, 0.5, 1e-9);
  EXPECT_NEAR(made.report.volume, 1, 1e-9);
}

TEST(Contacts, ThePartsOfASeparateMeshAreThoseThatAreMeshedAlone) {
  const Result apart = generate(with(ContactWay::kSeparate), layers_of_size(0.25));
  expect_volumes(apart.mesh);
  const SurfaceMesh low = box_walls({even_planes(5), even_planes(5), {0, 0.2}}, [](Vec3) { return 0u; });
  const Result alone = generate(low, layers_of_size(0.25));
  EXPECT_EQ(std::ranges::count(apart.mesh.region, 0U), std::ssize(alone.mesh.tets));
}

TEST(Contacts, WhatOtherContactsHoldTogetherIsOpenedInPlace) {
  Domain cells = box_walls({even_planes(5), even_planes(5), even_planes(5)},
                           [](Vec3 c) { return c.x < 0.5 ? (c.y < 0.5 ? 0u : 1u) : 2u; });
  cells.surface.region_names = {"a", "b", "c"};
  cells.contacts = {ContactWay::kShared, {{"a|b", ContactWay::kSeparate}}};
  const Result made = generate(cells, layers_of_size(0.25));
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  ASSERT_EQ(made.mesh.opened_contacts.size(), 1U);
  EXPECT_EQ(made.mesh.opened_contacts[0].conforming, 1U);
}

TEST(Contacts, SetsAreOfTheWhole) {
  Options options = layers_of_size(0.25);
  options.groups = {"low half=elements:box:-1,-1,-1,2,2,0.51", "faces of top=patches:top|middle"};
  const TetMesh mesh = generate(with(ContactWay::kSeparate), options).mesh;
  ASSERT_EQ(mesh.sets.size(), 2U);
  EXPECT_EQ(std::ssize(mesh.sets[0].members),
            std::ranges::count_if(mesh.region, [](std::uint32_t r) { return r < 2; }));
}

TEST(Contacts, WhatIsAskedAtPlacesGoesToThePartsThatHaveThem) {
  Options options = layers_of_size(0.25);
  options.layers.count = 2;
  options.layers.on = "low|middle";
  options.layers.in = "low";
  options.layers.first = 0.01;
  options.size.named = {{"box:0,0,0.9,1,1,1", 0.1}};
  const Result made = generate(with(ContactWay::kSeparate), options);
  EXPECT_EQ(first_defect(made.mesh), std::nullopt);
  EXPECT_NEAR(made.report.volume, 1, 1e-9);
  ASSERT_EQ(made.report.layers.size(), 1U);
  EXPECT_EQ(made.report.layers[0].full, 1);
  for (const StageReport& stage : made.report.stages)
    for (const std::string& note : stage.notes) EXPECT_EQ(note.find("outside of the model"), note.npos) << note;
}

TEST(Contacts, WhatCannotBeIsRefusedBeforeAnythingIsMade) {
  const auto refused = [](const Domain& domain, const Options& options, const std::string& words) {
    EXPECT_THAT([&] { generate(domain, options); }, ThrowsMessage<OptionError>(HasSubstr(words)));
  };
  refused(with(ContactWay::kShared, {{"low|top", ContactWay::kSplit}}), {},
          "there is no contact \"low|top\"; there are contacts \"low|middle\", \"middle|top\"");
  Options options = layers_of_size(0.5);
  options.size.named = {{"nosuch", 0.1}};
  refused(with(ContactWay::kSeparate), options, "nosuch");
  options = layers_of_size(0.5);
  options.periodic = "x";
  refused(with(ContactWay::kSeparate), options, "`periodic`");
  EXPECT_THROW(generate_surface(with(ContactWay::kSplit), layers_of_size(0.5)), OptionError);
}

}  // namespace
}  // namespace octafront
