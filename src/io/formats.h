#pragma once

#include <octafront/io.h>

#include "io/atomic_file.h"

#include <filesystem>
#include <span>
#include <string>

namespace octafront::io {

/// One entry of the table of formats: what users are told, and the functions that do it.
struct Format {
  FormatInfo info;
  void (*write_surface)(AtomicFile&, const SurfaceMesh&);  ///< null: it cannot
  void (*write_mesh)(AtomicFile&, const TetMesh&);         ///< null: it cannot
};

/// All formats, surfaces first.
std::span<const Format> formats();

/// By the ending of the name, in either case; null if it is none of ours.
const Format* format_of(const std::filesystem::path& file);

/// ".stl, .obj, .off, .ply": the endings of the formats that can do what the member says.
std::string endings_that(bool FormatInfo::*can);

}  // namespace octafront::io
