#pragma once

// formats/read: readers, one source per format. They take the bytes of a file and leave a SurfaceFile or RawMesh,
// unrepaired, but with every index in range and every coordinate finite; they believe nothing that a file says about
// itself before its bytes bear it out.

// The readers, one per format: from bytes in memory to a SurfaceFile or a RawMesh. All throw InputError.

#include <octafront/io.h>

#include "formats/containers/input.h"
#include "formats/parts/raw_mesh.h"

namespace octafront::io {

SurfaceFile read_binary_stl(const Input& input);
SurfaceFile read_ascii_stl(const Input& input);
SurfaceFile read_obj(const Input& input);
SurfaceFile read_off(const Input& input);
SurfaceFile read_ply(const Input& input);
/// TetGen's .poly, or with `simple` its .smesh; nodes may stand in a file .node beside it, whose input `nodes` is then.
SurfaceFile read_poly(const Input& input, bool simple, const Input* nodes);
/// By the ending, with the nodes beside it.
SurfaceFile read_poly(const Input& input);

/// The lines and points of these formats alone.
LinesFile read_obj_lines(const Input& input);
LinesFile read_ply_lines(const Input& input);
/// A text with a point in each line; polygons end at empty lines.
LinesFile read_line_table(const Input& input);

RawMesh read_vtu(const Input& input);
RawMesh read_vtk(const Input& input);
RawMesh read_msh(const Input& input);
RawMesh read_medit(const Input& input);
RawMesh read_medit_binary(const Input& input);
RawMesh read_abaqus(const Input& input);
RawMesh read_nastran(const Input& input);
RawMesh read_unv(const Input& input);
RawMesh read_netgen(const Input& input);
/// `input` is the .ele or .node file; the others are read beside it.
RawMesh read_tetgen(const Input& input);
/// The file with the values is read beside it.
RawMesh read_xdmf(const Input& input);
/// By the name of the input: HDF5 reads files itself.
RawMesh read_med(const Input& input);

/// Recognise and read.
SurfaceFile read_surface_bytes(const Input& input);
/// A mesh in whatever format it is.
RawMesh read_raw_mesh(const Input& input);
MeshFile read_mesh_bytes(const Input& input);

}  // namespace octafront::io
