#pragma once

// The readers, one per format: from bytes in memory to a SurfaceFile or a TetMesh. All throw InputError.

#include <octafront/io.h>

#include "io/input.h"

namespace octafront::io {

SurfaceFile read_binary_stl(const Input& input);
SurfaceFile read_ascii_stl(const Input& input);
SurfaceFile read_obj(const Input& input);
SurfaceFile read_off(const Input& input);
SurfaceFile read_ply(const Input& input);

TetMesh read_vtu(const Input& input);
TetMesh read_msh(const Input& input);
TetMesh read_medit(const Input& input);

/// Recognise and read.
SurfaceFile read_surface_bytes(const Input& input);
TetMesh read_mesh_bytes(const Input& input);

}  // namespace octafront::io
