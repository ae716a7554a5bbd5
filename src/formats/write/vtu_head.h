#pragma once

#include "formats/containers/text_writer.h"
#include "formats/containers/vtk_xml.h"
#include "formats/containers/vtu_arrays.h"
#include "formats/parts/vtk_cells.h"

#include <cstdint>

namespace octafront::io {

inline void begin_grid(TextWriter& out, bool as_text = false) {
  out.line(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{}>\n"
      "  <UnstructuredGrid>",
      as_text ? "" : " compressor=\"vtkZLibDataCompressor\"");
}

inline void begin_piece(TextWriter& out, std::uint64_t points, std::uint64_t cells) {
  out << "    <Piece NumberOfPoints=\"" << points << "\" NumberOfCells=\"" << cells << "\">\n";
}

/// What a VTU file of a mesh begins with: names as field data, and the numbers of points and cells.
inline void begin_vtu(TextWriter& out, bool as_text, const VtkCells::Names& names, std::uint64_t points,
                      std::uint64_t cells) {
  begin_grid(out, as_text);
  out << "    <FieldData>\n";
  for (const auto& [name, number] : names)
    out.line("      <DataArray type=\"Int32\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>",
             escaped(name), number);
  out << "    </FieldData>\n";
  begin_piece(out, points, cells);
}

inline void end_vtu(TextWriter& out, VtuArrays& arrays) {
  out << "    </Piece>\n  </UnstructuredGrid>\n";
  arrays.write_data();
  out << "</VTKFile>\n";
}

}  // namespace octafront::io
