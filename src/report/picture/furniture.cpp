#include "report/picture/furniture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

double widest_text(const Legend& legend, double size) {
  double widest = text_width(legend.title, size);
  for (const auto& [at, text] : legend.ticks) widest = std::max(widest, text_width(text, size) + 4 * size);
  for (const auto& [text, colour] : legend.swatches) widest = std::max(widest, text_width(text, size) + 2.2 * size);
  return widest;
}

void draw_bar(Canvas& canvas, const Layout& layout, const Legend& legend, const Rectangle& bar) {
  const double text = layout.text;
  for (int y = static_cast<int>(bar.y0); y < static_cast<int>(bar.y1); ++y) {
    const double at = (bar.y1 - y) / bar.height() * static_cast<double>(legend.bar.size() - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(at), legend.bar.size() - 2);
    canvas.fill({bar.x0, 1.0 * y, bar.x1, y + 1.0},
                mixed(legend.bar[k], legend.bar[k + 1], at - static_cast<double>(k)));
  }
  canvas.frame(bar, {kInk, 1, 0, 0.5});
  for (const auto& [at, words] : legend.ticks) {
    const double y = bar.y1 - at * bar.height();
    canvas.line({bar.x1, y}, {bar.x1 + 0.35 * text, y}, {kInk, 1});
    canvas.text({bar.x1 + 0.7 * text, y + 0.45 * text}, 0.9 * text, words, kInk);
  }
}

/// How many elements there are of each value, to the left of the bar.
void draw_counts(Canvas& canvas, const Legend& legend, const Rectangle& bar, double width) {
  const std::uint64_t most = legend.counts.empty() ? 0 : *std::ranges::max_element(legend.counts);
  const double step = bar.height() / static_cast<double>(std::max<std::size_t>(1, legend.counts.size()));
  for (std::size_t k = 0; most > 0 && k < legend.counts.size(); ++k) {
    if (legend.counts[k] == 0) continue;
    const double share = static_cast<double>(legend.counts[k]) / static_cast<double>(most);
    const double y = bar.y1 - step * static_cast<double>(k);
    // Even a single one is seen.
    canvas.fill({bar.x0 - 2 - std::max(1.0, width * share), y - step, bar.x0 - 2, y}, kSoftInk, 0.75);
  }
}

/// 1, 2 or 5 and zeros, and no more than that.
double round_length(double most) {
  double power = 1;
  while (power * 10 <= most) power *= 10;
  while (power > most) power /= 10;
  for (const double n : {5.0, 2.0})
    if (n * power <= most) return n * power;
  return power;
}

}  // namespace

Layout layout_for(int width, int height, const Legend& legend, std::size_t lines_of_caption, bool furniture) {
  Layout layout;
  layout.text = std::clamp(std::min(height / 72.0, width / 80.0), 6.0, 22.0);
  const double text = layout.text, margin = 1.5 * text;
  layout.window = {margin, margin, width - margin, height - margin};
  layout.picture = {0, 0, 1.0 * width, 1.0 * height};
  if (!furniture) return layout;
  layout.caption = {margin, height - margin - 1.9 * text * static_cast<double>(lines_of_caption), width - margin,
                    height - margin};
  const bool has_legend = !legend.bar.empty() || !legend.swatches.empty();
  const double across = has_legend ? std::min(0.3 * width, widest_text(legend, text) + 2 * text) : 0;
  layout.legend = {width - margin - across, margin, width - margin, layout.caption.y0 - text};
  layout.strip = {margin, layout.caption.y0 - 6.5 * text, layout.legend.x0 - margin, layout.caption.y0 - text};
  layout.window = {margin, margin, layout.legend.x0 - (has_legend ? margin : 0), layout.strip.y0 + 1.5 * text};
  layout.picture = {0, 0, layout.legend.x0 - (has_legend ? text : 0), layout.caption.y0 - 0.5 * text};
  return layout;
}

