// Wavefront OBJ: vertices and polygons. Texture coordinates, normals, lines and free-form surfaces are passed over.
// Objects, groups and materials become patches: one for each combination that has faces.

#include "formats/containers/scanner.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <map>
#include <string>
#include <tuple>

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
    read_all();
    if (free_form_ > 0)
      builder_.notes.push_back(fmt::format("{} free-form elements left out; only polygons are read", free_form_));
    SurfaceFile file = builder_.finish(input_, "OBJ", true, 1);
    // One nameless patch is no patch at all.
    if (file.surface.patch_names == std::vector<std::string>{""}) file.surface.patch_names.clear();
    return file;
  }

 private:
  void read_all() {
    while (at_ != end_) {
      line_start_ = at_;
      progress_.reach(at_);
      read_line();
      skip_to_next_line();
    }
  }

  // A line goes on behind a backslash at its end. All words of a line are reached through these three functions.

  bool at_line_end() {
    for (; at_ != end_; ++at_) {
      if (*at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1])) {
        ++at_;
        if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
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
    while (at_ != end_ && !is_blank(*at_) && !(*at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1]))) ++at_;
    return {start, static_cast<std::size_t>(at_ - start)};
  }

  void skip_to_next_line() {
    for (; at_ != end_; ++at_) {
      if (*at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1])) {
        ++at_;
        if (*at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n') ++at_;
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
      rename(object_);
    } else if (keyword == "g") {
      rename(group_);
    } else if (keyword == "usemtl") {
      rename(material_);
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
    builder_.add_face(corners_, line_start_, current_patch());
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
    const auto known = static_cast<std::int64_t>(builder_.points.size());
    if (index < -known || index >= std::int64_t{kNone})
      input_.fail_at_line(at_, fmt::format("the corner {} names a vertex that does not exist ({} are read so far); the "
                                           "file is damaged: export it again",
                                           in_quotes(w), known));
    // A vertex further down in the file is unusual, but allowed: checked when all are read.
    return static_cast<std::uint32_t>(index < 0 ? known + index : index - 1);
  }

  void rename(std::string& name) {
    name.clear();
    for (std::string_view w = word(); !w.empty(); w = word()) {
      if (!name.empty()) name += ' ';
      name += w;
    }
    patch_is_current_ = false;
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
