#include "base/mesh/curve_names.h"

#include <algorithm>

namespace octafront {

std::string curve_name(std::span<const std::uint32_t> patches, const std::vector<std::string>& patch_names) {
  const auto name_of = [&](std::uint32_t patch) {
    return patch < patch_names.size() ? patch_names[patch] : std::string();
  };
  std::string name;
  const bool has_bars = std::any_of(patches.begin(), patches.end(),
                                    [&](std::uint32_t p) { return name_of(p).find('|') != std::string::npos; });
  for (const std::uint32_t p : patches) {
    if (name_of(p).empty()) return "";
    name += (name.empty() ? "" : has_bars ? " + " : "|") + name_of(p);
  }
  return patches.size() == 1 ? name + " end" : name;
}

}  // namespace octafront
