#include <octafront/error.h>
#include <octafront/io.h>

#include "support/temporary_folder.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

const char* const kMetricMesh =
    "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
    "Tetrahedra\n1\n1 2 3 4 1\nEnd\n";
const char* const kMetricSol =
    "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n4\n2 1 3\n7 1 2 3 4 5 6\n7 1 0 1 0 0 1\n7 1 0 1 0 0 1\n"
    "7 1 0 1 0 0 1\nEnd\n";

class MetricFiles : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    const std::string file = (folder_ / name).string();
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  static std::string refusal(const std::string& named, const std::string& mesh = {}) {
    try {
      read_metric(named, mesh);
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  }

  const testing::TemporaryFolder folder_;
};

TEST_F(MetricFiles, SolutionsHaveTheLowerTriangleByRows) {
  write("a.mesh", kMetricMesh);
  const MetricMesh read = read_metric(write("a.sol", kMetricSol));
  ASSERT_EQ(read.metrics.size(), 4u);
  EXPECT_EQ(read.metrics[0], (Metric{1, 2, 4, 3, 5, 6}));
  EXPECT_EQ(read.tets.size(), 1u);
}

TEST_F(MetricFiles, SizesThatAreNoneAreToldWithTheirPoints) {
  const std::string mesh = write("a.mesh", kMetricMesh);
  const auto told = [&](const std::string& size) {
    return refusal(
        write("a.sol", "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n4\n1 1\n1 1 1 " + size + "\nEnd\n"), mesh);
  };
  EXPECT_NE(told("-0.1").find("size -0.1 at point 3: sizes must be above 0"), std::string::npos) << told("-0.1");
  EXPECT_NE(told("0").find("size 0 at point 3"), std::string::npos);
  EXPECT_NE(told("1e-310").find("size 1e-310 at point 3 is out of range"), std::string::npos) << told("1e-310");
  EXPECT_EQ(told("1e-6"), "taken");
}

TEST_F(MetricFiles, SolutionOfTheMeshThatIsAdapted) {
  const std::string mesh = write("other.mesh", kMetricMesh), sol = write("a.sol", kMetricSol);
  EXPECT_EQ(read_metric(sol, mesh).points.size(), 4u);
  EXPECT_NE(refusal(sol).find("neither .mesh nor .meshb"), std::string::npos) << refusal(sol);
  const std::string few = write("few.sol", "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n3\n1 1\n1 2 3\nEnd\n");
  EXPECT_NE(refusal(few, mesh).find("3 values, but"), std::string::npos) << refusal(few, mesh);
}

TEST_F(MetricFiles, SizesBecomeRoundMetrics) {
  write("a.mesh", kMetricMesh);
  const MetricMesh read =
      read_metric(write("a.sol", "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n4\n1 1\n2 3 1 4\nEnd\n"));
  EXPECT_EQ(read.metrics[0], Metric::of_size(2));
}

TEST_F(MetricFiles, BinarySolutions) {
  write("a.mesh", kMetricMesh);
  std::string bytes;
  const auto add = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const std::int32_t word : {1, 2, 3, 20, 3, 62, 20 + 4 * 5 + 4 * 48, 4, 1, 3}) add(word);
  for (int v = 0; v < 4; ++v)
    for (const double value : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0 + v}) add(value);
  add(std::int32_t{54}), add(std::int32_t{0});
  const MetricMesh read = read_metric(write("a.solb", bytes));
  ASSERT_EQ(read.metrics.size(), 4u);
  EXPECT_EQ(read.metrics[3], (Metric{1, 2, 4, 3, 5, 9}));
  for (std::size_t n = 0; n + 9 < bytes.size(); n += 7)
    EXPECT_THROW(read_metric(write("a.solb", bytes.substr(0, n + 1))), InputError) << n;
}

TEST_F(MetricFiles, WhatIsWrittenIsReadAgain) {
  write("a.mesh", kMetricMesh);
  const MetricMesh metric = read_metric(write("a.sol", kMetricSol));
  for (const char* name : {"b.vtu", "a.sol"}) {
    const std::string file = (folder_ / name).string();
    write_metric(file, metric);
    const MetricMesh again = read_metric(file);
    EXPECT_EQ(again.metrics, metric.metrics) << name;
    EXPECT_EQ(again.tets, metric.tets) << name;
  }
  EXPECT_THROW(write_metric((folder_ / "a.obj").string(), metric), OptionError);
}

TEST_F(MetricFiles, SixNumbersOfVtkAreDiagonalFirst) {
  const std::string head =
      "# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\n"
      "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\n";
  const std::string six = "FIELD f 1\nm 6 4 double\n1 2 3 4 5 6 1 1 1 0 0 0 1 1 1 0 0 0 1 1 1 0 0 0\n";
  const std::string file = write("a.vtk", head + six);
  EXPECT_EQ(read_metric(file).metrics[0], (Metric{1, 4, 6, 2, 5, 3}));
  EXPECT_EQ(read_metric(file + ":m").metrics[0], (Metric{1, 4, 6, 2, 5, 3}));
  EXPECT_NE(refusal(file + ":n").find("there are \"m\""), std::string::npos) << refusal(file + ":n");
  const std::string nine =
      "TENSORS t double\n1 2 3 2 4 5 3 5 6 1 0 0 0 1 0 0 0 1 1 0 0 0 1 0 0 0 1 1 0 0 0 1 0 7 0 1\n";
  const std::string skew = write("b.vtk", head + nine);
  EXPECT_NE(refusal(skew).find("point 3 is not symmetric"), std::string::npos) << refusal(skew);
  const std::string plain = write("c.vtk", head + "SCALARS h double 1\nLOOKUP_TABLE default\n1 2 3 5\n");
  EXPECT_NE(refusal(plain).find("no tensors"), std::string::npos) << refusal(plain);
  EXPECT_EQ(read_metric(plain + ":h").metrics[3], Metric::of_size(5));
  const TetMesh mesh = read_mesh(plain);
  EXPECT_EQ(read_point_values(plain, "h", mesh), (std::vector<double>{1, 2, 3, 5}));
  EXPECT_THROW(read_point_values(plain, "u", mesh), InputError);
}

}  // namespace
}  // namespace octafront
