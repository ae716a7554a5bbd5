#pragma once

#include "formats/containers/input.h"
#include "formats/parts/raw_mesh.h"
#include "formats/parts/wide_orders.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace octafront::io {

/// Data of the cells of a VTK file; each empty or one per cell. Numbers are references: counted from 1.
struct VtkCellData {
  std::vector<std::int64_t> region, patch, curve, source, layers;
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> sets;  ///< not 0: a member
  std::vector<double> field = {};                                       ///< that Input::field asks for
  std::uint64_t field_components = 1;                                   ///< of it for each cell
};

/// Whether an array is a set as vtk_cells.h has them: "nodes NAME", "faces NAME".
bool is_set_name(std::string_view array);

/// Whether an array numbers things, as those of vtk_cells.h do, or those that meshio makes of other formats.
bool is_numbering(std::string_view array);

/// An array of whole numbers of another program, one per cell.
struct CellNumbers {
  std::string name;
  std::vector<std::int64_t> values;
};
/// That of them which tells materials: by names that programs give it, else the only one that does not number the
/// cells through. Empty if there is none. A note says which, and which others are left out.
std::vector<std::int64_t> material_of(std::vector<CellNumbers> arrays, std::vector<std::string>& notes);

/// Takes the cells of a VTK file one by one: tetrahedra, triangles and lines, linear or quadratic.
class VtkCellTaker {
 public:
  VtkCellTaker(const Input& input, RawMesh& raw, const VtkCellData& data, const WideOrder& order = kVtkWide);
  /// Throws InputError for nodes out of range.
  void take(std::uint64_t cell, std::int64_t type, std::span<const std::int64_t> nodes);
  /// Hands over the sets.
  void finish();

 private:
  VertexIndex node(std::uint64_t cell, std::int64_t index) const;
  /// Sources and layers of the triangles since the last call, which this cell is.
  void take_face_data(std::uint64_t cell);

  const Input& input_;
  RawMesh& raw_;
  const VtkCellData& data_;
  const WideOrder& order_;
  std::vector<RawMesh::Group> groups_;
};

void add_node_set(RawMesh& raw, std::string_view array, std::span<const std::int64_t> is_member);
/// A field "patch NAME" with the number of the patch, and the like.
void add_vtk_name(RawMesh& raw, std::string_view array, std::int64_t number);

}  // namespace octafront::io
