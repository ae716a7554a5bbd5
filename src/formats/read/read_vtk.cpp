// Legacy VTK unstructured grids, versions 2 to 5, text and binary (big-endian). Data arrays: those of vtk_reading.h, in
// fields or as scalars; others are passed over.

#include "formats/containers/scanner.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"
#include "formats/read/vtk_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/core.h>

namespace octafront::io {
namespace {

std::string percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const bool coded = text[i] == '%' && i + 2 < text.size() &&
                       std::from_chars(text.data() + i + 1, text.data() + i + 3, value, 16).ptr == text.data() + i + 3;
    out += coded ? static_cast<char>(value) : text[i];
    i += coded ? 2 : 0;
  }
  return out;
}

struct Type {
  std::string_view name;
  std::size_t bytes;
};
constexpr std::array kVtkTypes{Type{"double", 8},         Type{"float", 4},        Type{"int", 4},
                               Type{"unsigned_char", 1},  Type{"char", 1},         Type{"short", 2},
                               Type{"unsigned_short", 2}, Type{"unsigned_int", 4}, Type{"long", 8},
                               Type{"unsigned_long", 8},  Type{"vtktypeint64", 8}, Type{"vtkidtype", 8},
                               Type{"vtktypeint32", 4},   Type{"vtktypeuint8", 1}, Type{"vtktypeint8", 1}};

class Vtk {
 public:
  explicit Vtk(const Input& input) : input_(input), scan_(input) { raw_.format = "legacy VTK"; }

  RawMesh read() {
    // "# vtk DataFile Version 3.0", a title, BINARY or ASCII, DATASET.
    for (int line = 0; line < 2; ++line) next_line();
    const std::string_view encoding = scan_.word();
    if (encoding != "BINARY" && encoding != "ASCII") scan_.fail("expected ASCII or BINARY in the third line");
    binary_ = encoding == "BINARY";
    if (scan_.word() != "DATASET" || scan_.word() != "UNSTRUCTURED_GRID")
      scan_.fail("is no UNSTRUCTURED_GRID; tetrahedra are needed");
    while (!scan_.at_end()) read_section();
    if (!has_cells_ || types_.empty())
      input_.fail("has no CELLS with CELL_TYPES; it is truncated or holds no mesh: copy or export it again");
    take_cells();
    return std::move(raw_);
  }

 private:
  enum class Of { kField, kCells, kPoints };

  void next_line() {
    scan_.skip_line();
    scan_.skip_line_end();
  }

  /// Passes over the word if it is that one; binary values stay where they are.
  bool next_word_is(std::string_view word) {
    const char* const at = scan_.position();
    if (scan_.word() == word) return true;
    scan_.set_position(at);
    return false;
  }

  static const Type* type_named(std::string_view name) {
    for (const Type& type : kVtkTypes)
      if (equal_ignoring_case(name, type.name)) return &type;
    return nullptr;
  }
  const Type& type() {
    const std::string_view name = scan_.word();
    const Type* found = type_named(name);
    if (found == nullptr) scan_.fail(fmt::format("values of type {} are not known here", in_quotes(name)));
    return *found;
  }
  std::uint64_t count(std::string_view what) {
    const std::int64_t n = scan_.integer(what);
    if (n < 0) scan_.fail(fmt::format("expected {}, found {}", what, n));
    return static_cast<std::uint64_t>(n);
  }
  std::uint64_t product(std::uint64_t a, std::uint64_t b) const {
    if (b != 0 && a > input_.bytes.size() / b + 1) scan_.fail("claims more values than the file has; it is damaged");
    return a * b;
  }

  void check(std::uint64_t values, const Type& of) {
    check_claim(input_, scan_.position(), {values, binary_ ? of.bytes : 2, "values"}, scan_.bytes_left());
  }

  /// Values stand behind the end of the line of their keyword.
  template <class Take>
  void values(std::uint64_t n, const Type& of, const Take& take) {
    check(n, of);
    if (!binary_) {
      const bool is_real = of.name == "double" || of.name == "float";
      for (std::uint64_t i = 0; i < n; ++i)
        is_real ? take(scan_.number("a number")) : take(static_cast<double>(scan_.integer("a whole number")));
      return;
    }
    next_line();
    if (n * of.bytes > scan_.bytes_left()) scan_.fail("the file ends within these values; it is truncated");
    const char* at = scan_.position();
    for (std::uint64_t i = 0; i < n; ++i, at += of.bytes) {
      if (i % 65536 == 0) input_.context.check();
      take(value(at, of));
    }
    scan_.set_position(at);
  }

