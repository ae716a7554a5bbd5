// Legacy VTK, version 3.0, binary (big-endian) or text: the cells and data of formats/parts/vtk_cells.h, all data as
// fields. Blanks and the like in names are %20, as VTK does it.

#include <octafront/error.h>

#include "formats/containers/text_writer.h"
#include "formats/parts/vtk_cells.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace octafront::io {
namespace {

std::string percent_encoded(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool plain = static_cast<unsigned char>(c) > 0x20 && c != '"' && c != '%';
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

class VtkWriter {
 public:
  VtkWriter(AtomicFile& file, const MeshParts& parts, std::span<const MeshField> fields, bool as_text)
      : file_(file), out_(file), parts_(parts), fields_(fields), cells_(parts), as_text_(as_text) {}

  void write() {
    out_.line("# vtk DataFile Version 3.0\nmesh by octafront\n{}\nDATASET UNSTRUCTURED_GRID",
              as_text_ ? "ASCII" : "BINARY");
    const auto names = cells_.names();
    if (!names.empty()) out_.line("FIELD FieldData {}", names.size());
    for (const auto& [name, number] : names) {
      out_.line("{} 1 1 int", percent_encoded(name));
      put(static_cast<std::int32_t>(number));
      end_values();
    }
    out_.line("POINTS {} double", parts_.points());
    for (std::size_t v = 0; v < parts_.points(); ++v) {
      for (int axis = 0; axis < 3; ++axis) put(parts_.mesh().points[v][axis]);
      end_row();
    }
    end_values();
    out_.line("CELLS {} {}", cells_.size(), cells_.size() + cells_.nodes());
    std::uint64_t at = 0;
    for (std::uint64_t c = 0; c < cells_.size(); ++c) {
      put(static_cast<std::int32_t>(cells_.nodes_of(c)));
      for (const std::uint64_t end = cells_.end_of(c); at < end; ++at) put(static_cast<std::int32_t>(cells_.node(at)));
      end_row();
    }
    end_values();
    out_.line("CELL_TYPES {}", cells_.size());
    for (std::uint64_t c = 0; c < cells_.size(); ++c) {
      put(std::int32_t{cells_.type(c)});
      end_row();
    }
    end_values();
    write_data("CELL_DATA", false, cells_.size());
    write_data("POINT_DATA", true, parts_.points());
  }

 private:
  template <class T>
  void put(T value) {
    if (as_text_) return put_text(value);
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    std::reverse(bytes.begin(), bytes.end());
    file_.write(bytes.data(), bytes.size());
  }

  template <class T>
  void put_text(T value) {
    if (!at_line_start_) out_ << ' ';
    // A letter is not meant where a value has one byte.
    if constexpr (sizeof(T) == 1) out_ << std::uint32_t{value};
    if constexpr (sizeof(T) > 1) out_ << value;
    at_line_start_ = false;
  }
  /// Lines are for people: a text has one for each point and cell.
  void end_row() {
    if (!as_text_) return;
    out_ << '\n';
    at_line_start_ = true;
  }
  void end_values() {
    if (!as_text_ || !at_line_start_) out_ << '\n';
    at_line_start_ = true;
  }

  void write_data(std::string_view keyword, bool of_points, std::uint64_t count) {
    const auto is_of = [&](const VtkCells::Data& data) { return data.of_points == of_points; };
    const auto& all = cells_.data();
    const auto is_field_of = [&](const MeshField& field) { return field.of_elements != of_points; };
    const auto arrays =
        std::count_if(all.begin(), all.end(), is_of) + std::count_if(fields_.begin(), fields_.end(), is_field_of);
    if (arrays == 0) return;
    out_.line("{} {}\nFIELD FieldData {}", keyword, count, arrays);
    for (std::size_t d = 0; d < all.size(); ++d) {
      if (!is_of(all[d])) continue;
      out_.line("{} 1 {} {}", percent_encoded(all[d].name), count, all[d].is_set ? "unsigned_char" : "int");
      constexpr std::uint64_t kInLine = 24;
      for (std::uint64_t i = 0; i < count; ++i) {
        all[d].is_set ? put(static_cast<std::uint8_t>(cells_.value(d, i))) : put(cells_.value(d, i));
        if (i % kInLine == kInLine - 1) end_row();
      }
      end_values();
    }
    for (const MeshField& field : fields_)
      if (is_field_of(field)) write_field(field, count);
  }

  void write_field(const MeshField& field, std::uint64_t count) {
    out_.line("{} {} {} double", percent_encoded(field.name), field.components, count);
    for (std::uint64_t i = 0; i < count; ++i) {
      for (std::uint64_t k = 0; k < field.components; ++k) put(cells_.value_of(field, i, k));
      end_row();
    }
    end_values();
  }

  AtomicFile& file_;
  TextWriter out_;
  const MeshParts& parts_;
  std::span<const MeshField> fields_;
  VtkCells cells_;
  bool as_text_, at_line_start_ = true;
};

}  // namespace

void write_vtk(MeshOutput& out, const MeshParts& mesh) {
  const std::uint64_t most = std::numeric_limits<std::int32_t>::max();
  if (mesh.points() + mesh.tets() * (mesh.nodes_per_tet() + 1) + mesh.faces() * 7 > most)
    throw OutputError(out.target().string() + ": legacy VTK counts with 32 bits, too few for this mesh; write .vtu");
  VtkWriter(out.file(), mesh, out.fields(), out.as_text()).write();
}

}  // namespace octafront::io
