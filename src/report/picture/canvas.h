#pragma once

#include <octafront/picture.h>

#include "report/picture/colours.h"

#include <span>
#include <string_view>
#include <vector>

namespace octafront {

/// A point of a picture in pixels, from the upper left corner to the right and down.
struct Pixel {
  double x = 0, y = 0;
};

struct Rectangle {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  double width() const { return x1 - x0; }
  double height() const { return y1 - y0; }
  bool meets(const Rectangle& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

/// How a line or a text is drawn.
struct Ink {
  Rgb colour;
  double width = 1;  ///< of lines, in pixels
  double halo = 0;   ///< so much wider is white beneath
  double opacity = 1;
};

/// What is drawn over a picture, smooth at its edges. Parts outside are cut off.
class Canvas {
 public:
  explicit Canvas(Picture& picture) : picture_(picture) {}

  int width() const { return picture_.width; }
  int height() const { return picture_.height; }
  /// Lines through the points, one after the other; a single point is a dot.
  void lines(std::span<const std::vector<Pixel>> polygons, const Ink& ink);
  void line(Pixel a, Pixel b, const Ink& ink);
  void circle(Pixel middle, double radius, const Ink& ink);
  void fill(const Rectangle& where, Rgb colour, double opacity = 1);
  void frame(const Rectangle& where, const Ink& ink);
  /// `size`: the height of a capital in pixels; `at`: the left end of the line on which letters stand.
  void text(Pixel at, double size, std::string_view text, Rgb colour, double halo = 0);

  Rgb at(int x, int y) const;
  void blend(int x, int y, Rgb colour, double opacity);

 private:
  Picture& picture_;
};

/// How wide it is in pixels.
double text_width(std::string_view text, double size);
/// The text, or its beginning with an ellipsis, so that it is no wider.
std::string fitted_text(std::string_view text, double size, double width);

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