  template <class T>
  static double swapped(const char* at) {
    std::array<char, sizeof(T)> bytes;
    std::reverse_copy(at, at + sizeof(T), bytes.begin());
    T v;
    std::memcpy(&v, bytes.data(), sizeof(T));
    return static_cast<double>(v);
  }
  /// Whole numbers above 2^53 are no places in a file that can be read.
  static double value(const char* at, const Type& of) {
    if (of.name == "double") return swapped<double>(at);
    if (of.name == "float") return swapped<float>(at);
    const bool is_unsigned = of.name.find("uns") == 0 || of.name == "vtktypeuint8";
    switch (of.bytes) {
      case 1:
        return is_unsigned ? swapped<std::uint8_t>(at) : swapped<std::int8_t>(at);
      case 2:
        return is_unsigned ? swapped<std::uint16_t>(at) : swapped<std::int16_t>(at);
      case 4:
        return is_unsigned ? swapped<std::uint32_t>(at) : swapped<std::int32_t>(at);
      default:
        return swapped<std::int64_t>(at);
    }
  }

  std::vector<std::int64_t> integers(std::uint64_t n, const Type& of) {
    std::vector<std::int64_t> all;
    values(n, of, [&](double v) { all.push_back(std::abs(v) < 9e15 ? static_cast<std::int64_t>(v) : -1); });
    return all;
  }

  void read_section() {
    const std::string_view word = scan_.word();
    if (word == "POINTS") {
      read_points();
    } else if (word == "CELLS") {
      read_cells();
    } else if (word == "CELL_TYPES") {
      const std::uint64_t n = count("the number of types");
      types_ = integers(n, *type_named("int"));
    } else if (word == "CELL_DATA" || word == "POINT_DATA") {
      of_ = word == "CELL_DATA" ? Of::kCells : Of::kPoints;
      data_count_ = count("the number of data");
    } else if (word == "FIELD") {
      read_field();
    } else if (word == "SCALARS") {
      read_scalars();
    } else if (word == "VECTORS" || word == "NORMALS" || word == "TENSORS") {
      const std::string name = percent_decoded(scan_.word());
      const std::uint64_t components = word == "TENSORS" ? 9 : 3;
      take_array(name, product(data_count_, components), components, type());
    } else if (word == "METADATA") {
      // Up to an empty line.
      next_line();
      while (scan_.bytes_left() > 0 && !scan_.at_line_end()) next_line();
    } else {
      scan_.fail(fmt::format("{} is not known here; write the grid as .vtu", in_quotes(word)));
    }
  }

  void read_points() {
    const std::uint64_t n = count("the number of points");
    const Type& of = type();
    if (!raw_.points.empty()) scan_.fail("a second section POINTS; the file is damaged");
    std::array<double, 3> xyz;
    std::size_t k = 0;
    values(product(n, 3), of, [&](double v) {
      if (!std::isfinite(v)) scan_.fail(fmt::format("a coordinate is {}, which is no place", v));
      xyz[k++] = v;
      if (k == 3) raw_.points.push_back({xyz[0], xyz[1], xyz[2]});
      k %= 3;
    });
  }

  void read_cells() {
    const std::uint64_t n = count("the number of cells"), size = count("the size of the list");
    has_cells_ = true;
    if (next_word_is("OFFSETS")) {
      // Version 5: n counts the offsets, one more than cells.
      const Type& of_offsets = type();
      ends_ = integers(n, of_offsets);
      if (!ends_.empty()) ends_.erase(ends_.begin());
      if (scan_.word() != "CONNECTIVITY") scan_.fail("expected CONNECTIVITY");
      const Type& of = type();
      nodes_ = integers(size, of);
      return;
    }
    // Each cell behind the number of its nodes.
    const std::vector<std::int64_t> all = integers(size, *type_named("int"));
    for (std::uint64_t at = 0, c = 0; c < n; ++c) {
      const std::int64_t nodes = at < all.size() ? all[at] : -1;
      if (nodes < 0 || static_cast<std::uint64_t>(nodes) > all.size() - at - 1)
        scan_.fail(fmt::format("cell {} has {} nodes, more than the list; the file is damaged", c, nodes));
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(at) + 1;
      nodes_.insert(nodes_.end(), first, first + nodes);
      ends_.push_back(static_cast<std::int64_t>(nodes_.size()));
      at += static_cast<std::uint64_t>(nodes) + 1;
    }
  }

