#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// What a curve is called along which these patches meet (ascending, each once): "A|B", or "A + A|B + B" where names
/// have a bar of their own; "A end" where one patch ends. Empty if one of them has no name.
std::string curve_name(std::span<const std::uint32_t> patches, const std::vector<std::string>& patch_names);

}  // namespace octafront
