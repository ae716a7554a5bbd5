#include "formats/containers/vtk_xml.h"

#include "formats/containers/scanner.h"

#include <array>
#include <charconv>

#include <fmt/core.h>

namespace octafront::io {
namespace {

std::uint64_t parse_count(const Input& input, const XmlTag& tag, std::string_view key, std::string_view otherwise) {
  std::string_view text = tag.attribute(key, otherwise);
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size())
    input.fail_at_line(tag.at, fmt::format("expected a count as {} of <{}>, found {}; the file is damaged", key,
                                           tag.name, in_quotes(text)));
  return value;
}

class VtkXmlReader {
 public:
  VtkXmlReader(const Input& input, VtkKind kind) : input_(input), kind_(kind), tags_(input) {}

  VtkXml read() {
    while (!done_) {
      // Behind the appended data tags cannot be told from values.
      const XmlTag tag = tags_.next();
      if (tag.name.empty()) break;
      if (tag.name == "VTKFile") {
        tag.closes ? void(done_ = true) : read_file_tag(tag);
      } else if (tag.name == "Piece" && !tag.closes) {
        read_piece(tag);
      } else if (tag.name == "DataArray" || tag.name == "Array") {
        if (!tag.closes) read_array(tag);
      } else if (tag.name == "AppendedData" && !tag.closes) {
        read_appended(tag);
        done_ = true;
      } else {
        section_ = tag.closes ? std::string_view() : tag.name;
      }
    }
    if (!has_file_tag_ || pieces_ == 0) input_.fail("ends before the first <Piece>; it is truncated or no VTU file");
    if (!done_) input_.fail("ends without </VTKFile>; it is truncated: copy or export it again");
    return std::move(xml_);
  }

 private:
  void read_file_tag(const XmlTag& tag) {
    has_file_tag_ = true;
    const std::string_view type = tag.attribute("type");
    const bool may_be_polygons = kind_ == VtkKind::kAnyMesh;
    if (type != "UnstructuredGrid" && !(may_be_polygons && type == "PolyData"))
      input_.fail(fmt::format("is a VTK file of type {}; expected an UnstructuredGrid (.vtu){}{}", in_quotes(type),
                              may_be_polygons ? " or PolyData (.vtp)" : "",
                              type == "PUnstructuredGrid" ? ": it names pieces, which are read one by one" : ""));
    if (tag.attribute("byte_order", "LittleEndian") != "LittleEndian")
      input_.fail("has its values in big-endian order, which is not read here; save it on a little-endian machine");
    xml_.long_headers = tag.attribute("header_type", "UInt32") == "UInt64";
    const std::string_view compressor = tag.attribute("compressor");
    xml_.is_compressed = !compressor.empty();
    if (xml_.is_compressed && compressor != "vtkZLibDataCompressor")
      input_.fail(fmt::format("is compressed by {}, which is not read here; save it with zlib or uncompressed",
                              in_quotes(compressor)));
  }

  void read_piece(const XmlTag& tag) {
    if (++pieces_ > 1)
      input_.fail_at_line(tag.at, "a second piece; files of several pieces are not read here: merge them");
    xml_.points = parse_count(input_, tag, "NumberOfPoints", "");
    xml_.cells = parse_count(input_, tag, "NumberOfCells", kind_ == VtkKind::kAnyMesh ? "0" : "");
  }

  void read_array(const XmlTag& tag) {
    VtkArray array;
    array.section = section_;
    array.type = tag.attribute("type");
    array.format = tag.attribute("format", "ascii");
    array.name = unescaped(tag.attribute("Name"));
    array.components = parse_count(input_, tag, "NumberOfComponents", "1");
    array.at = tag.at;
    if (array.format == "appended") {
      array.offset = parse_count(input_, tag, "offset", "");
    } else if (!tag.empty) {
      const std::size_t begin = static_cast<std::size_t>(tag.behind - input_.bytes.data());
      const std::size_t end = input_.bytes.find('<', begin);
      if (end == std::string_view::npos) input_.fail_at_line(tag.at, "this array does not end; the file is truncated");
      array.text = input_.bytes.substr(begin, end - begin);
    }
    xml_.arrays.push_back(std::move(array));
  }

