// What is announced and what is made.

#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;

struct Model {
  const char* name;
  SurfaceMesh surface;
};

std::vector<Model> thin_models() {
  std::vector<Model> models;
  models.push_back({"plate of a hundredth", box(1, 1, 0.01)});
  models.push_back({"plate of a thousandth", box(1, 1, 1e-3)});
  models.push_back({"plate of a hundred thousandth", box(1, 1, 1e-5)});
  models.push_back({"hollow box", testing::joined(box(1, 1, 1), testing::reversed(testing::transformed(
                                                                    box(1, 1, 1), 0.998, {0.001, 0.001, 0.001})))});
  return models;
}

double share(double a, double b) {
  return std::abs(a / b - 1);
}

TEST(Expected, ThinWallsHaveTheElementsAnnounced) {
  for (const Model& m : thin_models()) {
    SCOPED_TRACE(m.name);
    Options options;
    options.size.size = 0.04;
    options.improve.level = ImproveOptions::Level::kOff;
    const Result made = generate(m.surface, options);
    EXPECT_EQ(first_defect(made.mesh), std::nullopt);
    EXPECT_LT(share(made.report.expected_tets, static_cast<double>(made.report.tets)), 0.15);
    EXPECT_LT(share(generate_sizes(m.surface, options).report.expected_tets, made.report.expected_tets), 1e-9);
  }
}

bool says_why_not(const Report& report) {
  const auto says = [](const std::string& note) { return note.find("elements were wanted; the") != std::string::npos; };
  return std::any_of(report.stages.begin(), report.stages.end(), [&](const StageReport& stage) {
    return std::any_of(stage.notes.begin(), stage.notes.end(), says);
  });
}

TEST(Expected, SizesAndMeshMeetTheSameNumber) {
  std::vector<Model> models = thin_models();
  models.push_back({"torus", testing::torus(60, 24)});
  for (const Model& m : models) {
    for (const std::int64_t n : {4'000, 20'000}) {
      SCOPED_TRACE(m.name + std::string(", ") + std::to_string(n));
      Options options;
      options.size.elements = n;
      options.improve.level = ImproveOptions::Level::kOff;
      const Report sizes = generate_sizes(m.surface, options).report, mesh = generate(m.surface, options).report;
      const auto wanted = static_cast<double>(n), made = static_cast<double>(mesh.tets);
      EXPECT_LT(share(sizes.expected_tets, made), 0.15);
      EXPECT_TRUE(share(sizes.expected_tets, wanted) < 0.15 || says_why_not(sizes)) << sizes.expected_tets;
      EXPECT_TRUE(share(made, wanted) < 0.15 || says_why_not(mesh)) << made;
    }
  }
}

/// Insertions take most of the time where each element is tried, and find nothing in a wall thinner than its elements.
TEST(Expected, ImprovementDoesNotTryWhatThePlateForces) {
  Options options;
  options.size.size = 0.02;
  const Report report = generate(box(1, 1, 1e-3), options).report;
  const StageReport& improve = *std::find_if(report.stages.begin(), report.stages.end(),
                                             [](const StageReport& stage) { return stage.name == "improve"; });
  double tried = 0;
  for (std::size_t i = 0; i + 1 < improve.counters.size(); ++i)
    if (improve.counters[i].first.find("inser") != std::string::npos) tried += improve.counters[i + 1].second;
  EXPECT_LT(tried, 0.5 * static_cast<double>(report.tets));
}

}  // namespace
}  // namespace octafront