void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera) {
  struct Axis {
    Vec3 way;
    Rgb colour;
    const char* name;
  };
  std::array<Axis, 3> axes{{{{1, 0, 0}, {0xb3, 0x26, 0x1e}, "x"},
                            {{0, 1, 0}, {0x1b, 0x7a, 0x2f}, "y"},
                            {{0, 0, 1}, {0x1f, 0x4f, 0xc4}, "z"}}};
  // What points to the viewer is drawn last.
  std::ranges::stable_sort(axes, {}, [&](const Axis& a) { return dot(a.way, camera.back); });
  const double text = layout.text, length = 2.6 * text;
  const Pixel from{layout.strip.x0 + 3.2 * text, (layout.strip.y0 + layout.strip.y1) / 2};
  for (const Axis& axis : axes) {
    const double x = dot(axis.way, camera.right), y = -dot(axis.way, camera.up);
    canvas.line(from, {from.x + length * x, from.y + length * y}, {axis.colour, std::max(1.5, 0.17 * text), 1});
    canvas.text({from.x + (length + 0.8 * text) * x - 0.3 * text, from.y + (length + 0.8 * text) * y + 0.4 * text},
                text, axis.name, axis.colour, 1);
  }
}

void draw_scale_bar(Canvas& canvas, const Layout& layout, const Camera& camera, const std::string& unit) {
  const double text = layout.text, room = std::min(14 * text, 0.4 * layout.strip.width());
  if (!(camera.scale > 0) || !std::isfinite(room / camera.scale)) return;
  const double length = round_length(room / camera.scale), pixels = length * camera.scale;
  const Pixel right{layout.strip.x1, layout.strip.y1 - text};
  const std::vector<Pixel> bar{
      {right.x - pixels, right.y - 0.5 * text}, {right.x - pixels, right.y}, right, {right.x, right.y - 0.5 * text}};
  canvas.lines({&bar, 1}, {kInk, std::max(1.2, 0.12 * text), 1});
  const std::string words = fmt::format("{:g}{}{}", length, unit.empty() ? "" : " ", unit);
  canvas.text({right.x - pixels / 2 - text_width(words, text) / 2, right.y - 1.0 * text}, text, words, kInk, 2);
}

void draw_legend(Canvas& canvas, const Layout& layout, const Legend& legend) {
  const double text = layout.text, line = 2 * text;
  const Rectangle& room = layout.legend;
  if (room.width() <= 0) return;
  double y = room.y0 + text;
  if (!legend.title.empty()) canvas.text({room.x0, y}, text, fitted_text(legend.title, text, room.width()), kInk);
  y += text;
  if (!legend.bar.empty()) {
    const double left = room.x0 + (legend.counts.empty() ? 0 : 3 * text);
    const Rectangle bar{left, y + 0.5 * text, left + 1.4 * text,
                        y + 0.5 * text + std::min(22 * text, 0.6 * room.height())};
    draw_bar(canvas, layout, legend, bar);
    draw_counts(canvas, legend, bar, 2.8 * text);
    y = bar.y1 + line;
  }
  const double swatch = 1.2 * text;
  for (std::size_t k = 0; k < legend.swatches.size(); ++k, y += line) {
    const auto& [name, colour] = legend.swatches[k];
    const bool is_last = y + 2 * line > room.y1 && k + 1 < legend.swatches.size();
    const std::string words = is_last ? fmt::format("… {} more", legend.swatches.size() - k) : name;
    if (!is_last) {
      canvas.fill({room.x0, y, room.x0 + swatch, y + swatch}, colour);
      canvas.frame({room.x0, y, room.x0 + swatch, y + swatch}, {kInk, 1, 0, 0.4});
    }
    canvas.text({room.x0 + 1.8 * text, y + 1.1 * text}, text, fitted_text(words, text, room.width() - 1.8 * text),
                kInk);
    if (is_last) return;
  }
}

void draw_caption(Canvas& canvas, const Layout& layout, const std::vector<std::string>& lines) {
  double y = layout.caption.y0 + 1.4 * layout.text;
  for (const std::string& line : lines) {
    canvas.text({layout.caption.x0, y}, layout.text, fitted_text(line, layout.text, layout.caption.width()), kSoftInk);
    y += 1.9 * layout.text;
  }
}

