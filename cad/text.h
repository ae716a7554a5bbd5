#pragma once

#include <string>
#include <string_view>

namespace octafront::cad {

bool is_utf8(std::string_view bytes);
/// The bytes themselves if they are UTF-8, else what they are in Latin-1; without control characters.
std::string to_utf8(std::string_view bytes);
/// Names that programs write where the user gave none: "", "NONE", "Open CASCADE STEP translator 7.6 1".
bool says_nothing(std::string_view name);

}  // namespace octafront::cad
