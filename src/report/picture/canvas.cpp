
#include "report/picture/canvas.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

constexpr Rgb kWhite{255, 255, 255};

double squared_distance(Pixel p, Pixel a, Pixel b) {
  const double dx = b.x - a.x, dy = b.y - a.y, along = dx * dx + dy * dy;
  const double t = along > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / along, 0.0, 1.0) : 0;
  const double x = p.x - a.x - t * dx, y = p.y - a.y - t * dy;
  return x * x + y * y;
}

/// How much of each pixel of a part of the picture lines cover: where they overlap, as much as one of them.
class Cover {
 public:
  Cover(const Rectangle& around, int width, int height)
      : x0_(bounded(std::floor(around.x0), width)),
        y0_(bounded(std::floor(around.y0), height)),
        x1_(bounded(std::ceil(around.x1) + 1, width)),
        y1_(bounded(std::ceil(around.y1) + 1, height)),
        share_(static_cast<std::size_t>(std::max(0, x1_ - x0_)) * static_cast<std::size_t>(std::max(0, y1_ - y0_))) {}

  void add(Pixel a, Pixel b, double width) {
    const double reach = width / 2 + 0.5;
    const int left = std::max(x0_, bounded(std::floor(std::min(a.x, b.x) - reach), x1_));
    const int right = std::min(x1_, bounded(std::ceil(std::max(a.x, b.x) + reach) + 1, x1_));
    const int top = std::max(y0_, bounded(std::floor(std::min(a.y, b.y) - reach), y1_));
    const int bottom = std::min(y1_, bounded(std::ceil(std::max(a.y, b.y) + reach) + 1, y1_));
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const double apart = std::sqrt(squared_distance({x + 0.5, y + 0.5}, a, b));
        float& share = share_[place(x, y)];
        share = std::max(share, static_cast<float>(std::clamp(reach - apart, 0.0, std::min(1.0, width))));
      }
  }
  void paint(Canvas& canvas, Rgb colour, double opacity) const {
    for (int y = y0_; y < y1_; ++y)
      for (int x = x0_; x < x1_; ++x)
        if (const float share = share_[place(x, y)]; share > 0) canvas.blend(x, y, colour, opacity * share);
  }

 private:
  static int bounded(double value, int most) { return static_cast<int>(std::clamp(value, 0.0, 1.0 * most)); }
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y - y0_) * static_cast<std::size_t>(x1_ - x0_) + static_cast<std::size_t>(x - x0_);
  }

  int x0_, y0_, x1_, y1_;
  std::vector<float> share_;
};

Rectangle around(std::span<const std::vector<Pixel>> polygons, double reach) {
  Rectangle box{HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const auto& polygon : polygons)
    for (const Pixel p : polygon)
      box = {std::min(box.x0, p.x - reach), std::min(box.y0, p.y - reach), std::max(box.x1, p.x + reach),
             std::max(box.y1, p.y + reach)};
  return box;
}

}  // namespace

Rgb Canvas::at(int x, int y) const {
  const std::uint8_t* p =
      &picture_
           .pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(x))];
  return {p[0], p[1], p[2]};
}

void Canvas::blend(int x, int y, Rgb colour, double opacity) {
  const Rgb made = mixed(at(x, y), colour, std::clamp(opacity, 0.0, 1.0));
  std::uint8_t* p =
      &picture_
           .pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width()) + static_cast<std::size_t>(x))];
  p[0] = made.r, p[1] = made.g, p[2] = made.b;
}

void Canvas::lines(std::span<const std::vector<Pixel>> polygons, const Ink& ink) {
  const auto draw = [&](double width, Rgb colour, double opacity) {
    Cover cover(around(polygons, width / 2 + 1), this->width(), height());
    for (const auto& polygon : polygons)
      for (std::size_t i = 0; i + 1 < polygon.size() || i == 0; ++i)
        cover.add(polygon[i], polygon[std::min(i + 1, polygon.size() - 1)], width);
    cover.paint(*this, colour, opacity);
  };
  if (ink.halo > 0) draw(ink.width + 2 * ink.halo, kWhite, 0.85);
  draw(ink.width, ink.colour, ink.opacity);
}

void Canvas::line(Pixel a, Pixel b, const Ink& ink) {
  const std::vector<Pixel> polygon{a, b};
  lines({&polygon, 1}, ink);
}

void Canvas::circle(Pixel middle, double radius, const Ink& ink) {
  // Corners of a dodecagon in the first quadrant, and so on around: by halving angles.
  constexpr int kTurns = 48;
  const double c = std::sqrt((2 + std::sqrt(2 + std::sqrt(3.0))) / 4);  // cosine of 7.5 degrees
  const double s = std::sqrt(1 - c * c);
  std::vector<Pixel> polygon{{middle.x + radius, middle.y}};
  double x = radius, y = 0;
  for (int i = 0; i < kTurns; ++i) {
    const double turned = c * x - s * y;
    y = s * x + c * y, x = turned;
    polygon.push_back({middle.x + x, middle.y + y});
  }
  lines({&polygon, 1}, ink);
}

void Canvas::fill(const Rectangle& where, Rgb colour, double opacity) {
  const int left = std::max(0, static_cast<int>(where.x0)), top = std::max(0, static_cast<int>(where.y0));
  const int right = std::min(width(), static_cast<int>(where.x1)),
            bottom = std::min(height(), static_cast<int>(where.y1));
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) blend(x, y, colour, opacity);
}

void Canvas::frame(const Rectangle& r, const Ink& ink) {
  const std::vector<Pixel> polygon{{r.x0, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}, {r.x0, r.y0}};
  lines({&polygon, 1}, ink);
}

void Canvas::text(Pixel at, double size, std::string_view text, Rgb colour, double halo) {
  std::vector<std::vector<Pixel>> polygons;
  for (const stroke_font::Stroke& stroke : stroke_font::strokes_of(text)) {
    std::vector<Pixel>& polygon = polygons.emplace_back();
    for (const auto& [x, y] : stroke) polygon.push_back({at.x + size * x, at.y - size * y});
  }
  if (!polygons.empty()) lines(polygons, {colour, std::max(1.0, 0.13 * size), halo});
}

double text_width(std::string_view text, double size) {
  return size * stroke_font::width_of(text);
}

std::string fitted_text(std::string_view text, double size, double width) {
  constexpr std::string_view kEllipsis = "\xe2\x80\xa6";
  if (text_width(text, size) <= width) return std::string(text);
  std::string made(text);
  while (!made.empty() && text_width(made + std::string(kEllipsis), size) > width) {
    // A letter of several bytes goes as a whole.
    while (made.size() > 1 && (static_cast<unsigned char>(made.back()) & 0xc0) == 0x80) made.pop_back();
    made.pop_back();
  }
  return made + std::string(kEllipsis);
}

}  // namespace octafront
