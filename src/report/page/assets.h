#pragma once

#include <string_view>

namespace octafront::page_asset {

// What every page has, made of the files in assets/ when the library is built: all up to the mesh, and all behind it.
extern const std::string_view kBefore, kBehind;

}  // namespace octafront::page_asset
