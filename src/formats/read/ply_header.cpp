#include "formats/read/ply_header.h"

#include "formats/containers/scanner.h"

#include <array>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

std::optional<PlyType> ply_type_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PlyType>, 18> kTypes{{
      {"char", PlyType::kInt8},
      {"int8", PlyType::kInt8},
      {"uchar", PlyType::kUInt8},
      {"uint8", PlyType::kUInt8},
      {"short", PlyType::kInt16},
      {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUInt16},
      {"uint16", PlyType::kUInt16},
      {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},
      {"uint", PlyType::kUInt32},
      {"uint32", PlyType::kUInt32},
      {"int64", PlyType::kInt64},
      {"long", PlyType::kInt64},
      {"float", PlyType::kFloat},
      {"float32", PlyType::kFloat},
      {"double", PlyType::kDouble},
      {"float64", PlyType::kDouble},
  }};
  for (const auto& [known, type] : kTypes)
    if (name == known) return type;
  return std::nullopt;
}

class HeaderParser {
 public:
  HeaderParser(const Input& input, bool of_lines) : input_(input), of_lines_(of_lines), scan_(input) {}

  PlyHeader read() {
    scan_.word();  // "ply"
    for (bool more = true; more;) more = read_line();
    if (!has_format_) input_.fail("has a PLY header without a line \"format\"; export it again");
    check_elements();
    return std::move(header_);
  }

 private:
  bool read_line() {
    if (scan_.at_end())
      scan_.fail("the PLY header ends without \"end_header\"; the file is truncated: copy or export it again");
    const std::string_view word = scan_.word();
    if (word == "end_header") {
      header_.end = behind_line_end();
      return false;
    }
    if (word == "format") {
      read_format();
    } else if (word == "element") {
      read_element(word.data());
    } else if (word == "property") {
      read_property();
    } else if (word == "comment" || word == "obj_info") {
      read_comment();
    } else {
      scan_.set_position(word.data());
      scan_.fail_expected("\"element\", \"property\", \"comment\" or \"end_header\" in the PLY header");
    }
    scan_.skip_line();
    return true;
  }

  void read_format() {
    if (scan_.at_line_end()) scan_.fail_expected("the kind of the format");
    const std::string_view word = scan_.peek_word();
    if (word == "ascii") {
      header_.format = PlyHeader::Format::kText;
    } else if (word == "binary_little_endian") {
      header_.format = PlyHeader::Format::kLittleEndian;
    } else if (word == "binary_big_endian") {
      header_.format = PlyHeader::Format::kBigEndian;
    } else {
      scan_.fail_expected("\"ascii\", \"binary_little_endian\" or \"binary_big_endian\"");
    }
    has_format_ = true;
  }

  void read_element(const char* at) {
    PlyElement element;
    element.declared_at = at;
    element.name = required_word("the name of an element");
    if (scan_.at_line_end()) scan_.fail_expected("the number of elements");
    const std::int64_t n = scan_.integer("the number of elements");
    if (n < 0) input_.fail_at_line(at, fmt::format("claims {} elements; the file is damaged: export it again", n));
    element.count = static_cast<std::uint64_t>(n);
    header_.elements.push_back(std::move(element));
  }

  void read_property() {
    if (header_.elements.empty()) scan_.fail("a property before the first element; the file is damaged");
    PlyProperty p;
    std::string_view type = required_word("the type of a property");
    if (type == "list") {
      p.is_list = true;
      p.count_type = known_type(required_word("the type of the length of a list"));
      type = required_word("the type of a property");
    }
    p.type = known_type(type);
    p.name = required_word("the name of a property");
    header_.elements.back().properties.push_back(p);
  }

  void read_comment() {
    if (scan_.at_line_end()) return;
    const std::string_view what = scan_.word();
    if ((what != "patch" && what != "region") || scan_.at_line_end()) return;
    std::vector<std::string>& names = what == "patch" ? header_.patch_names : header_.region_names;
    const std::string_view number = scan_.word();
    std::size_t index = 0;
    const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), index);
    // Comments may hold anything: only names that come in order count.
    if (error != std::errc() || stop != number.data() + number.size() || index != names.size()) return;
    names.emplace_back(scan_.rest_of_line());
  }

  std::string_view required_word(std::string_view what) {
    if (scan_.at_line_end()) scan_.fail(fmt::format("expected {}, but the line ends; the file is damaged", what));
    return scan_.word();
  }

  PlyType known_type(std::string_view name) {
    const std::optional<PlyType> type = ply_type_of(name);
    if (!type) scan_.fail(fmt::format("{} is no type of PLY; the file is damaged: export it again", in_quotes(name)));
    return *type;
  }

  /// Binary values begin right behind the line end, which is the one that the first line has too.
  const char* behind_line_end() {
    scan_.skip_line();
    const char* at = scan_.position();
    const char* const end = input_.bytes.data() + input_.bytes.size();
    const std::size_t first = input_.bytes.find_first_of("\r\n");
    const bool is_mac = input_.bytes[first] == '\r' && input_.bytes.substr(first + 1, 1) != "\n";
    if (at != end && *at == '\r') {
      ++at;
      if (!is_mac && at != end && *at == '\n') ++at;
    } else if (at != end) {
      ++at;
    }
    return at;
  }

  void check_elements() const {
    int vertices = 0, faces = 0, strips = 0;
    for (const PlyElement& e : header_.elements) {
      vertices += e.name == "vertex";
      faces += e.name == "face";
      strips += e.name == "tristrips";
    }
    if (vertices != 1)
      input_.fail(fmt::format("declares the element \"vertex\" {} times in its header, not once", vertices));
    if (faces == 1 || of_lines_) return;
    if (strips > 0) input_.fail("holds triangle strips, which are not read here; export it with faces");
    input_.fail(faces == 0 ? "declares no faces in its header: points alone are no surface; export the surface"
                           : "declares the element \"face\" more than once in its header");
  }

  const Input& input_;
  bool of_lines_;  ///< no faces are wanted
  Scanner scan_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::uint64_t ply_size(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUInt8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUInt16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUInt32:
    case PlyType::kFloat:
      return 4;
    default:
      return 8;
  }
}

std::string_view PlyHeader::format_name() const {
  switch (format) {
    case Format::kText:
      return "ASCII PLY";
    case Format::kLittleEndian:
      return "binary PLY";
    default:
      return "binary PLY (big endian)";
  }
}

PlyHeader read_ply_header(const Input& input, bool of_lines) {
  return HeaderParser(input, of_lines).read();
}

}  // namespace octafront::io
