#include "workbench_files.h"

#include <octafront/error.h>

#include <algorithm>
#include <cstdlib>

#include <unistd.h>

namespace octafront::cli {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "octafront-ui-XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr) throw OutputError("no folder for what is made can be made");
  path_ = fs::canonical(name);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path ScratchFolder::add(const std::string& name) const {
  std::error_code error;
  fs::create_directory(path_ / name, error);
  if (error) throw OutputError("no folder for what is made can be made: " + error.message());
  return path_ / name;
}

bool is_plain_name(const std::string& name) {
  constexpr std::size_t kLongest = 200;
  if (name.empty() || name.size() > kLongest || name.front() == '.' || name.front() == '-') return false;
  return std::ranges::none_of(
      name, [](char c) { return c == '/' || c == '\\' || static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
}

std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> all;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, ignored))
    if (entry.is_regular_file(ignored) && !entry.is_symlink(ignored))
      all.push_back(entry.path().lexically_relative(folder).generic_string());
  std::ranges::sort(all);
  return all;
}

}  // namespace octafront::cli
