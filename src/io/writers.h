#pragma once

// The writers, one per format. All throw OutputError.

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "io/atomic_file.h"

namespace octafront::io {

void write_stl(AtomicFile& file, const SurfaceMesh& surface);
void write_obj(AtomicFile& file, const SurfaceMesh& surface);
void write_off(AtomicFile& file, const SurfaceMesh& surface);
void write_ply(AtomicFile& file, const SurfaceMesh& surface);

void write_vtu(AtomicFile& file, const TetMesh& mesh);
void write_msh(AtomicFile& file, const TetMesh& mesh);
void write_medit(AtomicFile& file, const TetMesh& mesh);

}  // namespace octafront::io
