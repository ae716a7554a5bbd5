// FreeSurfer's triangles (lh.pial, rh.white): a magic number of three bytes, a stamp of two lines, big-endian counts,
// coordinates in single precision, corners; and at the end, as text, where the volume lies whose middle the coordinates
// count from, with axes of their own. They are given in the scanner's space, as images are.

#include "base/core/doubles.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace octafront::io {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kTriangleMagic = "\xff\xff\xfe"sv;
constexpr std::size_t kVertexBytes = 12, kTriangleBytes = 12;

std::uint32_t big_endian_u32(const char* p) {
  const auto at = [&](int i) { return std::uint32_t{static_cast<unsigned char>(p[i])}; };
  return at(0) << 24 | at(1) << 16 | at(2) << 8 | at(3);
}

double big_endian_float(const char* p) {
  const std::uint32_t bits = big_endian_u32(p);
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// The axes of the volume that a surface was made of, and its middle.
struct VolumeFrame {
  Vec3 x, y, z, middle;
  /// Coordinates of a surface run left to right, back to front, low to high in a volume whose columns, rows and slices
  /// run right to left, high to low and back to front.
  Vec3 to_scanner(Vec3 p) const { return middle - x * p.x - y * p.z + z * p.y; }
};

/// Three numbers behind "key =" in the text at the end.
std::optional<Vec3> vector_named(std::string_view footer, std::string_view key) {
  const std::size_t at = footer.find(fmt::format("\n{}", key));
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view line = footer.substr(at + 1 + key.size());
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  line = line.substr(equals + 1);
  Vec3 v;
  for (int i = 0; i < 3; ++i) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const auto [end, error] = double_from_chars(line.data(), line.data() + line.size(), v[i]);
    if (error != std::errc() || !std::isfinite(v[i])) return std::nullopt;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  }
  return v;
}

std::optional<VolumeFrame> frame_in(std::string_view footer) {
  const auto x = vector_named(footer, "xras"), y = vector_named(footer, "yras"), z = vector_named(footer, "zras"),
             middle = vector_named(footer, "cras");
  const bool is_valid = footer.find("valid = 1") != std::string_view::npos;
  if (!is_valid || !x || !y || !z || !middle) return std::nullopt;
  return VolumeFrame{*x, *y, *z, *middle};
}

/// Behind the stamp, which ends with an empty line.
const char* behind_stamp(const Input& input) {
  std::size_t at = kTriangleMagic.size();
  for (int line = 0; line < 2; ++line) {
    at = input.bytes.find('\n', at);
    if (at == std::string_view::npos) input.fail("is truncated: its stamp does not end; copy it again");
    ++at;
  }
  return input.bytes.data() + at;
}

}  // namespace

Told told_freesurfer(const FileHead& head) {
  return head.input.bytes.starts_with(kTriangleMagic) ? Told::kMagic : Told::kNot;
}

SurfaceFile read_freesurfer(const Input& input) {
  const char *at = behind_stamp(input), *const end = input.bytes.data() + input.bytes.size();
  if (end - at < 8) input.fail_at_byte(at, "the counts of vertices and triangles are missing; copy the file again");
  const std::uint32_t vertices = big_endian_u32(at), triangles = big_endian_u32(at + 4);
  at += 8;
  const auto left = static_cast<std::uint64_t>(end - at);
  check_claim(input, at, {vertices, kVertexBytes, "vertices"}, left);
  check_claim(input, at, {triangles, kTriangleBytes, "triangles"}, left - kVertexBytes * std::uint64_t{vertices});
  const char* const first_triangle = at + kVertexBytes * std::size_t{vertices};
  const char* const footer = first_triangle + kTriangleBytes * std::size_t{triangles};
  const std::optional<VolumeFrame> frame = frame_in({footer, static_cast<std::size_t>(end - footer)});
  SurfaceBuilder builder;
  builder.points.reserve(vertices);
  builder.reserve_faces(triangles);
  ReadingProgress progress(input);
  for (; at < first_triangle; at += kVertexBytes) {
    progress.reach(at);
    const Vec3 p{big_endian_float(at), big_endian_float(at + 4), big_endian_float(at + 8)};
    if (!is_finite(p))
      input.fail_at_byte(at, fmt::format("vertex {} is ({}, {}, {}), not a point; make the surface again",
                                         builder.points.size(), p.x, p.y, p.z));
    builder.points.push_back(frame ? frame->to_scanner(p) : p);
  }
  for (; at < footer; at += kTriangleBytes) {
    progress.reach(at);
    builder.add_face(std::array{big_endian_u32(at), big_endian_u32(at + 4), big_endian_u32(at + 8)}, at);
  }
  builder.notes.push_back(frame ? "coordinates are those of the scanner, by the volume that the file names"
                                : "the file does not say where its volume lies: coordinates count from the volume's "
                                  "middle, and may not fit an image");
  return builder.finish(input, "FreeSurfer", false, 0);
}

}  // namespace octafront::io
