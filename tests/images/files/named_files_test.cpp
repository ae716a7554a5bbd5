#include <octafront/error.h>
#include <octafront/image.h>
#include <octafront/io.h>

#include "images/small_images.h"
#include "support/named_surfaces.h"
#include "support/test_folder.h"

#include <filesystem>
#include <fstream>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace octafront {
namespace {

namespace fs = std::filesystem;
using testing::any_contains;
using testing::contains;
using testing::input_error;

void write_named(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Headers of a voxel of each kind that name a file of voxels.
std::string meta_header(const std::string& names) {
  return "ObjectType = Image\nNDims = 3\nDimSize = 1 1 2\nElementType = MET_UCHAR\nElementDataFile = " + names + "\n";
}
std::string nrrd_header(const std::string& names) {
  return "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 1 2\nspacings: 1 1 1\nencoding: raw\ndata file: " + names +
         "\n";
}
std::string raw_header(const std::string& names) {
  return fmt::format(R"({{"size": [1, 1, 2], "type": "uint8", "spacing": [1, 1, 1], "file": "{}"}})", names);
}

class NamedFiles : public testing::InItsFolder {
 protected:
  void SetUp() override {
    InItsFolder::SetUp();
    fs::create_directories("in/below");
    write_named("secret.raw", "ab"), write_named("in/voxels.raw", "ab"), write_named("in/below/voxels.raw", "ab");
  }

  /// The header of each kind in the folder `in` names this file.
  template <class Look>
  void with_each(const std::string& names, const Look& look) {
    for (const auto& [file, bytes] : {std::pair{"in/a.mhd", meta_header(names)},
                                      {"in/a.nhdr", nrrd_header(names)},
                                      {"in/a.json", raw_header(names)}}) {
      SCOPED_TRACE(file);
      write_named(file, bytes);
      look(std::string(file));
    }
  }
};

TEST_F(NamedFiles, LieInTheFolderOfTheHeaderOrBelow) {
  for (const std::string& name : {std::string("voxels.raw"), std::string("below/voxels.raw"),
                                  std::string("below/../voxels.raw"), (folder_ / "in/voxels.raw").string()})
    with_each(name, [](const std::string& file) { EXPECT_EQ(read_image(file).grid.voxels(), 2U); });
  for (const std::string& name : {std::string("../secret.raw"), std::string("below/../../secret.raw"),
                                  (folder_ / "secret.raw").string(), std::string("/etc/passwd")})
    with_each(name, [](const std::string& file) {
      EXPECT_PRED2(contains, input_error([&] { read_image(file); }), "outside its own folder");
    });
}

TEST_F(NamedFiles, ArePlain) {
  ASSERT_EQ(::mkfifo("in/pipe", 0600), 0);
  for (const char* name : {"pipe", "below"})
    with_each(name, [](const std::string& file) {
      EXPECT_PRED2(contains, input_error([&] { read_image(file); }), "no plain file");
    });
}

TEST_F(NamedFiles, AHeaderBesideDecidesWhereContentAndNameDoNot) {
  const SurfaceMesh box = testing::box(1, 1, 1);
  for (const char* name : {"part.stl", "part.ply", "part.off"}) {
    SCOPED_TRACE(name);
    file(name, box);
    write_named("part.json", raw_header("in/voxels.raw"));
    EXPECT_FALSE(is_image(name));
  }
  // Content goes before the header even under a name that says nothing.
  fs::rename("part.stl", "part.dat");
  EXPECT_FALSE(is_image("part.dat"));
  for (const char* name : {"scan.raw", "scan.bin", "scan"}) {
    SCOPED_TRACE(name);
    write_named(name, "ab"), write_named("scan.json", raw_header("voxels.raw"));
    ASSERT_TRUE(is_image(name));
    EXPECT_PRED2(any_contains, read_image(name).notes, "scan.json");
  }
}

}  // namespace
}  // namespace octafront