  void read_appended(const XmlTag& tag) {
    const std::string_view encoding = tag.attribute("encoding", "base64");
    if (encoding != "raw" && encoding != "base64")
      input_.fail_at_line(tag.at,
                          fmt::format("appended data encoded as {}; expected raw or base64", in_quotes(encoding)));
    xml_.appended_is_base64 = encoding == "base64";
    const std::size_t mark = input_.bytes.find('_', static_cast<std::size_t>(tag.behind - input_.bytes.data()));
    if (mark == std::string_view::npos)
      input_.fail_at_line(tag.at, "the appended data do not begin with \"_\"; the file is truncated");
    xml_.appended = input_.bytes.substr(mark + 1);
    // Values may hold anything, so the end is looked for from behind.
    if (input_.bytes.rfind("</VTKFile>") == std::string_view::npos || input_.bytes.rfind("</VTKFile>") < mark)
      input_.fail("ends without </VTKFile>; it is truncated: copy or export it again");
  }

  const Input& input_;
  VtkKind kind_;
  XmlTags tags_;
  VtkXml xml_;
  std::string_view section_;
  int pieces_ = 0;
  bool has_file_tag_ = false, done_ = false;
};

}  // namespace

std::string_view XmlTag::attribute(std::string_view key, std::string_view otherwise) const {
  for (const auto& [k, value] : attributes)
    if (k == key) return value;
  return otherwise;
}

std::string VtkArray::label() const {
  return name.empty() ? fmt::format("the array of <{}>", section) : fmt::format("array {}", in_quotes(name));
}

bool XmlTags::skip_markup(std::string_view opening, std::string_view closing) {
  if (!input_.bytes.substr(at_).starts_with(opening)) return false;
  const std::size_t end = input_.bytes.find(closing, at_ + opening.size());
  if (end == std::string_view::npos) fail("this markup does not end; the file is truncated");
  at_ = end + closing.size();
  return true;
}

XmlTag XmlTags::next() {
  const std::string_view text = input_.bytes;
  for (;;) {
    at_ = text.find('<', at_);
    if (at_ == std::string_view::npos) {
      at_ = text.size();
      return {};
    }
    if (!skip_markup("<!--", "-->") && !skip_markup("<?", "?>") && !skip_markup("<!", ">")) break;
  }
  XmlTag tag;
  tag.at = text.data() + at_++;
  if (at_ < text.size() && text[at_] == '/') {
    tag.closes = true;
    ++at_;
  }
  const std::size_t begin = at_;
  while (at_ < text.size() && !is_blank(text[at_]) && text[at_] != '>' && text[at_] != '/') ++at_;
  tag.name = text.substr(begin, at_ - begin);
  if (tag.name.empty()) fail("a tag without a name; the file is damaged");
  read_attributes(tag);
  tag.behind = text.data() + at_;
  return tag;
}

void XmlTags::read_attributes(XmlTag& tag) {
  const std::string_view text = input_.bytes;
  for (;;) {
    while (at_ < text.size() && is_blank(text[at_])) ++at_;
    if (at_ < text.size() && text[at_] == '/') {
      tag.empty = true;
      ++at_;
    } else if (at_ < text.size() && text[at_] == '>') {
      ++at_;
      return;
    } else {
      const std::size_t equals = text.find('=', at_);
      const std::size_t open = equals == std::string_view::npos ? equals : text.find_first_of("\"'", equals);
      const std::size_t close = open == std::string_view::npos ? open : text.find(text[open], open + 1);
      if (close == std::string_view::npos) fail("a tag does not end; the file is truncated: copy or export it again");
      std::string_view key = text.substr(at_, equals - at_);
      while (!key.empty() && is_blank(key.back())) key.remove_suffix(1);
      tag.attributes.emplace_back(key, text.substr(open + 1, close - open - 1));
      at_ = close + 1;
    }
  }
}

std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string out;
  while (!text.empty()) {
    std::size_t used = 1;
    char c = text[0];
    for (const auto& [entity, meaning] : kEntities) {
      if (!text.starts_with(entity)) continue;
      used = entity.size();
      c = meaning;
    }
    out += c;
    text.remove_prefix(used);
  }
  return out;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

const VtkArray* VtkXml::find(std::string_view section, std::string_view name) const {
  for (const VtkArray& array : arrays)
    if (array.section == section && (name.empty() || array.name == name)) return &array;
  return nullptr;
}

VtkXml read_vtk_xml(const Input& input, VtkKind kind) {
  return VtkXmlReader(input, kind).read();
}

}  // namespace octafront::io
