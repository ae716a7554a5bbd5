#include <octafront/limits.h>

#include "support/temporary_folder.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace octafront {
namespace {

namespace fs = std::filesystem;

class LiesIn : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(all_ / "in" / "below");
    fs::create_directories(all_ / "inside");
    std::ofstream(all_ / "in" / "a.stl") << "a";
    std::ofstream(all_ / "out.stl") << "a";
  }
  bool lies(const fs::path& file) const { return lies_in(file.string(), {(all_ / "in").string()}); }

  const testing::TemporaryFolder folder_;
  const fs::path& all_ = folder_.path();
};

TEST_F(LiesIn, WhatIsInAFolderOrBelow) {
  EXPECT_TRUE(lies(all_ / "in" / "a.stl"));
  EXPECT_TRUE(lies(all_ / "in" / "below" / "new.vtu"));
  EXPECT_TRUE(lies(all_ / "in" / "below" / ".." / "new.vtu"));
  EXPECT_TRUE(lies(all_ / "in"));
  EXPECT_FALSE(lies(all_ / "out.stl"));
  EXPECT_FALSE(lies(all_ / "inside" / "a.stl")) << "a longer name is another folder";
  EXPECT_FALSE(lies(all_ / "in" / ".." / "out.stl"));
  EXPECT_FALSE(lies(all_ / "in" / "no" / ".." / ".." / "out.stl"));
  EXPECT_FALSE(lies_in((all_ / "in" / "a.stl").string(), {}));
  EXPECT_FALSE(lies_in((all_ / "in" / "a.stl").string(), {(all_ / "gone").string()}));
}

TEST_F(LiesIn, LinksAreFollowed) {
  fs::create_symlink(all_ / "out.stl", all_ / "in" / "link.stl");
  fs::create_directory_symlink(all_, all_ / "in" / "up");
  fs::create_symlink(all_ / "new.vtu", all_ / "in" / "new.vtu");  // leads to nothing yet
  fs::create_symlink("loop", all_ / "in" / "loop");
  fs::create_directory_symlink(all_ / "in", all_ / "back");
  EXPECT_FALSE(lies(all_ / "in" / "link.stl"));
  EXPECT_FALSE(lies(all_ / "in" / "up" / "out.stl"));
  EXPECT_FALSE(lies(all_ / "in" / "new.vtu"));
  EXPECT_TRUE(lies(all_ / "back" / "a.stl"));
  EXPECT_NO_THROW(lies(all_ / "in" / "loop"));
}

}  // namespace
}  // namespace octafront
