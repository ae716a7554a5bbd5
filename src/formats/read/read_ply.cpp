// PLY (Stanford polygon format): a header that declares elements and their properties, then their values as text or
// binary in either byte order. Any elements and properties may stand in any order; what is not needed is passed over.

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "formats/containers/input.h"
#include "formats/containers/scanner.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/ply_header.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is read as little endian, swapped where needed");

/// Values in text, one word each.
class TextValues {
 public:
  static constexpr bool kIsText = true;
  TextValues(const Input& input, const char* begin) : scan_(input) { scan_.set_position(begin); }

  const char* position() {
    scan_.at_end();
    return scan_.position();
  }
  std::size_t bytes_left() const { return scan_.bytes_left(); }
  double number(PlyType, std::string_view what) { return scan_.number(what); }
  std::int64_t integer(PlyType, std::string_view what) { return scan_.integer(what); }
  void skip(PlyType, std::uint64_t count) {
    for (; count > 0; --count)
      if (scan_.word().empty()) scan_.fail_expected("a value");
  }
  static std::uint64_t least_bytes(PlyType) { return 2; }

 private:
  Scanner scan_;
};

/// Binary values.
class BinaryValues {
 public:
  static constexpr bool kIsText = false;
  BinaryValues(const Input& input, const char* begin, bool swap)
      : input_(&input),
        progress_(input, begin),
        at_(begin),
        end_(input.bytes.data() + input.bytes.size()),
        swap_(swap) {}

  const char* position() const { return at_; }
  void set_position(const char* at) { at_ = at; }
  /// Another one that begins there and shows no progress: `quiet` is the same input without a context.
  BinaryValues from(const Input& quiet, const char* at) const { return BinaryValues(quiet, at, swap_); }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

  double number(PlyType type, std::string_view what) {
    const double value = type == PlyType::kFloat    ? get<float>(what)
                         : type == PlyType::kDouble ? get<double>(what)
                                                    : static_cast<double>(whole(type, what));
    if (!std::isfinite(value))
      input_->fail_at_byte(at_, fmt::format("expected {}, found {}; repair the model where it was made", what, value));
    return value;
  }

  std::int64_t integer(PlyType type, std::string_view what) {
    if (type != PlyType::kFloat && type != PlyType::kDouble) return whole(type, what);
    const double value = number(type, what);
    if (!(std::abs(value) < 9e15) || value != std::floor(value))
      input_->fail_at_byte(at_, fmt::format("expected {}, a whole number, found {}", what, value));
    return static_cast<std::int64_t>(value);
  }

  void skip(PlyType type, std::uint64_t count) {
    const std::uint64_t size = least_bytes(type);
    if (count > bytes_left() / size) fail_truncated("values");
    at_ += count * size;
  }

  static std::uint64_t least_bytes(PlyType type) { return ply_size(type); }

 private:
  std::int64_t whole(PlyType type, std::string_view what) {
    switch (type) {
      case PlyType::kInt8:
        return get<std::int8_t>(what);
      case PlyType::kUInt8:
        return get<std::uint8_t>(what);
      case PlyType::kInt16:
        return get<std::int16_t>(what);
      case PlyType::kUInt16:
        return get<std::uint16_t>(what);
      case PlyType::kInt32:
        return get<std::int32_t>(what);
      case PlyType::kUInt32:
        return get<std::uint32_t>(what);
      default:
        return get<std::int64_t>(what);
    }
  }

  template <class T>
  T get(std::string_view what) {
    if (bytes_left() < sizeof(T)) fail_truncated(what);
    progress_.reach(at_);
    char bytes[sizeof(T)];
    std::memcpy(bytes, at_, sizeof(T));
    if (swap_) std::reverse(bytes, bytes + sizeof(T));
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  [[noreturn]] void fail_truncated(std::string_view what) const {
    input_->fail_at_byte(
        at_, fmt::format("expected {}, but the file ends here; it is truncated: copy or export it again", what));
  }

  const Input* input_;
  ReadingProgress progress_;
  const char* at_;
  const char* end_;
  bool swap_;
};

template <class Values>
class PlyBody {
 public:
  PlyBody(const Input& input, const PlyHeader& header, Values values)
      : input_(input), header_(header), values_(std::move(values)) {}

  /// Vertices and edges alone.
  LinesFile read_lines() {
    LinesFile file;
    for (const PlyElement& element : header_.elements) {
      check_element(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "edge") {
        read_edges(element, file.edges);
      } else {
        skip_element(element);
      }
    }
    file.points = std::move(builder_.points);
    file.format = header_.format_name();
    return file;
  }

  SurfaceFile read() {
    builder_.patch_names = header_.patch_names;
    builder_.region_names = header_.region_names;
    for (const PlyElement& element : header_.elements) {
      check_element(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        skip_element(element);
      }
    }
    return builder_.finish(input_, std::string(header_.format_name()), Values::kIsText, 0);
  }

