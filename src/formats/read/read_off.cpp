// OFF of Geomview: a keyword that says what follows each vertex, three counts, vertices, faces as index lists. In the
// wild the third count or the keyword may be missing, and colours appear without being announced.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "formats/containers/input.h"
#include "formats/containers/scanner.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <charconv>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// What ends a vertex or a face: the end of its line (whatever else stands there, colours mostly, is passed over), or
/// just its last number.
enum class Layout { kByLine, kFree };

class Off {
 public:
  Off(const Input& input, Layout layout) : input_(input), scan_(input, '#'), layout_(layout) {}

  SurfaceFile read() {
    read_keyword();
    read_counts();
    if (layout_ != Layout::kByLine || !read_in_ranges()) {
      read_vertices();
      read_faces();
    }
    return builder_.finish(input_, keyword_, true, 0);
  }

  /// Plain OFF, where nothing stands on a line but what is asked for, may be laid out freely.
  bool is_plain() const { return keyword_ == "OFF"; }

 private:
  void read_keyword() {
    if (input_.bytes.starts_with("\xef\xbb\xbf")) scan_.set_position(input_.bytes.data() + 3);
    const std::string_view first = scan_.peek_word();
    const std::size_t off = first.find("OFF");
    if (off == std::string_view::npos) {
      if (first == "off") scan_.word();
      return;
    }
    keyword_ = first.substr(0, off + 3);
    if (keyword_.find('4') != std::string::npos || keyword_.find('n') != std::string::npos)
      scan_.fail(fmt::format("{} holds points of more than three dimensions; export plain OFF", keyword_));
    scan_.at_end();
    scan_.set_position(scan_.position() + off + 3);
    if (equal_ignoring_case(scan_.peek_word(), "binary"))
      scan_.fail("binary OFF is not read here; export it as text, or as PLY");
  }

  void read_counts() {
    vertices_ = count("the number of vertices");
    counts_at_ = scan_.position();
    faces_ = count("the number of faces");
    if (!scan_.at_line_end()) scan_.integer("the number of edges");
  }

  std::uint64_t count(std::string_view what) {
    scan_.at_end();
    const char* const at = scan_.position();
    const std::int64_t n = scan_.integer(what);
    if (n < 0) input_.fail_at_line(at, fmt::format("expected {}, found {}; the file is damaged", what, n));
    return static_cast<std::uint64_t>(n);
  }

  /// Vertices and triangles by several threads; false, with nothing read, where not each has a line of its own.
  bool read_in_ranges() {
    const std::string_view text{scan_.position(), scan_.bytes_left()};
    if (!reads_in_ranges(text)) return false;
    check_claim(input_, counts_at_, {vertices_, 6, "vertices"}, scan_.bytes_left());
    check_claim(input_, counts_at_, {faces_, 2, "faces"}, scan_.bytes_left());
    const std::vector<std::string_view> ranges = line_ranges(text);
    std::vector<std::uint64_t> first(ranges.size());
    parallel_for(ranges.size(),
                 [&](std::size_t r) { for_each_line(ranges[r], [&](Scanner&) { return ++first[r], true; }); });
    std::uint64_t lines = 0;
    for (std::uint64_t& of_range : first) lines += std::exchange(of_range, lines);
    if (lines < vertices_ + faces_) return false;
    std::vector<Vec3> points(vertices_);
    std::vector<Triangle> triangles(faces_);
    const std::size_t odd = parallel_find(ranges.size(), [&](std::size_t r) {
      input_.context.check();
      std::uint64_t line = first[r];
      return !for_each_line(ranges[r], [&](Scanner& at) {
        const std::uint64_t i = line++;
        if (i < vertices_) return read_point(at, points[i]);
        return i >= vertices_ + faces_ || read_triangle(at, triangles[i - vertices_]);
      });
    });
    if (odd < ranges.size()) return false;
    builder_.points = std::move(points);
    builder_.set_triangles(std::move(triangles));
    return true;
  }

