// VTK's parallel unstructured grid: NAME.pvtu, which names the pieces, and a folder NAME with NAME_0000.vtu and so on.
// The index says from names alone which arrays they have.

#include "formats/containers/text_writer.h"
#include "formats/containers/vtk_xml.h"
#include "formats/write/vtk_pieces.h"
#include "formats/write/writers.h"

#include <string>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Beside the index, of its name without the ending.
std::filesystem::path folder_of_pieces(const std::filesystem::path& target) {
  const std::filesystem::path folder = target.parent_path() / target.stem();
  return target.has_extension() ? folder : std::filesystem::path(folder.string() + "_pieces");
}

void index_array(TextWriter& out, std::string_view type, std::string_view name, std::size_t components = 1) {
  out.line("      <PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>", type, name, components);
}

/// The arrays that VtuWriter declares, in its order.
void index_arrays(TextWriter& out, const MeshParts& mesh, std::span<const MeshField> fields, const VtkWhole& whole,
                  bool of_points) {
  index_array(out, "UInt8", kGhostType);
  index_array(out, kIdType, of_points ? "GlobalPointIds" : "GlobalCellIds");
  if (!of_points) index_array(out, "Int32", "part");
  for (const VtkCells::Data& data : VtkCells::data_of(mesh, whole.shown))
    if (data.of_points == of_points) index_array(out, data.is_set ? "UInt8" : "Int32", escaped(data.name));
  for (const MeshField& field : fields)
    if (field.of_elements != of_points) index_array(out, "Float64", escaped(field.name), field.components);
  if (!of_points) index_array(out, "Float32", "beta");
}

}  // namespace

std::string piece_name(std::string_view stem, std::uint32_t piece, std::string_view ending) {
  return fmt::format("{}_{:04}{}", stem, piece, ending);
}

std::filesystem::path begin_pvtu(MeshOutput& out) {
  return out.folder(folder_of_pieces(out.target()));
}

void write_pvtu_piece(const std::filesystem::path& folder, const std::filesystem::path& target, const Piece& piece,
                      const VtkWhole& whole, const RunContext& context, bool as_text) {
  AtomicFile file(folder / piece_name(target.stem().string(), piece.number, ".vtu"), context);
  write_vtu_piece(file, VtkPiece(piece, whole), as_text);
  file.commit();
}

void end_pvtu(MeshOutput& output, const MeshParts& mesh, std::span<const MeshField> fields, const VtkWhole& whole,
              std::uint32_t parts) {
  const std::filesystem::path& target = output.target();
  TextWriter out(output.file());
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
         "  <PUnstructuredGrid GhostLevel=\"1\">\n";
  out.line("    <PPointData{}>", kGlobalPointIds);
  index_arrays(out, mesh, fields, whole, true);
  out.line("    </PPointData>\n    <PCellData Scalars=\"beta\"{}>", kGlobalCellIds);
  index_arrays(out, mesh, fields, whole, false);
  out << "    </PCellData>\n    <PPoints>\n";
  index_array(out, "Float64", "Points", 3);
  out << "    </PPoints>\n";
  const std::string folder = folder_of_pieces(target).filename().string();
  for (std::uint32_t k = 0; k < parts; ++k)
    out.line("    <Piece Source=\"{}/{}\"/>", escaped(folder), escaped(piece_name(target.stem().string(), k, ".vtu")));
  out << "  </PUnstructuredGrid>\n</VTKFile>\n";
}

void write_pvtu(MeshOutput& out, Pieces& pieces) {
  const VtkWhole whole = VtkWhole::of(pieces);
  const std::filesystem::path folder = begin_pvtu(out);
  for (std::uint32_t k = 0; k < pieces.count(); ++k)
    write_pvtu_piece(folder, out.target(), pieces.piece(k), whole, out.context(), out.as_text());
  end_pvtu(out, pieces.whole(), pieces.fields(), whole, pieces.count());
}

void check_pvtu_target(const std::filesystem::path& target, std::uint32_t) {
  check_writable(target);
  check_folder_of_pieces(folder_of_pieces(target), target.stem().string(), ".vtu");
}

}  // namespace octafront::io
