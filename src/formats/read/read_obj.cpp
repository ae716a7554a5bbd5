// Wavefront OBJ: vertices and polygons. Texture coordinates, normals, lines and free-form surfaces are passed over.
// Objects, groups and materials become patches: one for each combination that has faces.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "formats/containers/input.h"
#include "formats/containers/scanner.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using namespace std::string_view_literals;

class Obj {
 public:
  explicit Obj(const Input& input)
      : input_(input), progress_(input), at_(input.bytes.data()), end_(at_ + input.bytes.size()), line_start_(at_) {
    if (input.bytes.starts_with("\xef\xbb\xbf")) at_ += 3;
    builder_.points.reserve(input.bytes.size() / 80);
    builder_.reserve_faces(input.bytes.size() / 80);
  }

  /// Vertices and lines alone.
  LinesFile read_lines() {
    lines_only_ = true;
    read_all();
    return {std::move(builder_.points), std::move(edges_), "OBJ", {}};
  }

  SurfaceFile read() {
    if (!read_in_ranges()) read_all();
    if (free_form_ > 0)
      builder_.notes.push_back(fmt::format("{} free-form elements left out; only polygons are read", free_form_));
    SurfaceFile file = builder_.finish(input_, "OBJ", true, 1);
    // One nameless patch is no patch at all.
    if (file.surface.patch_names == std::vector<std::string>{""}) file.surface.patch_names.clear();
    return file;
  }

 private:
  /// A name that changes before a face.
  struct Renamed {
    std::size_t face;
    std::string Obj::*which;
    std::string name;
  };
  /// What one range of lines holds.
  struct Part {
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    std::vector<Renamed> names;
    std::uint64_t free_form = 0;
  };

  /// All by several threads; false, with nothing read, where a line goes on in the next one, a face is no triangle, or
  /// a corner is not counted from the begin.
  bool read_in_ranges() {
    const std::string_view text{at_, static_cast<std::size_t>(end_ - at_)};
    if (!reads_in_ranges(text)) return false;
    const std::vector<std::string_view> ranges = line_ranges(text);
    std::vector<Part> parts(ranges.size());
    const std::size_t odd = parallel_find(ranges.size(), [&](std::size_t r) {
      input_.context.check();
      return !read_part(ranges[r], parts[r]);
    });
    return odd == ranges.size() && join(parts);
  }

  bool read_part(std::string_view range, Part& part) const {
    if (range.find('\\') != std::string_view::npos) return false;
    const Input input = input_of_range(input_, range);
    Obj reader(input);
    reader.at_ = range.data();
    reader.part_ = &part;
    try {
      reader.read_all();
    } catch (const InputError&) {
      return false;
    }
    part.points = std::move(reader.builder_.points);
    part.free_form = reader.free_form_;
    return !reader.is_odd_;
  }

  bool join(std::vector<Part>& parts) {
    std::vector<std::size_t> first_point{0}, first_triangle{0};
    for (const Part& part : parts) {
      first_point.push_back(first_point.back() + part.points.size());
      first_triangle.push_back(first_triangle.back() + part.triangles.size());
    }
    const std::size_t points = first_point.back();
    const auto is_beyond = [points](const Triangle& t) { return std::max({t[0], t[1], t[2]}) >= points; };
    if (points >= kNone || first_triangle.back() >= kNone) return false;
    if (parallel_find(parts.size(), [&](std::size_t p) { return std::ranges::any_of(parts[p].triangles, is_beyond); }) <
        parts.size())
      return false;
    std::vector<std::uint32_t> patch = patches_of(parts, first_triangle);
    std::vector<Triangle> triangles(first_triangle.back());
    builder_.points.resize(points);
    parallel_for(parts.size(), [&](std::size_t p) {
      std::ranges::copy(parts[p].points, builder_.points.begin() + static_cast<std::ptrdiff_t>(first_point[p]));
      std::ranges::copy(parts[p].triangles, triangles.begin() + static_cast<std::ptrdiff_t>(first_triangle[p]));
    });
    for (const Part& part : parts) free_form_ += part.free_form;
    builder_.set_triangles(std::move(triangles), std::move(patch));
    return true;
  }

