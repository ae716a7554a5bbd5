#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace octafront::cli {

/// A folder that only this user may look into, removed with all that is in it.
class ScratchFolder {
 public:
  /// Throws OutputError if there can be none.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// A new one inside.
  std::filesystem::path add(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

/// Whether it names a file of a folder, and nothing beyond: no part of a path, nothing hidden, no character that is
/// not to be seen.
bool is_plain_name(const std::string& name);

/// The files in a folder and below, by their names from there with slashes between; links are none.
std::vector<std::string> files_below(const std::filesystem::path& folder);

}  // namespace octafront::cli
