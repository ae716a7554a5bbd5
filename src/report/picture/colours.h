#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace octafront {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Between a (0) and b (1).
Rgb mixed(Rgb a, Rgb b, double share);
/// "#56b4e9"
std::string hex_of(Rgb colour);

/// From poor (0) to good (1): the lightness rises all the way, and for colour-blind eyes too; what is poor is dark and
/// warm, what is good light and cool.
inline constexpr std::array<Rgb, 6> kPoorToGood{{{0x3f, 0x0a, 0x1e},
                                                 {0x8f, 0x1d, 0x1a},
                                                 {0xcb, 0x50, 0x16},
                                                 {0xea, 0x98, 0x3c},
                                                 {0xea, 0xd0, 0x96},
                                                 {0xbf, 0xe3, 0xfa}}};
/// From small to large, of what is neither good nor poor: lighter all the way, from blue to yellow.
inline constexpr std::array<Rgb, 5> kSmallToLarge{
    {{0x14, 0x2c, 0x5f}, {0x2c, 0x66, 0x8c}, {0x4f, 0x9f, 0x93}, {0xa3, 0xcf, 0x86}, {0xf7, 0xf0, 0xa6}}};
/// Of Okabe and Ito, for what has no order.
inline constexpr std::array<Rgb, 8> kPalette{{{0x56, 0xb4, 0xe9},
                                              {0xe6, 0x9f, 0x00},
                                              {0x00, 0x9e, 0x73},
                                              {0xcc, 0x79, 0xa7},
                                              {0x00, 0x72, 0xb2},
                                              {0xd5, 0x5e, 0x00},
                                              {0xf0, 0xe4, 0x42},
                                              {0x9a, 0x9a, 0x9a}}};

/// A colour of a scale; `share` below 0, or not a number, is 0, above 1 is 1.
template <std::size_t N>
Rgb on_scale(const std::array<Rgb, N>& stops, double share) {
  const double at = share > 0 ? (share < 1 ? share : 1) * (N - 1) : 0;
  const std::size_t k = at < N - 2 ? static_cast<std::size_t>(at) : N - 2;
  return mixed(stops[k], stops[k + 1], at - static_cast<double>(k));
}

/// Of a region or patch: the palette, then the same lighter, then darker.
Rgb colour_of_part(std::uint32_t number);

}  // namespace octafront
