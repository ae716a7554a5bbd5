// STL: triangles without connectivity, as text (any number of named solids) or as records of 50 bytes in single
// precision. The text keeps double precision.

#include "base/core/parallel.h"
#include "formats/containers/scanner.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <cstring>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

class AsciiStl {
 public:
  explicit AsciiStl(const Input& input) : input_(input), scan_(input) {
    // A facet without blanks to spare takes some eighty bytes.
    builder_.reserve_faces(input.bytes.size() / 160);
    builder_.points.reserve(3 * (input.bytes.size() / 160));
  }

  SurfaceFile read() {
    std::uint32_t solid = 0;
    while (!scan_.at_end()) read_solid(solid++);
    return builder_.finish(input_, "ASCII STL", true, 0);
  }

 private:
  void expect(std::string_view word, std::string_view where) {
    if (equal_ignoring_case(scan_.peek_word(), word)) {
      scan_.word();
    } else {
      scan_.fail_expected(fmt::format("\"{}\" {}", word, where));
    }
  }

  void read_solid(std::uint32_t solid) {
    expect("solid", "at the begin of a part");
    builder_.patch_names.emplace_back(solid_name());
    for (;;) {
      const std::string_view word = scan_.peek_word();
      if (equal_ignoring_case(word, "facet")) {
        read_facet(solid);
      } else if (equal_ignoring_case(word, "endsolid")) {
        scan_.word();
        scan_.skip_line();
        return;
      } else if (equal_ignoring_case(word, "end")) {
        scan_.word();
        expect("solid", "behind \"end\"");
        scan_.skip_line();
        return;
      } else if (equal_ignoring_case(word, "color")) {
        scan_.skip_line();  // of some CAD programs
      } else {
        scan_.fail_expected("\"facet\" or \"endsolid\"");
      }
    }
  }

  /// The rest of the line; but all may stand on one line, and then it ends before "facet normal".
  std::string_view solid_name() {
    const char* const start = scan_.position();
    std::string_view line = scan_.rest_of_line();
    for (std::size_t i = line.find("facet"); i != std::string_view::npos; i = line.find("facet", i + 1)) {
      if (line.substr(i + 5).find("normal") == std::string_view::npos) break;
      scan_.set_position(line.data() + i);
      line = line.substr(0, i);
      while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
      return line;
    }
    if (line.empty() && scan_.position() == start) return {};
    return line;
  }

  void read_facet(std::uint32_t solid) {
    const char* const at = scan_.position();
    scan_.word();
    expect("normal", "behind \"facet\"");
    // Normals are often rough or not a number at all; they follow from the corners anyway.
    for (int i = 0; i < 3; ++i)
      if (scan_.word().empty()) scan_.fail_expected("a component of the normal");
    expect("outer", "in a facet");
    expect("loop", "behind \"outer\"");
    corners_.clear();
    while (equal_ignoring_case(scan_.peek_word(), "vertex")) {
      scan_.word();
      corners_.push_back(static_cast<std::uint32_t>(builder_.points.size()));
      const double x = scan_.number("a coordinate"), y = scan_.number("a coordinate"), z = scan_.number("a coordinate");
      builder_.points.push_back({x, y, z});
    }
    if (corners_.size() < 3) scan_.fail_expected(fmt::format("\"vertex\" number {} of a facet", corners_.size() + 1));
    expect("endloop", "behind the corners of a facet");
    expect("endfacet", "behind \"endloop\"");
    builder_.add_face(corners_, at, solid);
  }

  const Input& input_;
  Scanner scan_;
  SurfaceBuilder builder_;
  std::vector<std::uint32_t> corners_;
};

float little_endian_float(const char* p) {
  const auto at = [&](int i) { return std::uint32_t{static_cast<unsigned char>(p[i])}; };
  const std::uint32_t bits = at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::uint32_t little_endian_u32(const char* p) {
  const auto at = [&](int i) { return std::uint32_t{static_cast<unsigned char>(p[i])}; };
  return at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24;
}

constexpr std::size_t kHeader = 84, kRecord = 50;

SurfaceFile read_ascii_stl(const Input& input) {
  return AsciiStl(input).read();
}

SurfaceFile read_binary_stl(const Input& input) {
  const std::string_view bytes = input.bytes;
  if (bytes.size() < kHeader)
    input.fail(fmt::format(
        "is truncated: binary STL has a header of 84 bytes, the file only {}; copy or export it again", bytes.size()));
  const std::uint32_t count = little_endian_u32(bytes.data() + 80);
  const std::uint64_t wanted = kHeader + std::uint64_t{kRecord} * count;
  if (bytes.size() < wanted)
    input.fail(
        fmt::format("is truncated, or no binary STL: its header claims {} triangles, which take {} bytes, but the "
                    "file has {} (room for {} triangles); copy or export it again",
                    count, wanted, bytes.size(), (bytes.size() - kHeader) / kRecord));
  if (count >= kNone / 3) input.fail(fmt::format("holds {} triangles; {} are possible", count, kNone / 3 - 1));
  SurfaceBuilder builder;
  const auto corner_at = [&](std::size_t corner) {
    return bytes.data() + kHeader + kRecord * (corner / 3) + 12 + 12 * (corner % 3);
  };
  builder.points.resize(std::size_t{3} * count);
  std::vector<Triangle> triangles(count);
  const std::size_t bad = parallel_find(builder.points.size(), [&](std::size_t i) {
    const char* const p = corner_at(i);
    builder.points[i] = {little_endian_float(p), little_endian_float(p + 4), little_endian_float(p + 8)};
    triangles[i / 3][i % 3] = static_cast<std::uint32_t>(i);
    return !is_finite(builder.points[i]);
  });
  input.context.check();
  if (bad < builder.points.size()) {
    const Vec3& v = builder.points[bad];
    input.fail_at_byte(corner_at(bad),
                       fmt::format("corner {} of triangle {} is ({}, {}, {}), not a point; repair the model where it "
                                   "was made",
                                   bad % 3, bad / 3, v.x, v.y, v.z));
  }
  builder.set_triangles(std::move(triangles));
  if (bytes.size() > wanted)
    builder.notes.push_back(fmt::format("{} bytes behind the last triangle ignored", bytes.size() - wanted));
  return builder.finish(input, "binary STL", false, 0);
}

}  // namespace

Told told_stl(const FileHead& head) {
  // Before words: many binary files begin with "solid" all the same.
  if (is_binary_stl(head.input.bytes, head.input.bytes.size())) return Told::kMagic;
  const bool is_solid = equal_ignoring_case(head.first, "solid");
  if (!head.is_binary) return is_solid ? Told::kKeyword : Told::kNot;
  // Of a wrong size: the reader says what is missing, or that bytes follow.
  return is_solid || head.ends_in({".stl"}) ? Told::kLines : Told::kNot;
}

SurfaceFile read_stl(const Input& input) {
  const bool is_binary = is_binary_stl(input.bytes, input.bytes.size()) || looks_binary(input.bytes);
  return is_binary ? read_binary_stl(input) : read_ascii_stl(input);
}

}  // namespace octafront::io
