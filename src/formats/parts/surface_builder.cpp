#include "formats/parts/surface_builder.h"

#include "base/core/wording.h"
#include "formats/parts/polygon.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

[[noreturn]] void fail_at(const Input& input, bool is_text, const char* at, std::string_view message) {
  if (is_text) input.fail_at_line(at, message);
  input.fail_at_byte(at, message);
}

}  // namespace

void check_claim(const Input& input, const char* at, const Claim& claim, std::uint64_t bytes_left) {
  const auto& [count, bytes_each, what] = claim;
  // One more byte, since the last record of a text may lack the blank behind it.
  const std::uint64_t room = bytes_each == 0 ? kNone : (bytes_left + 1) / bytes_each;
  if (count <= room && count < kNone) return;
  if (count >= kNone)
    input.fail_at_byte(at, fmt::format("claims {} {}; more than {} are not possible", count, what, kNone - 1));
  input.fail_at_byte(at, fmt::format("claims {} {}, but the {} bytes behind hold {} at most: the file is truncated or "
                                     "damaged; copy or export it again",
                                     count, what, bytes_left, room));
}

std::uint64_t read_count(Scanner& scan, const Input& input, std::string_view what, std::uint64_t least_bytes) {
  return read_count(scan, input, fmt::format("the number of {}", what), what, least_bytes);
}

std::uint64_t read_count(Scanner& scan, const Input& input, std::string_view expected, std::string_view what,
                         std::uint64_t least_bytes) {
  scan.at_end();
  const char* const at = scan.position();
  const std::int64_t n = scan.integer(expected);
  if (n < 0) scan.fail(fmt::format("{} {}; the file is damaged", n, what));
  check_claim(input, at, {static_cast<std::uint64_t>(n), least_bytes, what}, scan.bytes_left());
  return static_cast<std::uint64_t>(n);
}

void SurfaceBuilder::reserve_faces(std::size_t count) {
  triangles_.reserve(count);
  face_of_triangle_.reserve(count);
}

void SurfaceBuilder::set_triangles(std::vector<Triangle> triangles, std::vector<std::uint32_t> patch) {
  faces_ = triangles.size();
  face_of_triangle_.resize(triangles.size());
  std::iota(face_of_triangle_.begin(), face_of_triangle_.end(), 0u);
  triangles_ = std::move(triangles);
  patch_ = std::move(patch);
}

void SurfaceBuilder::add_triangle(const Triangle& t, std::uint32_t face, std::uint32_t patch) {
  if (patch != 0 && patch_.empty()) patch_.assign(triangles_.size(), 0);
  if (patch != 0 || !patch_.empty()) patch_.push_back(patch);
  triangles_.push_back(t);
  face_of_triangle_.push_back(face);
}

void SurfaceBuilder::add_face(std::span<const std::uint32_t> corners, const char* at, std::uint32_t patch) {
  const auto face = static_cast<std::uint32_t>(faces_++);
  for (const std::uint32_t c : corners) {
    if (largest_corner_at_ != nullptr && c <= largest_corner_) continue;
    largest_corner_ = c;
    largest_corner_face_ = face;
    largest_corner_at_ = at;
  }
  if (corners.size() == 3) {
    add_triangle({corners[0], corners[1], corners[2]}, face, patch);
  } else if (corners.size() < 3) {
    ++small_faces_;
  } else {
    polygons_.push_back(
        {polygon_corners_.size(), triangles_.size(), face, patch, static_cast<std::uint32_t>(corners.size()), at});
    polygon_corners_.insert(polygon_corners_.end(), corners.begin(), corners.end());
  }
}

void SurfaceBuilder::add_face(std::span<const std::uint32_t> corners, const char* at, std::uint32_t patch,
                              Sides sides) {
  sides_of_face_.push_back(sides);
  add_face(corners, at, patch);
}

