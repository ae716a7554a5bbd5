
#include "report/picture/colours.h"

#include <fmt/core.h>

namespace octafront {

Rgb mixed(Rgb a, Rgb b, double share) {
  const auto between = [&](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(from + share * (to - from) + 0.5);
  };
  return {between(a.r, b.r), between(a.g, b.g), between(a.b, b.b)};
}

std::string hex_of(Rgb colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b);
}

Rgb colour_of_part(std::uint32_t number) {
  const Rgb colour = kPalette[number % kPalette.size()];
  switch (number / kPalette.size() % 3) {
    case 1:
      return mixed(colour, {255, 255, 255}, 0.5);
    case 2:
      return mixed(colour, {0, 0, 0}, 0.45);
    default:
      return colour;
  }
}

}  // namespace octafront
