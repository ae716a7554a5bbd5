#include "formats/read/included_file.h"

#include <algorithm>
#include <filesystem>

namespace octafront::io {

std::optional<LoadedFile> included_file(const Input& input, std::string name) {
  namespace fs = std::filesystem;
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path wanted(name);
  const auto is_up = [](const fs::path& part) { return part == ".."; };
  if (wanted.empty() || wanted.is_absolute() || std::any_of(wanted.begin(), wanted.end(), is_up)) return std::nullopt;
  const fs::path file = fs::path(input.name).parent_path() / wanted;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  return LoadedFile(file, input.context);
}

}  // namespace octafront::io
