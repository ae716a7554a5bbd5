// Named parts of a surface whose true geometry is known.

#include <octafront/domain.h>
#include <octafront/generate.h>
#include <octafront/io.h>

#include "base/geometry/true_geometry.h"
#include "support/named_surfaces.h"

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

}  // namespace
}  // namespace octafront
