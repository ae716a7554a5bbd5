#pragma once

#include <octafront/io.h>

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace octafront::testing {

/// A folder for the files of one test, which runs in it.
class InItsFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    std::filesystem::current_path(folder_);
  }
  void TearDown() override {
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(folder_);
  }

  std::string file(const std::string& name, const SurfaceMesh& surface) const {
    const std::string path = folder_ / name;
    write_surface(path, surface);
    return path;
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) / ::testing::UnitTest::GetInstance()->current_test_info()->name();

 private:
  const std::filesystem::path before_ = std::filesystem::current_path();
};

}  // namespace octafront::testing
