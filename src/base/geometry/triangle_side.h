#pragma once

#include <cstdint>

namespace octafront {

/// A side of a triangle: 2 t in front of triangle t, 2 t + 1 behind it.
using Side = std::uint32_t;

constexpr Side front_of(std::uint32_t triangle) {
  return 2 * triangle;
}
constexpr Side behind(std::uint32_t triangle) {
  return 2 * triangle + 1;
}
constexpr std::uint32_t triangle_of(Side side) {
  return side / 2;
}

}  // namespace octafront
