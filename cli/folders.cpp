#include "folders.h"

#include <octafront/error.h>
#include <octafront/limits.h>

#include <fmt/core.h>

namespace octafront::cli {

Folders::Folders(const std::vector<std::filesystem::path>& folders) {
  for (const std::filesystem::path& folder : folders) {
    std::error_code error;
    const std::filesystem::path real = std::filesystem::canonical(folder, error);
    if (error || !std::filesystem::is_directory(real, error))
      throw OptionError(fmt::format("--folder: {} is no folder that is there", folder.string()));
    all_.push_back(real.string());
  }
}

bool Folders::hold(const std::string& file) const {
  const std::filesystem::path named(file);
  return lies_in((named.is_absolute() ? named : home() / named).string(), all_);
}

}  // namespace octafront::cli