namespace {

/// What is seen of a part.
struct SeenPart {
  std::uint32_t part = 0;
  std::uint64_t pixels = 0;
  double x = 0, y = 0;  ///< their middle
  Pixel anchor;         ///< of its pixels that nearest to the middle
};

std::vector<SeenPart> seen_parts(const Canvas& canvas, const Scene& scene, const std::vector<std::uint32_t>& faces) {
  std::vector<SeenPart> all(scene.part_names.size());
  const auto for_each_pixel = [&](const auto& visit) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (faces[i] == kNone || scene.faces[faces[i]].part >= all.size()) continue;
      const auto w = static_cast<std::size_t>(canvas.width());
      visit(all[scene.faces[faces[i]].part], static_cast<double>(i % w), static_cast<double>(i / w));
    }
  };
  for_each_pixel([](SeenPart& part, double x, double y) { ++part.pixels, part.x += x, part.y += y; });
  std::vector<double> least(all.size(), HUGE_VAL);
  for (std::size_t p = 0; p < all.size(); ++p) {
    all[p].part = static_cast<std::uint32_t>(p);
    if (all[p].pixels > 0)
      all[p].x /= static_cast<double>(all[p].pixels), all[p].y /= static_cast<double>(all[p].pixels);
  }
  for_each_pixel([&](SeenPart& part, double x, double y) {
    const double apart = (x - part.x) * (x - part.x) + (y - part.y) * (y - part.y);
    if (apart < least[part.part]) least[part.part] = apart, part.anchor = {x + 0.5, y + 0.5};
  });
  // Large ones first: where there is no room for all, these have names.
  std::ranges::stable_sort(all, [](const SeenPart& a, const SeenPart& b) { return a.pixels > b.pixels; });
  return all;
}

/// A place for a text near an anchor that meets no other; none: there is no room.
const Rectangle* place_near(Pixel anchor, double width, double size, const Rectangle& window,
                            std::vector<Rectangle>& taken) {
  constexpr std::array<Pixel, 8> kWays{{{0, 0}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}, {0, -1.4}, {0, 1.4}, {1.4, 0}}};
  const double half = width / 2 + 0.5 * size;
  for (const double away : {0.0, 2.2, 3.6, 5.2, 7.5, 10.0})
    for (const Pixel way : kWays) {
      if ((away > 0) != (way.x != 0 || way.y != 0)) continue;
      const Pixel at{anchor.x + way.x * (away * size + (away > 0 ? half : 0)), anchor.y + way.y * away * size};
      const Rectangle box{at.x - half, at.y - 1.1 * size, at.x + half, at.y + 1.1 * size};
      const bool is_inside = box.x0 >= window.x0 && box.y0 >= window.y0 && box.x1 <= window.x1 && box.y1 <= window.y1;
      if (!is_inside || std::ranges::any_of(taken, [&](const Rectangle& other) { return other.meets(box); })) continue;
      return &taken.emplace_back(box);
    }
  return nullptr;
}

}  // namespace

std::vector<std::string> draw_names(Canvas& canvas, const Layout& layout, const Scene& scene,
                                    const std::vector<std::uint32_t>& faces) {
  constexpr std::uint64_t kLeastSeen = 12;  // pixels
  const double size = 0.95 * layout.text;
  std::vector<std::string> left;
  std::vector<Rectangle> taken;
  const Rectangle room{2, 2, layout.legend.width() > 0 ? layout.legend.x0 : canvas.width() - 2.0, layout.strip.y1};
  for (const SeenPart& seen : seen_parts(canvas, scene, faces)) {
    const std::string& name = scene.part_names[seen.part];
    const std::string words = fitted_text(name, size, 0.4 * canvas.width());
    const Rectangle* box =
        seen.pixels < kLeastSeen ? nullptr : place_near(seen.anchor, text_width(words, size), size, room, taken);
    if (box == nullptr) {
      left.push_back(name);
      continue;
    }
    const Pixel middle{(box->x0 + box->x1) / 2, (box->y0 + box->y1) / 2};
    const bool is_beside = std::abs(middle.x - seen.anchor.x) + std::abs(middle.y - seen.anchor.y) > 1;
    if (is_beside) canvas.line(seen.anchor, middle, {kInk, 1.2, 1});
    if (is_beside) canvas.lines(std::array{std::vector<Pixel>{seen.anchor}}, {kInk, 4, 1});
    canvas.fill(*box, {255, 255, 255}, 0.82);
    canvas.frame(*box, {kInk, 1, 0, 0.35});
    canvas.text({box->x0 + 0.5 * size, middle.y + 0.5 * size}, size, words, kInk);
  }
  return left;
}

}  // namespace octafront
