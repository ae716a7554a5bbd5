#pragma once

#include "formats/containers/input.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace octafront::io {

/// A tag of an XML text. Views point into the input.
struct XmlTag {
  std::string_view name;  ///< without "/"; empty at the end of the text
  bool closes = false;    ///< </name>
  bool empty = false;     ///< <name/>
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  const char* at = nullptr;      ///< the "<"
  const char* behind = nullptr;  ///< behind the ">"

  /// The value, or `otherwise` if there is no such attribute.
  std::string_view attribute(std::string_view key, std::string_view otherwise = {}) const;
};

/// Reads tags one after another: enough XML for the files of VTK. Comments and declarations are passed over.
class XmlTags {
 public:
  explicit XmlTags(const Input& input) : input_(input), at_(0) {}
  XmlTag next();

 private:
  void read_attributes(XmlTag& tag);
  bool skip_markup(std::string_view opening, std::string_view closing);
  [[noreturn]] void fail(std::string_view message) const { input_.fail_at_line(input_.bytes.data() + at_, message); }

  const Input& input_;
  std::size_t at_;
};

/// &amp; and its like replaced.
std::string unescaped(std::string_view text);
/// The other way round, for the values of attributes; control characters become blanks.
std::string escaped(std::string_view text);

/// A DataArray of a VTK XML file: where its values are, not yet read.
struct VtkArray {
  std::string_view section;  ///< the tag around it: "Points", "Cells", "CellData" ...
  std::string_view type, format;
  std::string name;
  std::uint64_t components = 1;
  std::uint64_t offset = 0;  ///< of appended data
  std::string_view text;     ///< what stands in the tag
  const char* at = nullptr;

  /// For messages: array "size", or the array of <Points>, which has no name.
  std::string label() const;
};

/// A VTK XML file of one piece.
struct VtkXml {
  std::uint64_t points = 0, cells = 0;
  bool long_headers = false;  ///< 64-bit counts before binary data, else 32-bit
  bool is_compressed = false;
  bool appended_is_base64 = false;
  std::string_view appended;  ///< behind the underscore, up to the end of the file
  std::vector<VtkArray> arrays;

  const VtkArray* find(std::string_view section, std::string_view name) const;
};

/// What a file may be: an unstructured grid alone, or polygons (VTP) too.
enum class VtkKind { kUnstructuredGrid, kAnyMesh };

/// Throws InputError if it is not of that kind, of one piece, in little-endian order, compressed by zlib or not at all.
VtkXml read_vtk_xml(const Input& input, VtkKind kind = VtkKind::kUnstructuredGrid);

/// The values of an array. Throws InputError, also for blocks that would unpack to more than `most_values`: memory
/// grows only with what is really there, and with what the counts of the file allow.
std::vector<double> vtk_reals(const VtkXml& xml, const VtkArray& array, const Input& input, std::uint64_t most_values);
std::vector<std::int64_t> vtk_integers(const VtkXml& xml, const VtkArray& array, const Input& input,
                                       std::uint64_t most_values);

}  // namespace octafront::io
