#include "formats/containers/named_file.h"

#include <system_error>

#include <fmt/core.h>

namespace octafront::io {

namespace fs = std::filesystem;

fs::path named_file(const Input& by, const std::string& name) {
  const fs::path folder = fs::path(by.name).parent_path();
  const fs::path file = (folder / name).lexically_normal();
  std::error_code error;
  const fs::path within =
      fs::absolute(file, error).lexically_relative(fs::absolute(folder / ".", error).lexically_normal());
  if (within.empty() || *within.begin() == "..")
    by.fail(
        fmt::format("names the file {}, which is outside its own folder; put that file beside it, and name it "
                    "without a folder",
                    in_quotes(name)));
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
    by.fail(fmt::format("names {}, which is no plain file (but a folder, a pipe or a device)", in_quotes(name)));
  return file;
}

fs::path sibling_file(const Input& by, const std::string& ending) {
  const std::string name = fs::path(by.name).replace_extension(ending).filename().string();
  std::error_code error;
  const fs::path file = named_file(by, name);
  return fs::exists(file, error) ? file : fs::path();
}

}  // namespace octafront::io
