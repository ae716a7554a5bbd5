#pragma once

#include <filesystem>
#include <functional>
#include <string>

struct _cairo;

namespace octafront::cli {

/// Colours as 0xRRGGBB.
using Colour = unsigned;

/// A sheet to draw charts on, in points from the upper left corner. Requires the program to be built with cairo.
class Canvas {
 public:
  struct Point {
    double x, y;
  };
  struct Stroke {
    Colour colour;
    double width = 1;
    bool dashed = false;
  };
  enum class Align { kLeft, kMiddle, kRight };
  struct TextStyle {
    double size;
    Align align = Align::kLeft;
    Colour colour = 0x222222;
    bool upward = false;  ///< turned by a quarter to the left
  };

  explicit Canvas(_cairo* context) : context_(context) {}

  void rectangle(double x, double y, double width, double height, Colour fill);
  void line(Point from, Point to, const Stroke& stroke);
  void dot(double x, double y, double radius, Colour fill);
  /// The base line of the text runs through `at`.
  void text(Point at, const std::string& text, const TextStyle& style);
  double width_of(const std::string& text, double size);

 private:
  void set(Colour colour);
  _cairo* context_;
};

/// False if the program was built without cairo: then draw() does nothing.
bool can_draw();

/// Draws one chart twice: `stem`.svg and `stem`.png (twice the points in pixels), on white. Throws OutputError.
void draw(const std::filesystem::path& stem, double width, double height, const std::function<void(Canvas&)>& chart);

}  // namespace octafront::cli