  /// Per triangle, or empty where all are in the first patch.
  std::vector<std::uint32_t> patches_of(const std::vector<Part>& parts, const std::vector<std::size_t>& first) {
    std::vector<std::uint32_t> patch;
    std::size_t next = 0;
    const auto fill_up_to = [&](std::size_t end) {
      if (next == end) return;
      const std::uint32_t current = current_patch();
      if (current != 0 && patch.empty()) patch.resize(first.back());
      if (!patch.empty())
        std::fill(patch.begin() + static_cast<std::ptrdiff_t>(next), patch.begin() + static_cast<std::ptrdiff_t>(end),
                  current);
      next = end;
    };
    for (std::size_t p = 0; p < parts.size(); ++p)
      for (const Renamed& renamed : parts[p].names) {
        fill_up_to(first[p] + renamed.face);
        this->*renamed.which = renamed.name;
        patch_is_current_ = false;
      }
    fill_up_to(first.back());
    return patch;
  }

  void read_all() {
    while (at_ != end_) {
      line_start_ = at_;
      progress_.reach(at_);
      read_line();
      skip_to_next_line();
    }
  }

  // A line goes on behind a backslash at its end. All words of a line are reached through these three functions.

  bool goes_on() const { return *at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1]); }
  /// To the last letter of the line end.
  void pass_line_end() {
    ++at_;
    if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
  }

  bool at_line_end() {
    for (; at_ != end_; ++at_) {
      if (goes_on()) {
        pass_line_end();
      } else if (is_line_end(*at_) || *at_ == '#') {
        return true;
      } else if (!is_blank(*at_)) {
        return false;
      }
    }
    return true;
  }

  std::string_view word() {
    if (at_line_end()) return {};
    const char* const start = at_;
    while (at_ != end_ && !is_blank(*at_) && !goes_on()) ++at_;
    return {start, static_cast<std::size_t>(at_ - start)};
  }

  void skip_to_next_line() {
    for (; at_ != end_; ++at_) {
      if (goes_on()) {
        pass_line_end();
      } else if (is_line_end(*at_)) {
        ++at_;
        return;
      }
    }
  }

  void read_line() {
    const std::string_view keyword = word();
    if (keyword == "v") {
      const double x = coordinate(), y = coordinate(), z = coordinate();
      builder_.points.push_back({x, y, z});
    } else if (lines_only_) {
      if (keyword == "l") read_polygon();
    } else if (keyword == "f" || keyword == "fo") {
      read_face();
    } else if (keyword == "o") {
      rename(&Obj::object_);
    } else if (keyword == "g") {
      rename(&Obj::group_);
    } else if (keyword == "usemtl") {
      rename(&Obj::material_);
    } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
      ++free_form_;
    }
  }

  double coordinate() {
    double value = 0;
    const std::string_view w = word();
    if (!w.empty()) {
      const auto [stop, error] = double_from_chars(w.data(), w.data() + w.size(), value);
      if ((error == std::errc() && stop == w.data() + w.size() && std::isfinite(value)) ||
          (parse_number(w, value) && std::isfinite(value)))
        return value;
    }
    if (w.empty()) input_.fail_at_line(line_start_, "expected a coordinate, but the line ends; export the file again");
    input_.fail_at_line(
        at_, fmt::format("expected a coordinate, found {}; repair the model where it was made", in_quotes(w)));
  }

  void read_face() {
    corners_.clear();
    for (std::string_view w = word(); !w.empty(); w = word()) corners_.push_back(corner(w));
    if (corners_.empty()) input_.fail_at_line(line_start_, "a face without corners; the file is damaged");
    if (part_ == nullptr) return builder_.add_face(corners_, line_start_, current_patch());
    is_odd_ = is_odd_ || corners_.size() != 3;
    if (!is_odd_) part_->triangles.push_back({corners_[0], corners_[1], corners_[2]});
  }

  void read_polygon() {
    std::uint32_t last = kNone;
    for (std::string_view w = word(); !w.empty(); w = word()) {
      const std::uint32_t next = corner(w);
      if (last != kNone) edges_.push_back({last, next});
      last = next;
    }
  }

  /// "7", "7/1", "7//3", "7/1/3"; negative counts back from the vertex read last.
  std::uint32_t corner(std::string_view w) {
    std::int64_t index = 0;
    const auto [stop, error] = std::from_chars(w.data(), w.data() + w.size(), index);
    if (error != std::errc() || (stop != w.data() + w.size() && *stop != '/') || index == 0)
      input_.fail_at_line(at_,
                          fmt::format("expected a corner such as 7 or 7/1/3, counted from 1, found {}; the file is "
                                      "damaged: export it again",
                                      in_quotes(w)));
    is_odd_ = is_odd_ || index < 0;
    const auto known = static_cast<std::int64_t>(builder_.points.size());
    if (index < -known || index >= std::int64_t{kNone})
      input_.fail_at_line(at_, fmt::format("the corner {} names a vertex that does not exist ({} are read so far); the "
                                           "file is damaged: export it again",
                                           in_quotes(w), known));
    // A vertex further down in the file is unusual, but allowed: checked when all are read.
    return static_cast<std::uint32_t>(index < 0 ? known + index : index - 1);
  }

  void rename(std::string Obj::*which) {
    std::string& name = this->*which;
    name.clear();
    for (std::string_view w = word(); !w.empty(); w = word()) {
      if (!name.empty()) name += ' ';
      name += w;
    }
    patch_is_current_ = false;
    if (part_ != nullptr) part_->names.push_back({part_->triangles.size(), which, name});
  }

  std::uint32_t current_patch() {
    if (patch_is_current_) return patch_;
    patch_is_current_ = true;
    const auto [found, is_new] = patches_.try_emplace({object_, group_, material_}, builder_.patch_names.size());
    if (is_new) builder_.patch_names.push_back(patch_name());
    return patch_ = static_cast<std::uint32_t>(found->second);
  }

  std::string patch_name() const {
    std::string name = object_;
    const auto append = [&name](const std::string& part) {
      if (!name.empty() && !part.empty()) name += '/';
      name += part;
    };
    if (group_ != object_) append(group_);
    if (material_ != object_ && material_ != group_) append(material_);
    return name;
  }

  const Input& input_;
  ReadingProgress progress_;
  const char* at_;
  const char* end_;
  const char* line_start_;
  SurfaceBuilder builder_;
  std::vector<std::uint32_t> corners_;
  std::string object_, group_, material_;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> patches_;
  std::uint32_t patch_ = 0;
  bool patch_is_current_ = false;
  std::uint64_t free_form_ = 0;
  bool lines_only_ = false;
  Part* part_ = nullptr;  ///< where a range of lines is read
  bool is_odd_ = false;   ///< a range cannot be read by itself
  std::vector<Edge> edges_;
};

bool is_obj_keyword(std::string_view word) {
  constexpr std::array kWords{"v"sv,      "vt"sv,  "vn"sv,     "vp"sv,     "f"sv,   "fo"sv,   "g"sv,
                              "o"sv,      "s"sv,   "usemtl"sv, "mtllib"sv, "l"sv,   "p"sv,    "mg"sv,
                              "cstype"sv, "deg"sv, "usemap"sv, "maplib"sv, "lod"sv, "bevel"sv};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

/// True if the first lines that are neither blank nor comments all begin with words of the format.
bool looks_like_obj(const Input& input) {
  Scanner scan(input, '#');
  int lines = 0;
  for (; lines < 16 && !scan.at_end(); ++lines) {
    if (!is_obj_keyword(scan.word())) return false;
    while (scan.rest_of_line().ends_with('\\')) scan.at_end();
  }
  return lines > 0;
}

}  // namespace

Told told_obj(const FileHead& head) {
  return !head.is_binary && looks_like_obj(head.input) ? Told::kKeyword : Told::kNot;
}

SurfaceFile read_obj(const Input& input) {
  return Obj(input).read();
}

LinesFile read_obj_lines(const Input& input) {
  return Obj(input).read_lines();
}

}  // namespace octafront::io
