// Named parts of a surface whose true geometry is known.

#include <octafront/domain.h>
#include <octafront/generate.h>
#include <octafront/io.h>
#include <octafront/mend.h>

#include "base/geometry/true_geometry.h"
#include "support/named_surfaces.h"
#include "support/parts_by_patch.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// One patch of two halves, and a part between them that is too narrow for any face.
class Halves final : public TrueGeometry {
 public:
  explicit Halves(double from, double to) : from_(from), to_(to) {}
  std::optional<Vec3> on_face(std::uint32_t, Vec3) const override { return std::nullopt; }
  std::optional<Vec3> on_edge(std::span<const std::uint32_t>, Vec3) const override { return std::nullopt; }
  bool is_vertex(Vec3) const override { return true; }
  const std::vector<std::string>& patch_names() const override { return patches_; }
  std::uint32_t part_at(std::uint32_t, Vec3 p) const override { return p.z < from_ ? 0 : p.z < to_ ? 1 : 2; }
  const std::vector<std::string>& part_names() const override { return parts_; }
  std::uint32_t patch_of_part(std::uint32_t) const override { return 0; }
  const std::vector<PartGroup>& groups() const override { return groups_; }

 private:
  double from_, to_;
  std::vector<std::string> patches_{"all"}, parts_{"below", "strip", "above"};
  std::vector<PartGroup> groups_;
};

Result cube_of(double from, double to) {
  Domain domain{testing::cube(1)};
  domain.surface.patch_names = {"all"};
  domain.geometry = std::make_shared<const Halves>(from, to);
  Options options;
  options.size.size = 0.2;
  return generate(domain, options);
}

std::vector<std::string> notes_on(const Result& made, const std::string& name) {
  std::vector<std::string> found;
  for (const StageReport& stage : made.report.stages)
    for (const std::string& note : stage.notes)
      if (note.find(name) != std::string::npos) found.push_back(note);
  return found;
}

bool has_group(const Result& made, const std::string& name) {
  const std::vector<GroupInfo> groups = groups_of(made.mesh);
  return std::any_of(groups.begin(), groups.end(), [&](const GroupInfo& g) { return g.name == name; });
}

TEST(TrueParts, OneWithoutFacesIsNamedInANote) {
  const Result made = cube_of(0.5, 0.5 + 1e-9);
  EXPECT_TRUE(has_group(made, "below") && has_group(made, "above"));
  EXPECT_FALSE(has_group(made, "strip"));
  const std::vector<std::string> notes = notes_on(made, "strip");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].rfind("1 of 3 faces have no elements of their own", 0), 0u) << notes[0];
}

TEST(TrueParts, WhereAllHaveFacesNothingIsSaid) {
  const Result made = cube_of(0.3, 0.7);
  EXPECT_TRUE(has_group(made, "strip"));
  EXPECT_TRUE(notes_on(made, "strip").empty());
}

/// The unit cube without its top: patches 0 and 1 are the faces at x = 0 and x = 1, 2 and 3 those of y, 4 the bottom.
class OpenBox final : public testing::PartsByPatch {
 public:
  OpenBox() : PartsByPatch({"x0", "x1", "y0", "y1", "bottom"}) {}
  std::optional<Vec3> on_face(std::uint32_t patch, Vec3 p) const override { return onto(patch, p); }
  std::optional<Vec3> on_edge(std::span<const std::uint32_t> patches, Vec3 p) const override {
    std::vector<std::uint32_t> known;
    for (const std::uint32_t patch : patches)
      if (patch < 5 && (known.empty() || known[0] / 2 != patch / 2)) known.push_back(patch);
    if (known.size() < 2) return std::nullopt;
    return onto(known[0], onto(known[1], p));
  }
  bool is_vertex(Vec3 p) const override {
    return (p.x == 0 || p.x == 1) && (p.y == 0 || p.y == 1) && (p.z == 0 || p.z == 1);
  }

 private:
  static Vec3 onto(std::uint32_t patch, Vec3 p) {
    (patch < 2 ? p.x : patch < 4 ? p.y : p.z) = patch < 4 ? patch % 2 : 0;
    return p;
  }
};

Domain closed_box() {
  Domain domain{testing::cube(1)};
  SurfaceMesh& box = domain.surface;
  box.patch_names = {"x0", "x1", "y0", "y1", "bottom", kClosedByRepair};
  box.patch.clear();
  for (const auto& [a, b, c] : box.triangles) {
    const Vec3 m = (box.points[a] + box.points[b] + box.points[c]) / 3;
    box.patch.push_back(m.x == 0 ? 0 : m.x == 1 ? 1 : m.y == 0 ? 2 : m.y == 1 ? 3 : m.z == 0 ? 4 : 5);
  }
  domain.geometry = std::make_shared<const OpenBox>();
  return domain;
}

TEST(TrueGeometryOfRepaired, WhatRepairClosedIsDrawnToNoFace) {
  Options options;
  options.size.size = 0.2;
  const Result made = generate(closed_box(), options);
  EXPECT_GT(made.report.quality.dihedral_min, 20);
  EXPECT_NEAR(made.report.volume, 1, 1e-9);
  EXPECT_TRUE(has_group(made, kClosedByRepair));
}

bool was_unfolded(const Domain& domain) {
  Options options;
  options.size.size = 0.5;
  const Result made = generate(domain, options);
  return std::ranges::any_of(made.report.stages, [](const StageReport& stage) { return stage.name == "detail"; });
}

TEST(TrueGeometryOfSolids, KeepsTheirFolds) {
  Domain domain = closed_box();
  EXPECT_TRUE(was_unfolded(domain));
  domain.true_volumes = {1};
  EXPECT_FALSE(was_unfolded(domain));
}

}  // namespace
}  // namespace octafront