 private:
  void check_element(const PlyElement& element) {
    std::uint64_t bytes = 0;
    for (const PlyProperty& p : element.properties) bytes += Values::least_bytes(p.is_list ? p.count_type : p.type);
    // Elements without properties take no room in the file; they are passed over at no cost.
    if (bytes > 0)
      check_claim(input_, element.declared_at, {element.count, bytes, fmt::format("elements \"{}\"", element.name)},
                  values_.bytes_left());
  }

  std::uint64_t list_length(const PlyProperty& p) {
    const char* const at = values_.position();
    const std::int64_t n = values_.integer(p.count_type, "the length of a list");
    if (n < 0) input_.fail_at_byte(at, fmt::format("a list of length {}; the file is damaged: export it again", n));
    check_claim(input_, at, {static_cast<std::uint64_t>(n), Values::least_bytes(p.type), "values of a list"},
                values_.bytes_left());
    return static_cast<std::uint64_t>(n);
  }

  void skip_property(const PlyProperty& p) { values_.skip(p.type, p.is_list ? list_length(p) : 1); }

  void skip_element(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& p : element.properties) skip_property(p);
  }

  void read_vertices(const PlyElement& element) {
    constexpr std::string_view kAxes[] = {"x", "y", "z"};
    std::vector<int> axis_of;
    for (const PlyProperty& p : element.properties) {
      int axis = -1;
      for (int a = 0; a < 3; ++a)
        if (p.name == kAxes[a] && !p.is_list) axis = a;
      axis_of.push_back(axis);
    }
    for (int a = 0; a < 3; ++a)
      if (std::count(axis_of.begin(), axis_of.end(), a) != 1)
        input_.fail_at_line(
            element.declared_at,
            fmt::format("the vertices do not have one property \"{}\" each; export the file again", kAxes[a]));
    if (read_points_in_records(element, axis_of)) return;
    builder_.points.reserve(builder_.points.size() + element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Vec3 v;
      for (std::size_t k = 0; k < axis_of.size(); ++k) {
        if (axis_of[k] < 0) {
          skip_property(element.properties[k]);
        } else {
          v[axis_of[k]] = values_.number(element.properties[k].type, "a coordinate");
        }
      }
      builder_.points.push_back(v);
    }
  }

  /// Calls read(values, i) for all of an element, by several threads, where each takes `size` bytes; false, with
  /// nothing passed over, if one cannot be read so.
  template <class Read>
  bool read_records([[maybe_unused]] const PlyElement& element, [[maybe_unused]] std::uint64_t size,
                    [[maybe_unused]] const Read& read) {
    if constexpr (!Values::kIsText) {
      constexpr std::uint64_t kFewRecords = 1024;
      if (thread_count() == 1 || element.count < kFewRecords || element.count > values_.bytes_left() / size)
        return false;
      const Input quiet = input_of_range(input_, input_.bytes);
      const char* const first = values_.position();
      const auto is_odd = [&](std::size_t i) {
        try {
          Values values = values_.from(quiet, first + i * size);
          return !read(values, i);
        } catch (const InputError&) {
          return true;
        }
      };
      input_.context.check();
      if (parallel_find(element.count, is_odd) < element.count) return false;
      values_.set_position(first + element.count * size);
      return true;
    }
    return false;
  }

  bool read_points_in_records(const PlyElement& element, const std::vector<int>& axis_of) {
    const std::size_t first = builder_.points.size();
    std::uint64_t size = 0;
    for (const PlyProperty& p : element.properties) {
      if (p.is_list) return false;
      size += Values::least_bytes(p.type);
    }
    builder_.points.resize(first + element.count);
    const bool done = read_records(element, size, [&](auto& values, std::size_t i) {
      for (std::size_t k = 0; k < axis_of.size(); ++k) {
        const PlyType type = element.properties[k].type;
        if (axis_of[k] < 0)
          values.skip(type, 1);
        else
          builder_.points[first + i][axis_of[k]] = values.number(type, "a coordinate");
      }
      return true;
    });
    if (!done) builder_.points.resize(first);
    return done;
  }

  template <class IsCorners>
  bool read_triangles_in_records(const PlyElement& element, const IsCorners& is_corners) {
    std::uint64_t size = 0;
    for (const PlyProperty& p : element.properties) {
      if (p.is_list && !is_corners(p)) return false;
      size +=
          p.is_list ? Values::least_bytes(p.count_type) + 3 * Values::least_bytes(p.type) : Values::least_bytes(p.type);
    }
    if (builder_.faces() > 0) return false;
    const std::size_t points = builder_.points.size();  // those behind the faces in the file are looked for one by one
    std::vector<Triangle> triangles(element.count);
    const bool done = read_records(element, size, [&](auto& values, std::size_t i) {
      for (const PlyProperty& p : element.properties) {
        if (!p.is_list) {
          values.skip(p.type, 1);
          continue;
        }
        if (values.integer(p.count_type, "the length of a list") != 3) return false;
        for (VertexIndex& corner : triangles[i]) {
          const std::int64_t v = values.integer(p.type, "the number of a vertex");
          if (v < 0 || v >= static_cast<std::int64_t>(points)) return false;
          corner = static_cast<VertexIndex>(v);
        }
      }
      return true;
    });
    if (done) builder_.set_triangles(std::move(triangles));
    return done;
  }

