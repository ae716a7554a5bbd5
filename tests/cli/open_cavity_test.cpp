#include "open_cavity.h"

#include <octafront/octafront.h>

#include "support/temporary_folder.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace octafront::cli {
namespace {

TEST(OpenCavity, IsWrittenBesideTheOutputWithASentenceHowToReportIt) {
  const SurfaceMesh cavity{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, {}, {}, {}};
  const OpenCavityError error("a cavity of 4 faces near (0, 0, 0) could not be filled", cavity);
  const testing::TemporaryFolder folder;
  const MeshingError told = with_cavity_written(error, folder / "octafront_open_cavity_test.vtu");

  const auto file = folder / "octafront_open_cavity_test.cavity.off";
  const SurfaceMesh read = read_surface(file).surface;
  EXPECT_EQ(read.points, cavity.points);
  EXPECT_EQ(read.triangles, cavity.triangles);
  const std::string message = told.what();
  EXPECT_NE(message.find(error.what()), std::string::npos);
  EXPECT_NE(message.find(file.string()), std::string::npos);
  EXPECT_NE(message.find("please report it with that file"), std::string::npos);
}

TEST(OpenCavity, ThatCannotBeWrittenSaysSo) {
  const OpenCavityError error("a cavity", SurfaceMesh{});
  EXPECT_THROW(with_cavity_written(error, "/no/such/folder/mesh.vtu"), OutputError);
}

}  // namespace
}  // namespace octafront::cli
