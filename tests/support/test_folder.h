#pragma once

#include <octafront/io.h>

#include "support/temporary_folder.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace octafront::testing {

/// A folder for the files of one test, which runs in it.
class InItsFolder : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(folder_.path()); }
  void TearDown() override { std::filesystem::current_path(before_); }

  std::string file(const std::string& name, const SurfaceMesh& surface) const {
    const std::string path = folder_ / name;
    write_surface(path, surface);
    return path;
  }

  const TemporaryFolder folder_;

 private:
  const std::filesystem::path before_ = std::filesystem::current_path();
};

}  // namespace octafront::testing
