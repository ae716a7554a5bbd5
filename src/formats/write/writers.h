#pragma once

// formats/write: writers, one source per format. They take a surface or MeshParts, and throw OutputError.

#include <octafront/poly_mesh.h>

#include "formats/containers/atomic_file.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/pieces.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

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
void write_simnibs(MeshOutput& out, const MeshParts& mesh);
void write_medit(MeshOutput& out, const MeshParts& mesh);
void write_medit_binary(MeshOutput& out, const MeshParts& mesh);
void write_mfem(MeshOutput& out, const MeshParts& mesh);
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

// Meshes in parts, a piece at a time.
void write_pvtu(MeshOutput& out, Pieces& pieces);
void write_msh_parts(MeshOutput& out, Pieces& pieces);
void write_openfoam_parts(MeshOutput& out, Pieces& pieces);

/// "STEM_0007.vtu".
std::string piece_name(std::string_view stem, std::uint32_t piece, std::string_view ending);
/// Throws OutputError if the files that these make cannot be written, or would replace what is not theirs.
void check_pvtu_target(const std::filesystem::path& target, std::uint32_t parts);
void check_openfoam_parts(const std::filesystem::path& target, std::uint32_t parts);

// The same as polyhedra; parts tell of regions and patches.
void write_vtu_polyhedra(MeshOutput& out, const MeshParts& parts, const PolyMesh& mesh);
void write_openfoam_polyhedra(MeshOutput& out, const MeshParts& parts, const PolyMesh& mesh);

// With HDF5 only.
void write_med(MeshOutput& out, const MeshParts& mesh);
void write_xdmf(MeshOutput& out, const MeshParts& mesh);
void write_cgns(MeshOutput& out, const MeshParts& mesh);
void write_cgns_polyhedra(MeshOutput& out, const MeshParts& parts, const PolyMesh& mesh);
void write_vtkhdf(MeshOutput& out, const MeshParts& mesh);
void write_vtkhdf_parts(MeshOutput& out, Pieces& pieces);

}  // namespace octafront::io
