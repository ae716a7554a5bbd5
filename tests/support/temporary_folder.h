#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <system_error>

#include <unistd.h>

namespace octafront::testing {

/// A new folder that no other test has, of this process or one beside it; removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() { std::filesystem::create_directories(path_); }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  static int next() {
    static std::atomic<int> counter{0};
    return counter++;
  }

  const std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                      ("octafront-test-" + std::to_string(::getpid()) + "-" + std::to_string(next()));
};

}  // namespace octafront::testing
