#pragma once

#include <string_view>
#include <vector>

namespace octafront {

/// A font of strokes, made for this program: letters, digits and signs of ASCII and Latin-1, and some more. What it
/// lacks is a box. Heights are parts of that of a capital letter; y goes up from the line on which letters stand.
namespace stroke_font {

struct Point {
  double x = 0, y = 0;
};
using Stroke = std::vector<Point>;  ///< a polygon; a single point is a dot

/// The strokes of a text in UTF-8, from x = 0 on.
std::vector<Stroke> strokes_of(std::string_view text);
double width_of(std::string_view text);

inline constexpr double kDescent = 0.3;  ///< how far letters go down

}  // namespace stroke_font

}  // namespace octafront