  void read_edges(const PlyElement& element, std::vector<Edge>& edges) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Edge edge{kNone, kNone};
      for (const PlyProperty& p : element.properties) {
        if (!p.is_list && (p.name == "vertex1" || p.name == "vertex2"))
          edge[p.name == "vertex2"] = vertex_number(p, fmt::format("edge {}", i));
        else
          skip_property(p);
      }
      if (edge[0] == kNone || edge[1] == kNone)
        input_.fail_at_line(element.declared_at,
                            "the edges do not have the properties \"vertex1\" and \"vertex2\"; export the file again");
      edges.push_back(edge);
    }
  }

  std::uint32_t vertex_number(const PlyProperty& p, const std::string& of) {
    const char* const at = values_.position();
    const std::int64_t v = values_.integer(p.type, "the number of a vertex");
    if (v < 0 || v >= std::int64_t{kNone})
      input_.fail_at_byte(at, fmt::format("{} has the vertex {}; the file is damaged: export it again", of, v));
    return static_cast<std::uint32_t>(v);
  }

  void read_faces(const PlyElement& element) {
    const auto is_corners = [](const PlyProperty& p) {
      return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::count_if(element.properties.begin(), element.properties.end(), is_corners) != 1)
      input_.fail_at_line(element.declared_at,
                          "the faces do not have one list \"vertex_indices\" each; export the file again");
    const auto has = [&](std::string_view name) {
      return std::any_of(element.properties.begin(), element.properties.end(),
                         [&](const PlyProperty& p) { return p.name == name && !p.is_list; });
    };
    const bool has_sides = has("front") && has("back");
    if (!has_sides) builder_.region_names.clear();
    if (!has_sides && !has("patch") && read_triangles_in_records(element, is_corners)) return;
    builder_.reserve_faces(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const char* const at = values_.position();
      std::uint32_t patch = 0;
      Sides sides{kNone, kNone};
      for (const PlyProperty& p : element.properties) {
        if (is_corners(p)) {
          read_corners(p);
        } else if (p.name == "patch" && !p.is_list) {
          patch = group_number(p, "patch", 0);
        } else if (has_sides && !p.is_list && (p.name == "front" || p.name == "back")) {
          sides[p.name == "back"] = group_number(p, "region", -1);
        } else {
          skip_property(p);
        }
      }
      if (has_sides) {
        builder_.add_face(corners_, at, patch, sides);
      } else {
        builder_.add_face(corners_, at, patch);
      }
    }
  }

  /// The number of a patch or region; -1, where it may be, is kNone.
  std::uint32_t group_number(const PlyProperty& p, std::string_view what, std::int64_t least) {
    // Groups are numbered through; what follows may well keep a table of them.
    constexpr std::int64_t kMost = 1 << 20;
    const char* const at = values_.position();
    const std::int64_t number = values_.integer(p.type, fmt::format("the number of a {}", what));
    if (number < least || number >= kMost)
      input_.fail_at_byte(at, fmt::format("face {} has the {} {}; {}s are numbered from {} to {} at most",
                                          builder_.faces(), what, number, what, least, kMost - 1));
    return number < 0 ? kNone : static_cast<std::uint32_t>(number);
  }

  void read_corners(const PlyProperty& p) {
    const std::uint64_t n = list_length(p);
    corners_.clear();
    for (std::uint64_t k = 0; k < n; ++k) {
      const char* const at = values_.position();
      const std::int64_t c = values_.integer(p.type, "the number of a vertex");
      if (c < 0 || c >= std::int64_t{kNone})
        input_.fail_at_byte(
            at, fmt::format("face {} has the corner {}; the file is damaged: export it again", builder_.faces(), c));
      corners_.push_back(static_cast<std::uint32_t>(c));
    }
  }

  const Input& input_;
  const PlyHeader& header_;
  Values values_;
  SurfaceBuilder builder_;
  std::vector<std::uint32_t> corners_;
};

template <class Work>
auto with_body(const Input& input, bool of_lines, const Work& work) {
  const PlyHeader header = read_ply_header(input, of_lines);
  if (header.format == PlyHeader::Format::kText) return work(PlyBody(input, header, TextValues(input, header.end)));
  const bool swap = header.format == PlyHeader::Format::kBigEndian;
  return work(PlyBody(input, header, BinaryValues(input, header.end, swap)));
}

}  // namespace

Told told_ply(const FileHead& head) {
  const std::string_view bytes = head.input.bytes;
  return bytes.starts_with("ply") && (bytes.size() == 3 || is_blank(bytes[3])) ? Told::kMagic : Told::kNot;
}

SurfaceFile read_ply(const Input& input) {
  return with_body(input, false, [](auto&& body) { return body.read(); });
}

LinesFile read_ply_lines(const Input& input) {
  return with_body(input, true, [](auto&& body) { return body.read_lines(); });
}

}  // namespace octafront::io
