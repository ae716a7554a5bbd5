#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace octafront::cli {

/// The folders that files may be in, links in their names followed.
class Folders {
 public:
  /// Throws OptionError for what is no folder.
  explicit Folders(const std::vector<std::filesystem::path>& folders);

  const std::vector<std::string>& all() const { return all_; }
  /// Where names without a folder are: the first.
  std::filesystem::path home() const { return all_.front(); }
  /// Whether a file, which need not exist, lies in one of them once links and ".." are followed.
  bool hold(const std::string& file) const;

 private:
  std::vector<std::string> all_;
};

}  // namespace octafront::cli
