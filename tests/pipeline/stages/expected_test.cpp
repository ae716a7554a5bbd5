// What is announced and what is made.

#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

/// A ball whose vertices lie off it, in and out: it strays, and makes feature lines, however it is divided.
SurfaceMesh rough_ball() {
  SurfaceMesh ball = testing::icosphere(4);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.06, 0.06);
  for (Vec3& p : ball.points) p = p * (1 + off(random));
  return ball;
}

bool has_note(const Report& report, const std::string& words) {
  return std::any_of(report.stages.begin(), report.stages.end(), [&](const StageReport& stage) {
    return std::any_of(stage.notes.begin(), stage.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
  });
}

double counted(const Report& report, const std::string& what) {
  for (const StageReport& stage : report.stages)
    for (const auto& [name, value] : stage.counters)
      if (name == what) return value;
  return -1;
}

TEST(Expected, AutomaticSizesKeepToTheirBudgetAndSayWhatTheyGiveUp) {
  Options options;
  options.size.automatic_factor = 2;
  const Report kept = generate(rough_ball(), options).report;
  const double budget = counted(kept, "budget of elements");
  EXPECT_EQ(budget, 50'000);
  EXPECT_LT(static_cast<double>(kept.tets), 1.3 * budget);
  EXPECT_LT(share(kept.expected_tets, static_cast<double>(kept.tets)), 0.15);
  EXPECT_TRUE(has_note(kept, "has a budget of 0.05 million"));
  EXPECT_TRUE(has_note(kept, "from the input, up to"));
  // The same bound as a wish of the user's own has no budget.
  options.surface.max_deviation = 0.008 * bounding_box(rough_ball().points).diagonal();
  const Report asked = generate_sizes(rough_ball(), options).report;
  EXPECT_EQ(counted(asked, "budget of elements"), -1);
  EXPECT_GT(asked.expected_tets, 1.5 * budget);
}

/// A part smaller than its elements, of three widths; `k` numbers them.
SurfaceMesh crumb(int k) {
  const auto part = [k](double step) { return 0.3 + 0.7 * (k * step - std::floor(k * step)); };
  const double size = 0.015 * part(0.236), angle = 2 * std::numbers::pi * k / 60;
  SurfaceMesh crumb = testing::icosphere(0);
  for (Vec3& p : crumb.points)
    p = size * Vec3{part(0.618) * p.x, part(0.414) * p.y, part(0.732) * p.z} +
        1.2 * Vec3{std::cos(angle), std::sin(angle), 0};
  return crumb;
}

/// Some of them come out inside out at first: sizes fall around these, not everywhere.
TEST(Expected, TinyPartsMakeNoSmallElementsElsewhere) {
  const SurfaceMesh ball = testing::icosphere(4);
  SurfaceMesh with_crumbs = ball;
  for (int k = 0; k < 60; ++k) with_crumbs = testing::joined(with_crumbs, crumb(k));
  const double plain = generate_sizes(ball).report.expected_tets;
  // 17 times as many where they fell everywhere.
  EXPECT_LT(generate_sizes(with_crumbs).report.expected_tets, 6 * plain);
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
      EXPECT_TRUE(share(sizes.expected_tets, wanted) < 0.2 || says_why_not(sizes)) << sizes.expected_tets;
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
