#pragma once

// formats/write: writers, one source per format. They take a surface or MeshParts, and throw OutputError.

#include <octafront/tet_mesh.h>

#include "formats/containers/atomic_file.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"

namespace octafront {
struct SurfaceMesh;
}

namespace octafront::io {

void write_stl(AtomicFile& file, const SurfaceMesh& surface);
void write_obj(AtomicFile& file, const SurfaceMesh& surface);
void write_off(AtomicFile& file, const SurfaceMesh& surface);
void write_ply(AtomicFile& file, const SurfaceMesh& surface);

void write_vtu(MeshOutput& out, const MeshParts& mesh);
void write_vtk(MeshOutput& out, const MeshParts& mesh);
void write_msh(MeshOutput& out, const MeshParts& mesh);
void write_msh2(MeshOutput& out, const MeshParts& mesh);
void write_medit(MeshOutput& out, const MeshParts& mesh);
void write_medit_binary(MeshOutput& out, const MeshParts& mesh);
void write_abaqus(MeshOutput& out, const MeshParts& mesh);
void write_nastran(MeshOutput& out, const MeshParts& mesh);
void write_unv(MeshOutput& out, const MeshParts& mesh);
void write_ansys(MeshOutput& out, const MeshParts& mesh);
void write_lsdyna(MeshOutput& out, const MeshParts& mesh);
void write_febio(MeshOutput& out, const MeshParts& mesh);
void write_su2(MeshOutput& out, const MeshParts& mesh);
void write_netgen(MeshOutput& out, const MeshParts& mesh);
void write_tetgen(MeshOutput& out, const MeshParts& mesh);
void write_openfoam(MeshOutput& out, const MeshParts& mesh);
void write_exodus(MeshOutput& out, const MeshParts& mesh);

// With HDF5 only.
void write_med(MeshOutput& out, const MeshParts& mesh);
void write_xdmf(MeshOutput& out, const MeshParts& mesh);
void write_cgns(MeshOutput& out, const MeshParts& mesh);

}  // namespace octafront::io
