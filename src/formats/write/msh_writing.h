#pragma once

// What writers of both versions of Gmsh's files share.

#include <octafront/mesh_field.h>

#include "base/core/function_ref.h"
#include "formats/containers/text_writer.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/mixed_cells.h"
#include "formats/parts/msh_stream.h"

#include <array>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

/// Gmsh's type of an element of that dimension with so many nodes.
std::int32_t gmsh_type_of(std::size_t dimension, std::size_t nodes);

/// Nodes of an element, tags counting from 1, in Gmsh's order. Elements of dimensions 2 and 3 are those of MixedCells.
class ElementNodes {
 public:
  ElementNodes(const MeshParts& mesh, const MixedCells& cells) : mesh_(mesh), cells_(cells) {}

  template <class Tag, class Put>
  void put(std::size_t dimension, std::uint32_t element, const Put& put_tag) {
    const auto all = [&](std::span<const VertexIndex> nodes) {
      for (const VertexIndex v : nodes) put_tag(static_cast<Tag>(v + Tag{1}));
    };
    if (dimension == 0) return put_tag(static_cast<Tag>(element + Tag{1}));
    if (dimension == 1) return all(mesh_.edge_nodes(element, edge_));
    if (dimension == 2) return all(cells_.face_nodes(element, face_));
    const auto nodes = cells_.nodes(element, tet_, kGmshWide);
    if (nodes.size() == 10) std::swap(tet_[8], tet_[9]);  // 34 before 24
    if (mesh_.order() < 3) return all(nodes);
    CellRoom in_order;
    for (std::size_t k = 0; k < nodes.size(); ++k) in_order[k] = nodes[vtk_node_of_gmsh(mesh_.order(), k)];
    all(std::span(in_order).first(nodes.size()));
  }

 private:
  const MeshParts& mesh_;
  const MixedCells& cells_;
  CellRoom tet_;
  FaceRoom face_;
  EdgeRoom edge_;
};

/// The numbers of a file in either encoding; a text has a line for each record.
class MshNumbers {
 public:
  MshNumbers(AtomicFile& file, bool as_text) : file_(file), out_(file), as_text_(as_text) {}

  bool as_text() const { return as_text_; }
  template <class T>
  void put(T value) {
    if (!as_text_) return file_.write(&value, sizeof value);
    if (!at_line_start_) out_ << ' ';
    out_ << value;
    at_line_start_ = false;
  }
  void put(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) put(p[axis]);
  }
  void end_record() {
    if (!as_text_) return;
    out_ << '\n';
    at_line_start_ = true;
  }
  /// Values of a record of their own.
  template <class... T>
  void record(T... values) {
    (put(values), ...);
    end_record();
  }
  /// How many there are, and they.
  template <class T>
  void put_list(const std::vector<T>& values) {
    put(std::uint64_t{values.size()});
    for (const T value : values) put(value);
  }
  /// Ends the values of a section and writes the line that closes it.
  void close(std::string_view section) { out_.line("{}$End{}", as_text_ ? "" : "\n", section); }

  /// For each of `count` records what fill(i, put) puts, `bytes` of them in all.
  template <class Fill>
  void records(std::size_t count, std::size_t bytes, const Fill& fill) {
    if (as_text_) return write_lines(count, fill);
    file_.write_records(count, bytes, [&](std::size_t begin, std::size_t end, char* to) {
      fill(begin, end, [&](auto value) {
        std::memcpy(to, &value, sizeof value);
        to += sizeof value;
      });
    });
  }

 private:
  template <class Fill>
  void write_lines(std::size_t count, const Fill& fill) {
    for (std::size_t i = 0; i < count; ++i) {
      fill(i, i + 1, [this](auto value) { this->put(value); });
      end_record();
    }
  }

  AtomicFile& file_;
  TextWriter out_;
  bool as_text_, at_line_start_ = true;
};

void write_format(TextWriter& out, MshNumbers& numbers, std::string_view version);

/// Names stand in quotes, which Gmsh does not escape.
std::string unquoted(std::string_view name);
/// Numbers of fields that Gmsh takes: scalars, vectors, tensors.
bool is_of_gmsh(const MeshField& field);
void note_fields_left_out(MeshOutput& out);

/// $NodeData and $ElementData; tag_of(field, i) is the tag of point or tetrahedron i, or of element i of `cells`, which
/// know of points that are not written. Their heads are text in binary files, too.
template <class TagOf>
void write_fields(TextWriter& text, MshNumbers& out, std::span<const MeshField> fields, const TagOf& tag_of,
                  const MixedCells* cells = nullptr) {
  for (const MeshField& field : fields) {
    if (!is_of_gmsh(field)) continue;
    const std::string_view section = field.of_elements ? "ElementData" : "NodeData";
    const std::size_t n = field.components, count = cells != nullptr ? cells->items(field) : field.values.size() / n;
    text.line("${}\n1\n\"{}\"\n1\n0\n3\n0\n{}\n{}", section, unquoted(field.name), n, count);
    for (std::size_t i = 0; i < count; ++i) {
      out.put(static_cast<std::int32_t>(tag_of(field, i)));
      for (std::size_t k = 0; k < n; ++k)
        out.put(cells != nullptr ? cells->value_of(field, i, k) : field.values[i * n + k]);
      out.end_record();
    }
    out.close(section);
  }
}

/// Tags of physical groups: regions, patches and curves keep their numbers, regions of an image their labels; sets
/// follow.
std::vector<std::int32_t> physical_tags(const MeshParts& mesh);
void write_physical_names(TextWriter& out, const MeshParts& mesh, const std::vector<std::int32_t>& tags,
                          bool with_sets);

/// Nodes of an element of that dimension, by MixedCells.
std::size_t nodes_of_element(const MeshParts& mesh, const MixedCells& cells, std::size_t dimension, std::uint32_t i);

/// $Periodic: the pairs of nodes of entities of triangles, of which one is the copy of the other.
class PeriodicLinks {
 public:
  /// `entity_of`: per face the tag of its entity.
  PeriodicLinks(const MeshParts& mesh, FunctionRef<std::int32_t(std::size_t)> entity_of);

  std::size_t size() const { return links_.size(); }
  /// Calls visit(tag, tag of the original, matrix of the period, pairs {copy, original}) for each.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const auto& [link, pairs] : links_)
      visit(link[1], link[2], matrix_of(static_cast<std::size_t>(link[0])), pairs);
  }

 private:
  /// A period as the sixteen numbers of a matrix.
  std::array<double, 16> matrix_of(std::size_t period) const;

  const TetMesh& mesh_;
  std::map<std::array<std::int32_t, 3>, std::map<VertexIndex, VertexIndex>> links_;
};

}  // namespace octafront::io