  /// Calls visit(scanner) at the begin of each line that says anything, as long as it returns true.
  template <class Visit>
  bool for_each_line(std::string_view range, const Visit& visit) const {
    const Input part = input_of_range(input_, range);
    for (Scanner at(part, '#'); !at.at_end(); at.skip_line())
      if (!visit(at)) return false;
    return true;
  }

  static bool read_point(Scanner& at, Vec3& point) {
    for (int axis = 0; axis < 3; ++axis)
      if (at.at_line_end() || !parse_number(at.word(), point[axis]) || !std::isfinite(point[axis])) return false;
    return true;
  }

  bool read_triangle(Scanner& at, Triangle& triangle) const {
    if (at.word() != "3") return false;
    for (VertexIndex& corner : triangle) {
      if (at.at_line_end()) return false;
      const std::string_view word = at.word();
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), corner);
      if (error != std::errc() || stop != word.data() + word.size() || corner >= vertices_) return false;
    }
    return true;
  }

  void read_vertices() {
    check_claim(input_, counts_at_, {vertices_, 6, "vertices"}, scan_.bytes_left());
    builder_.points.reserve(vertices_);
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      builder_.points.push_back(scan_.point());
      if (layout_ == Layout::kByLine) scan_.skip_line();
    }
  }

  void read_faces() {
    check_claim(input_, counts_at_, {faces_, 2, "faces"}, scan_.bytes_left());
    builder_.reserve_faces(faces_);
    for (std::uint64_t i = 0; i < faces_; ++i) {
      scan_.at_end();
      const char* const at = scan_.position();
      const std::uint64_t corners = count("the number of corners of a face");
      check_claim(input_, at, {corners, 2, "corners of a face"}, scan_.bytes_left());
      corners_.clear();
      for (std::uint64_t k = 0; k < corners; ++k) corners_.push_back(corner());
      builder_.add_face(corners_, at);
      if (layout_ == Layout::kByLine) scan_.skip_line();
    }
  }

  std::uint32_t corner() {
    const std::int64_t c = scan_.integer("the number of a vertex");
    if (c < 0 || static_cast<std::uint64_t>(c) >= vertices_)
      scan_.fail(
          fmt::format("face {} has the corner {}, but the file has only {} vertices (0 to {}); the file is "
                      "damaged: export it again",
                      builder_.faces(), c, vertices_, static_cast<std::int64_t>(vertices_) - 1));
    return static_cast<std::uint32_t>(c);
  }

  const Input& input_;
  Scanner scan_;
  Layout layout_;
  std::string keyword_ = "OFF";
  const char* counts_at_ = nullptr;
  std::uint64_t vertices_ = 0, faces_ = 0;
  SurfaceBuilder builder_;
  std::vector<std::uint32_t> corners_;
};

bool is_off_keyword(std::string_view word) {
  const std::size_t off = word.rfind("OFF");
  if (off == std::string_view::npos) return word == "off";
  // Some collections glue the first count to the keyword: "OFF8".
  const std::string_view before = word.substr(0, off), behind = word.substr(off + 3);
  return before.size() <= 6 && before.find_first_not_of("STCN4n") == std::string_view::npos &&
         behind.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

Told told_off(const FileHead& head) {
  if (is_off_keyword(head.first)) return Told::kKeyword;
  // The keyword may be missing.
  return !head.is_binary && head.ends_in({".off"}) && is_plain_number(head.first) ? Told::kLines : Told::kNot;
}

SurfaceFile read_off(const Input& input) {
  Off by_line(input, Layout::kByLine);
  try {
    return by_line.read();
  } catch (const InputError&) {
    if (!by_line.is_plain()) throw;
    try {
      return Off(input, Layout::kFree).read();
    } catch (const InputError&) {
      // The first complaint is about the layout that nearly all files have.
    }
    throw;
  }
}

}  // namespace octafront::io
