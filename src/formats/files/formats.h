#pragma once

// formats/files: the one table of formats: endings, what each holds and loses, how it is told, the functions that read
// and write it. To add one: a source in formats/read, one in formats/write, and a row.

#include <octafront/io.h>
#include <octafront/poly_mesh.h>

#include "formats/containers/atomic_file.h"
#include "formats/containers/file_head.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/pieces.h"
#include "formats/parts/raw_mesh.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace octafront::io {

/// One entry of the table of formats: what users are told, and the functions that do it.
struct Format {
  FormatInfo info;
  void (*write_surface)(AtomicFile&, const SurfaceMesh&) = nullptr;  ///< null: it cannot
  void (*write_mesh)(MeshOutput&, const MeshParts&) = nullptr;       ///< null: it cannot, or not in this build
  bool is_folder = false;
  void (*write_parts)(MeshOutput&, Pieces&) = nullptr;  ///< null: it cannot; alone: always in parts
  void (*write_polyhedra)(MeshOutput&, const MeshParts&, const PolyMesh&) = nullptr;  ///< null: it cannot
  /// Instead of looking whether the one file, or the folder, can be written.
  void (*check_parts)(const std::filesystem::path&, std::uint32_t parts) = nullptr;
  Told (*told)(const FileHead&) = nullptr;  ///< null: another row tells
  SurfaceFile (*read_surface)(const Input&) = nullptr;
  RawMesh (*read_mesh)(const Input&) = nullptr;     ///< surfaces too, of formats that hold them alone
  LinesFile (*read_lines)(const Input&) = nullptr;  ///< null: those of the mesh, if it reads one
};

/// All formats, surfaces first.
std::span<const Format> formats();

/// By the ending of the name, in either case; null if it is none of ours. Where endings clash, the first of the table.
const Format* format_of(const std::filesystem::path& file);
/// What the bytes are, whatever the name; the name decides only where the bytes leave a choice. Throws InputError with
/// what the file looks like instead. Surfaces come in formats of meshes, too, but not the other way round.
const Format& recognize_surface(const Input& input);
const Format& recognize_mesh(const Input& input);

/// Recognise and read.
SurfaceFile read_surface_bytes(const Input& input);
/// A mesh in whatever format it is.
RawMesh read_raw_mesh(const Input& input);
MeshFile read_mesh_bytes(const Input& input);

/// By its name, in either case; null if there is none.
const Format* format_named(std::string_view name);

/// ".stl, .obj, .off, .ply": the endings of the formats that can do what the member says.
std::string endings_that(bool FormatInfo::*can);

/// What of a mesh a format does not hold, in sentences.
std::vector<std::string> losses(const FormatInfo& format, const MeshParts& mesh);
/// The same of fields: their names, and the formats that hold them; empty: nothing is lost.
std::string loss_of_fields(const FormatInfo& format, std::span<const MeshField> fields);

}  // namespace octafront::io
