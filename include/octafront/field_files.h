#pragma once

#include <octafront/io.h>
#include <octafront/mesh_field.h>

#include <span>
#include <string>
#include <vector>

namespace octafront {

/// The fields of a file that a mesh was read from.
struct FieldsOfFile {
  std::vector<MeshField> fields;   ///< in the order of the file
  std::vector<std::string> notes;  ///< what was left out, and why
};

/// Reads what VTU, legacy VTK, Gmsh MSH, XDMF and MED have at points (VTU, VTK and MED up to 9 numbers each, else one)
/// and in tetrahedra (VTU and VTK up to 9 each, else one) of a mesh that was read from `file`: all fields, or those
/// with these names; not what numbers parts or names sets. Fields with values that are not finite, or not of all points
/// or elements, are left out with a note; if they were named, InputError. Throws InputError also where the points or
/// elements are not those of the mesh.
FieldsOfFile read_fields(const std::string& file, const TetMesh& mesh, const std::vector<std::string>& names = {},
                         const RunContext& context = {});

/// write_mesh(), with fields on the mesh. A note says what a format cannot hold (FormatHolds::fields). Wedges and
/// pyramids have the value of their first tetrahedron; of second order, or in parts, they lose fields. Faces have the
/// value of the element that they look out of, edges 0. Throws OutputError for a field of another length.
std::vector<std::string> write_mesh(const std::string& file, const TetMesh& mesh, std::span<const MeshField> fields,
                                    const RunContext& context = {}, const WriteOptions& options = {});

}  // namespace octafront