  void read_field() {
    scan_.word();
    const std::uint64_t arrays = count("the number of arrays");
    for (std::uint64_t a = 0; a < arrays; ++a) {
      if (scan_.at_end()) scan_.fail("the file ends before all arrays; it is truncated");
      const std::string name = percent_decoded(scan_.word());
      if (name == "METADATA") {
        next_line();
        while (scan_.bytes_left() > 0 && !scan_.at_line_end()) next_line();
        --a;
        continue;
      }
      const std::uint64_t components = count("the number of components"), tuples = count("the number of tuples");
      take_array(name, product(components, tuples), components, type());
    }
  }

  void read_scalars() {
    const std::string name = percent_decoded(scan_.word());
    const Type& of = type();
    const std::uint64_t components = scan_.at_line_end() ? 1 : count("the number of components");
    if (next_word_is("LOOKUP_TABLE")) scan_.word();
    take_array(name, product(data_count_, components), components, of);
  }

  void take_array(const std::string& name, std::uint64_t n, std::uint64_t components, const Type& of) {
    const bool is_asked =
        components == 1 || (of_ == Of::kCells && input_.wants_element_tensors) ? of_ != Of::kField : of_ == Of::kPoints;
    if (is_asked && !is_numbering(name) && raw_.field.offer(input_, name, components)) return take_field(n, of);
    const bool is_wanted = is_set_name(name) || name == "region" || name == "patch" || name == "curve" ||
                           name == "source" || name == "layers" || of_ == Of::kField || of_ == Of::kCells;
    if (!is_wanted || of.name == "double" || of.name == "float") return values(n, of, [](double) {});
    std::vector<std::int64_t> all = integers(n, of);
    if (of_ == Of::kField) {
      if (all.size() == 1) add_vtk_name(raw_, name, all[0]);
    } else if (of_ == Of::kPoints) {
      if (is_set_name(name) && all.size() == raw_.points.size()) add_node_set(raw_, name, all);
    } else {
      cell_arrays_.emplace_back(name, std::move(all));
    }
  }

  void take_field(std::uint64_t n, const Type& of) {
    std::vector<double> all;
    values(n, of, [&](double v) { all.push_back(v); });
    if (of_ != Of::kPoints) cell_field_components_ = raw_.field.components;
    (of_ == Of::kPoints ? raw_.field.at_points : cell_field_) = std::move(all);
  }

  void take_cells() {
    if (types_.size() != ends_.size())
      input_.fail(fmt::format("has {} cells and {} types; the file is damaged", ends_.size(), types_.size()));
    VtkCellData data;
    std::vector<CellNumbers> others;
    for (auto& [name, all] : cell_arrays_) {
      if (all.size() != types_.size()) continue;
      if (name == "gmsh:physical" || name == "medit:ref") {
        if (data.region.empty()) data.region = data.patch = std::move(all);
      } else if (!is_numbering(name)) {
        others.push_back({name, std::move(all)});
      } else if (name == "label" || name.starts_with("gmsh:")) {
        continue;
      } else if (is_set_name(name)) {
        data.sets.emplace_back(name, std::move(all));
      } else if (name == "source" || name == "layers") {
        (name == "source" ? data.source : data.layers) = std::move(all);
      } else {
        for (std::int64_t& v : all) ++v;
        (name == "region" ? data.region : name == "patch" ? data.patch : data.curve) = std::move(all);
      }
    }
    if (data.region.empty() && data.patch.empty())
      data.region = data.patch = material_of(std::move(others), raw_.notes);
    data.field_components = cell_field_components_;
    if (cell_field_.size() == types_.size() * data.field_components) data.field = std::move(cell_field_);
    VtkCellTaker taker(input_, raw_, data);
    std::int64_t begin = 0;
    for (std::uint64_t c = 0; c < types_.size(); ++c) {
      const std::int64_t end = ends_[c];
      if (end < begin || static_cast<std::uint64_t>(end) > nodes_.size())
        input_.fail(fmt::format("cell {} has nodes {} to {} of {}; the file is damaged", c, begin, end, nodes_.size()));
      taker.take(c, types_[c],
                 std::span(nodes_).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)));
      begin = end;
    }
    taker.finish();
  }

  const Input& input_;
  Scanner scan_;
  RawMesh raw_;
  bool binary_ = false, has_cells_ = false;
  std::vector<std::int64_t> types_, ends_, nodes_;
  Of of_ = Of::kField;
  std::uint64_t data_count_ = 0;
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> cell_arrays_;
  std::vector<double> cell_field_;
  std::uint64_t cell_field_components_ = 1;
};

}  // namespace

Told told_vtk(const FileHead& head) {
  return head.kind.find("legacy VTK") != std::string_view::npos ? Told::kMagic : Told::kNot;
}

RawMesh read_vtk(const Input& input) {
  return Vtk(input).read();
}

}  // namespace octafront::io
