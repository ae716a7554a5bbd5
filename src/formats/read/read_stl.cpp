// STL: triangles without connectivity, as text (any number of named solids) or as records of 50 bytes in single
// precision. The text keeps double precision.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "formats/containers/input.h"
#include "formats/containers/scanner.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

class AsciiStl {
 public:
  explicit AsciiStl(const Input& input) : input_(input), scan_(input) {}

  SurfaceFile read() {
    if (!read_in_ranges()) {
      // A facet without blanks to spare takes some eighty bytes.
      builder_.reserve_faces(input_.bytes.size() / 160);
      builder_.points.reserve(3 * (input_.bytes.size() / 160));
      read_solids(0);
    }
    return builder_.finish(input_, "ASCII STL", true, 0);
  }

 private:
  /// What one range of lines holds.
  struct Part {
    std::vector<Vec3> points;          ///< three for each facet
    std::vector<std::uint32_t> solid;  ///< per facet; 0: the one that goes on, 1: the first that begins here
    std::vector<std::string> names;    ///< of solids that begin here
    bool ends_inside = false;          ///< the last solid goes on
  };

  /// All by several threads; false, with nothing read, where anything is unusual.
  bool read_in_ranges() {
    if (!reads_in_ranges(input_.bytes)) return false;
    const std::vector<std::string_view> ranges = ranges_of_facets(input_.bytes);
    std::vector<Part> parts(ranges.size());
    const std::size_t odd = parallel_find(ranges.size(), [&](std::size_t r) {
      input_.context.check();
      return !read_part(ranges[r], r > 0, parts[r]);
    });
    if (odd < parts.size()) return false;
    for (std::size_t p = 0; p < parts.size(); ++p)
      if (parts[p].ends_inside != (p + 1 < parts.size())) return false;
    return join(parts);
  }

  /// All but the first begin with a facet.
  static std::vector<std::string_view> ranges_of_facets(std::string_view text) {
    std::vector<const char*> begins{text.data()};
    for (std::string_view range : line_ranges(text)) {
      if (range.data() == text.data()) continue;
      while (!range.empty() && !begins_with_facet(range)) {
        const std::size_t end = range.find('\n');
        range.remove_prefix(end == std::string_view::npos ? range.size() : end + 1);
      }
      if (!range.empty()) begins.push_back(range.data());
    }
    begins.push_back(text.data() + text.size());
    std::vector<std::string_view> ranges;
    for (std::size_t i = 0; i + 1 < begins.size(); ++i)
      ranges.emplace_back(begins[i], static_cast<std::size_t>(begins[i + 1] - begins[i]));
    return ranges;
  }

  static bool begins_with_facet(std::string_view line) {
    while (!line.empty() && is_blank(line.front()) && !is_line_end(line.front())) line.remove_prefix(1);
    return equal_ignoring_case(line.substr(0, 5), "facet") && line.size() > 5 && is_blank(line[5]);
  }

  bool read_part(std::string_view range, bool goes_on, Part& part) const {
    const Input input = input_of_range(input_, range);
    AsciiStl reader(input);
    reader.part_ = &part;
    try {
      if (goes_on) part.ends_inside = !reader.read_facets(0);
      reader.read_solids(1);
    } catch (const InputError&) {
      return false;
    }
    part.points = std::move(reader.builder_.points);
    part.names = std::move(reader.builder_.patch_names);
    return part.points.size() == 3 * part.solid.size();
  }

  bool join(std::vector<Part>& parts) {
    std::vector<std::size_t> first{0};
    std::vector<std::uint32_t> first_solid;
    for (Part& part : parts) {
      first.push_back(first.back() + part.solid.size());
      first_solid.push_back(static_cast<std::uint32_t>(builder_.patch_names.size()));
      for (std::string& name : part.names) builder_.patch_names.push_back(std::move(name));
    }
    const std::size_t facets = first.back();
    if (facets >= kNone / 3) return false;
    builder_.points.resize(3 * facets);
    std::vector<Triangle> triangles(facets);
    std::vector<std::uint32_t> patch(facets);
    parallel_for(parts.size(), [&](std::size_t p) {
      std::ranges::copy(parts[p].points, builder_.points.begin() + static_cast<std::ptrdiff_t>(3 * first[p]));
      for (std::size_t t = first[p]; t < first[p + 1]; ++t) {
        patch[t] = first_solid[p] + parts[p].solid[t - first[p]] - 1;
        const auto corner = static_cast<VertexIndex>(3 * t);
        triangles[t] = {corner, corner + 1, corner + 2};
      }
    });
    if (parallel_find(facets, [&](std::size_t t) { return patch[t] != 0; }) == facets) patch.clear();
    builder_.set_triangles(std::move(triangles), std::move(patch));
    return true;
  }

  void expect(std::string_view word, std::string_view where) {
    if (equal_ignoring_case(scan_.peek_word(), word)) {
      scan_.word();
    } else {
      scan_.fail_expected(fmt::format("\"{}\" {}", word, where));
    }
  }

  void read_solids(std::uint32_t solid) {
    for (; !scan_.at_end(); ++solid) {
      expect("solid", "at the begin of a part");
      builder_.patch_names.emplace_back(solid_name());
      const bool ended = read_facets(solid);
      if (part_) part_->ends_inside = !ended;
    }
  }

  /// Up to the end of the solid; false if the range ends before.
  bool read_facets(std::uint32_t solid) {
    for (;;) {
      const std::string_view word = scan_.peek_word();
      if (equal_ignoring_case(word, "facet")) {
        read_facet(solid);
      } else if (equal_ignoring_case(word, "endsolid")) {
        scan_.word();
        scan_.skip_line();
        return true;
      } else if (equal_ignoring_case(word, "end")) {
        scan_.word();
        expect("solid", "behind \"end\"");
        scan_.skip_line();
        return true;
      } else if (equal_ignoring_case(word, "color")) {
        scan_.skip_line();  // of some CAD programs
      } else if (part_ && word.empty()) {
        return false;
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
      builder_.points.push_back(scan_.point());
    }
    if (corners_.size() < 3) scan_.fail_expected(fmt::format("\"vertex\" number {} of a facet", corners_.size() + 1));
    expect("endloop", "behind the corners of a facet");
    expect("endfacet", "behind \"endloop\"");
    if (part_) {
      part_->solid.push_back(solid);
    } else {
      builder_.add_face(corners_, at, solid);
    }
  }

  const Input& input_;
  Scanner scan_;
  SurfaceBuilder builder_;
  std::vector<std::uint32_t> corners_;
  Part* part_ = nullptr;  ///< what a range of lines comes to; null: all is read
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
