// Who is told to ask for what.

#include "sizing/sources/make_size_field.h"
#include "support/named_surfaces.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::box;

StageReport report_of(const SurfaceMesh& surface, const SizeOptions& options) {
  StageReport report;
  make_size_field(KnownSurface(surface, 40), options, {RunContext{}, report});
  return report;
}

TEST(SizeField, TellsWhoAsksForWhat) {
  SizeOptions options;
  options.size = 0.2;
  options.near = {{"", {0, 0, 0}, 0.05, 0.4}};
  const StageReport report = report_of(box(1, 1, 1, 10), options);
  double all = 0, by_size = 0, by_point = 0;
  for (const auto& [key, value] : report.counters) {
    if (!key.starts_with("asked by ")) continue;
    all += value;
    if (key.find("`size`") != std::string::npos) by_size = value;
    if (key.find("size_near") != std::string::npos) by_point = value;
  }
  EXPECT_NEAR(all, 100, 1e-9);
  EXPECT_GT(by_size, 30);
  EXPECT_GT(by_point, 1);
  ASSERT_FALSE(report.notes.empty());
  EXPECT_NE(report.notes.back().find("asked by"), std::string::npos);
}

/// What of its sizes the gradation lowers a field asks for itself, however few the triangles of the input.
TEST(SizeField, AFieldAloneAsksForAll) {
  SizeOptions options;
  auto mesh = std::make_shared<SizeMesh>();
  mesh->points = {{-1, -1, -1}, {9, -1, -1}, {-1, 9, -1}, {-1, -1, 9}};
  mesh->tets = {{0, 1, 2, 3}};
  mesh->point_sizes = {0.02, 3, 0.02, 0.02};
  mesh->name = "sizes.vtu";
  options.mesh = mesh;
  const StageReport report = report_of(box(1, 1, 1), options);
  double by_field = 0;
  for (const auto& [key, value] : report.counters)
    if (key.starts_with("asked by ") && key.find("sizes.vtu") != std::string::npos) by_field += value;
  EXPECT_NEAR(by_field, 100, 1e-6);
}

/// A triangle is not asked at its middle alone.
TEST(SizeField, SharesDoNotHangOnTheInputsTriangles) {
  const auto share = [](int divisions) {
    SizeOptions options;
    options.size = 0.2;
    options.regions = {{{0, 0, 0}, {0.25, 1, 1}, 0, 0.1}};
    double all = 0;
    for (const auto& [key, value] : report_of(box(1, 1, 1, divisions), options).counters)
      if (key.starts_with("asked by ") && key.find("`size`") != std::string::npos) all += value;
    return all;
  };
  EXPECT_NEAR(share(1), share(12), 3);
}

TEST(SizeField, SaysNothingOfASingleSource) {
  SizeOptions options;
  options.size = 0.2;
  EXPECT_TRUE(report_of(box(1, 1, 1), options).notes.empty());
}

}  // namespace
}  // namespace octafront