void SurfaceBuilder::check_corners(const Input& input, bool is_text, int first_index) const {
  if (largest_corner_at_ == nullptr || largest_corner_ < points.size()) return;
  fail_at(input, is_text, largest_corner_at_,
          fmt::format("face {} has the corner {}, but the file has only {} vertices ({} to {}); the file is damaged: "
                      "export it again",
                      largest_corner_face_, std::uint64_t{largest_corner_} + static_cast<unsigned>(first_index),
                      points.size(), first_index, static_cast<std::int64_t>(points.size()) - 1 + first_index));
}

bool SurfaceBuilder::divide(const Polygon& polygon, SurfaceBuilder& divided, const Input& input, bool is_text) {
  const std::span<const std::uint32_t> corners{polygon_corners_.data() + polygon.first_corner, polygon.corners};
  std::vector<Vec3> places;
  places.reserve(corners.size());
  for (const std::uint32_t c : corners) places.push_back(points[c]);
  if (places.size() > kMostPolygonCorners && !fans_out(places))
    fail_at(input, is_text, polygon.at,
            fmt::format("face {} is a polygon of {} corners that is not convex; divide it into triangles in the "
                        "program that made it",
                        polygon.face, corners.size()));
  std::vector<std::array<std::uint32_t, 3>> pieces;
  const bool simple = triangulate_polygon(places, pieces, input.context);
  for (const auto& [a, b, c] : pieces)
    divided.add_triangle({corners[a], corners[b], corners[c]}, polygon.face, polygon.patch);
  return simple;
}

void SurfaceBuilder::divide_polygons(const Input& input, bool is_text) {
  if (polygons_.empty()) return;
  SurfaceBuilder divided;
  divided.reserve_faces(triangles_.size() + polygon_corners_.size() - 2 * polygons_.size());
  std::size_t copied = 0;
  std::uint64_t crossing = 0;
  std::uint32_t first_crossing = 0;
  const auto copy_up_to = [&](std::size_t end) {
    for (; copied < end; ++copied)
      divided.add_triangle(triangles_[copied], face_of_triangle_[copied], patch_.empty() ? 0 : patch_[copied]);
  };
  for (const Polygon& polygon : polygons_) {
    if ((&polygon - polygons_.data()) % 4096 == 0) input.context.check();
    copy_up_to(polygon.triangles_before);
    if (!divide(polygon, divided, input, is_text) && crossing++ == 0) first_crossing = polygon.face;
  }
  copy_up_to(triangles_.size());
  notes.push_back(counted(polygons_.size(), "polygon") + " divided into triangles");
  if (crossing > 0)
    notes.push_back(fmt::format("{} with crossing sides (the first is face {}); the triangles there overlap",
                                counted(crossing, "polygon"), first_crossing));
  triangles_ = std::move(divided.triangles_);
  face_of_triangle_ = std::move(divided.face_of_triangle_);
  patch_ = std::move(divided.patch_);
}

SurfaceFile SurfaceBuilder::finish(const Input& input, std::string format, bool is_text, int first_index) {
  if (points.size() >= kNone || faces_ >= kNone)
    input.fail(fmt::format("holds more than {} vertices or faces", kNone - 1));
  check_corners(input, is_text, first_index);
  divide_polygons(input, is_text);
  if (small_faces_ > 0) notes.push_back(counted(small_faces_, "face") + " with fewer than three corners left out");
  if (triangles_.empty())
    input.fail(
        fmt::format("holds no triangles ({}, {} vertices): there is no surface to mesh; export the surface, not "
                    "only its points or lines",
                    format, points.size()));
  SurfaceFile file;
  file.surface.points = std::move(points);
  file.surface.triangles = std::move(triangles_);
  file.surface.patch = std::move(patch_);
  file.surface.patch_names = std::move(patch_names);
  file.surface.region_names = std::move(region_names);
  if (!sides_of_face_.empty())
    for (const std::uint32_t face : face_of_triangle_) file.surface.sides.push_back(sides_of_face_[face]);
  if (!polygons_.empty() || small_faces_ > 0) file.surface.source = std::move(face_of_triangle_);
  file.format = std::move(format);
  file.notes = std::move(notes);
  return file;
}

}  // namespace octafront::io
