#pragma once

#include <octafront/mesh_field.h>

#include "formats/parts/mesh_parts.h"
#include "formats/parts/mixed_cells.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront::io {

/// A mesh as the cells of VTK: tetrahedra, pyramids, wedges, then triangles, quadrilaterals, then edges of curves; and
/// the data on them. Of cells:
///   region  body of a tetrahedron; a face has that of its tetrahedron
///   label   of the image, of a region's elements and of their faces (only where regions are labels)
///   patch   of a face; -1 for others
///   curve   of an edge; -1 for others (only where there are curves)
///   source  input face that a face of the boundary still is; -1 for others (only where there is one)
///   "nodes NAME", "edges NAME", "faces NAME", "elements NAME"   1 for the members of a set, 0 for others
/// Names of regions, patches and curves are field data: an array "patch NAME" that holds the number of the patch.
class VtkCells {
 public:
  /// Arrays that only some meshes have.
  struct Shown {
    bool label = false, curve = false, source = false, layers = false;
    static Shown of(const MeshParts& mesh);
  };
  struct Data {
    std::string name;
    bool of_points;
    bool is_set;  ///< 0 or 1
  };

  explicit VtkCells(const MeshParts& mesh) : VtkCells(mesh, Shown::of(mesh)) {}
  /// With these arrays: those of the whole, of a piece of it.
  VtkCells(const MeshParts& mesh, const Shown& shown);

  /// All arrays of such a mesh but beta.
  static std::vector<Data> data_of(const MeshParts& mesh, const Shown& shown);

  std::uint64_t size() const { return ends_.back(); }
  /// Nodes of all cells together.
  std::uint64_t nodes() const { return end_of(size() - 1); }
  std::uint8_t type(std::uint64_t cell) const { return types_[kind(cell)]; }
  /// Where the nodes of a cell end in the list of all.
  std::uint64_t end_of(std::uint64_t cell) const;
  std::uint64_t nodes_of(std::uint64_t cell) const { return each_[kind(cell)]; }
  /// One of all nodes.
  VertexIndex node(std::uint64_t at) const;
  /// The tetrahedron that speaks for a cell, of pyramids and wedges the first one; kNone for edges.
  TetIndex tet_of(std::uint64_t cell) const;
  /// Where faces and edges begin among the cells.
  std::uint64_t first_face() const { return ends_[kWedges]; }
  std::uint64_t first_edge() const { return ends_[kQuads]; }
  const MixedCells& elements() const { return cells_; }

  /// All arrays but beta.
  const std::vector<Data>& data() const { return data_; }
  std::int32_t value(std::size_t data, std::uint64_t at) const;
  /// Of a field the number `component` of a point, or of the element of a cell; 0 where there is none.
  double value_of(const MeshField& field, std::uint64_t at, std::uint64_t component) const {
    const std::uint64_t item = field.of_elements ? tet_of(at) : at;
    return item == kNone ? 0 : field.values[item * field.components + component];
  }
  using Names = std::vector<std::pair<std::string, std::uint32_t>>;
  /// "patch NAME" and its number, for all names.
  static Names names_of(const MeshParts& mesh);
  Names names() const { return names_of(mesh_); }

 private:
  enum Kind : std::size_t { kTets, kPyramids, kWedges, kTriangles, kQuads, kEdges, kKinds };
  Kind kind(std::uint64_t cell) const;
  bool is_face(Kind kind) const { return kind == kTriangles || kind == kQuads; }
  std::int32_t number(std::string_view name, std::uint64_t cell) const;

  const MeshParts& mesh_;
  MixedCells cells_;
  std::array<std::uint64_t, kKinds> ends_;  ///< of the cells of a kind
  std::array<std::uint64_t, kKinds> each_;  ///< nodes of one
  std::array<std::uint8_t, kKinds> types_;
  std::vector<Data> data_;
  std::vector<std::vector<bool>> sets_;  ///< of the last data, by point or cell
};

}  // namespace octafront::io
