#include "canvas.h"

#include <octafront/error.h>
#include <octafront/io.h>

#ifdef OCTAFRONT_WITH_CAIRO
#include <numbers>
#include <string>

#include <cairo-svg.h>
#include <cairo.h>

namespace octafront::cli {

namespace {

constexpr double kPixelsPerPoint = 2;

void paint(cairo_surface_t* surface, double scale, const std::function<void(Canvas&)>& chart) {
  cairo_t* context = cairo_create(surface);
  cairo_scale(context, scale, scale);
  cairo_set_source_rgb(context, 1, 1, 1);
  cairo_paint(context);
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  Canvas canvas(context);
  chart(canvas);
  cairo_destroy(context);
}

/// Of cairo: adds bytes to the std::string behind `text`.
cairo_status_t append(void* text, const unsigned char* bytes, unsigned count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

void finish_picture(cairo_surface_t* surface, cairo_status_t status, const std::string& bytes,
                    const std::filesystem::path& file) {
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS) throw OutputError(file.string() + ": " + cairo_status_to_string(status));
  write_text(file, bytes);
}

}  // namespace

void Canvas::set(Colour colour) {
  cairo_set_source_rgb(context_, (colour >> 16 & 255) / 255.0, (colour >> 8 & 255) / 255.0, (colour & 255) / 255.0);
}

void Canvas::rectangle(double x, double y, double width, double height, Colour fill) {
  set(fill);
  cairo_rectangle(context_, x, y, width, height);
  cairo_fill(context_);
}

void Canvas::line(Point from, Point to, const Stroke& stroke) {
  set(stroke.colour);
  const double dashes[] = {4, 3};
  cairo_set_dash(context_, dashes, stroke.dashed ? 2 : 0, 0);
  cairo_set_line_width(context_, stroke.width);
  cairo_move_to(context_, from.x, from.y);
  cairo_line_to(context_, to.x, to.y);
  cairo_stroke(context_);
}

void Canvas::dot(double x, double y, double radius, Colour fill) {
  set(fill);
  cairo_new_sub_path(context_);
  cairo_arc(context_, x, y, radius, 0, 2 * std::numbers::pi);
  cairo_fill(context_);
}

double Canvas::width_of(const std::string& text, double size) {
  cairo_set_font_size(context_, size);
  cairo_text_extents_t extents;
  cairo_text_extents(context_, text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(Point at, const std::string& text, const TextStyle& style) {
  const auto& [size, align, colour, upward] = style;
  const double shift = align == Align::kLeft ? 0 : width_of(text, size) * (align == Align::kMiddle ? 0.5 : 1);
  set(colour);
  cairo_set_font_size(context_, size);
  cairo_save(context_);
  cairo_translate(context_, at.x, at.y);
  if (upward) cairo_rotate(context_, -std::numbers::pi / 2);
  cairo_move_to(context_, -shift, 0);
  cairo_show_text(context_, text.c_str());
  cairo_restore(context_);
}

bool can_draw() {
  return true;
}

void draw(const std::filesystem::path& stem, double width, double height, const std::function<void(Canvas&)>& chart) {
  const std::string svg = stem.string() + ".svg", png = stem.string() + ".png";
  std::string svg_bytes, png_bytes;
  cairo_surface_t* vector = cairo_svg_surface_create_for_stream(append, &svg_bytes, width, height);
  paint(vector, 1, chart);
  cairo_surface_finish(vector);
  finish_picture(vector, cairo_surface_status(vector), svg_bytes, svg);
  cairo_surface_t* pixels = cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(kPixelsPerPoint * width),
                                                       static_cast<int>(kPixelsPerPoint * height));
  paint(pixels, kPixelsPerPoint, chart);
  const cairo_status_t packed = cairo_surface_write_to_png_stream(pixels, append, &png_bytes);
  finish_picture(pixels, packed, png_bytes, png);
}

}  // namespace octafront::cli

#else

namespace octafront::cli {

void Canvas::set(Colour) {}
void Canvas::rectangle(double, double, double, double, Colour) {}
void Canvas::line(Point, Point, const Stroke&) {}
void Canvas::dot(double, double, double, Colour) {}
void Canvas::text(Point, const std::string&, const TextStyle&) {}
double Canvas::width_of(const std::string&, double) {
  return 0;
}
bool can_draw() {
  return false;
}
void draw(const std::filesystem::path&, double, double, const std::function<void(Canvas&)>&) {}

}  // namespace octafront::cli

#endif
