#pragma once

// formats/table: the one table of formats: endings, what each holds and loses, the functions that write it; and what
// a file is, recognised by content.

#include <octafront/io.h>

#include "formats/containers/atomic_file.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"
#include "formats/pieces/pieces.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace octafront::io {

/// One entry of the table of formats: what users are told, and the functions that do it.
struct Format {
  FormatInfo info;
  void (*write_surface)(AtomicFile&, const SurfaceMesh&);       ///< null: it cannot
  void (*write_mesh)(MeshOutput&, const MeshParts&) = nullptr;  ///< null: it cannot, or not in this build
  bool is_folder = false;
  void (*write_parts)(MeshOutput&, Pieces&) = nullptr;  ///< null: it cannot; alone: always in parts
  /// Instead of looking whether the one file, or the folder, can be written.
  void (*check_parts)(const std::filesystem::path&, std::uint32_t parts) = nullptr;
};

/// All formats, surfaces first.
std::span<const Format> formats();

/// By the ending of the name, in either case; null if it is none of ours. Where endings clash, the first of the table.
const Format* format_of(const std::filesystem::path& file);
/// By its name, in either case; null if there is none.
const Format* format_named(std::string_view name);

/// ".stl, .obj, .off, .ply": the endings of the formats that can do what the member says.
std::string endings_that(bool FormatInfo::*can);

/// What of a mesh a format does not hold, in sentences.
std::vector<std::string> losses(const FormatInfo& format, const MeshParts& mesh);

}  // namespace octafront::io
