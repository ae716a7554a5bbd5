#pragma once

#include <octafront/io.h>

#include "formats/containers/file_head.h"
#include "formats/containers/input.h"
#include "formats/parts/raw_mesh.h"

namespace octafront::io {

// formats/read: readers, one source per format. They take the bytes of a file and leave a SurfaceFile or RawMesh,
// unrepaired, but with every index in range and every coordinate finite; they believe nothing that a file says about
// itself before its bytes bear it out.

// The readers, one per format: how surely a file is one of theirs, and from bytes in memory to a SurfaceFile or a
// RawMesh. All throw InputError.

Told told_stl(const FileHead& head);
SurfaceFile read_stl(const Input& input);
Told told_obj(const FileHead& head);
SurfaceFile read_obj(const Input& input);
Told told_off(const FileHead& head);
SurfaceFile read_off(const Input& input);
Told told_ply(const FileHead& head);
SurfaceFile read_ply(const Input& input);
Told told_freesurfer(const FileHead& head);
SurfaceFile read_freesurfer(const Input& input);
Told told_poly(const FileHead& head);
/// TetGen's .poly, or with `simple` its .smesh; nodes may stand in a file .node beside it, whose input `nodes` is then.
SurfaceFile read_poly(const Input& input, bool simple, const Input* nodes);
/// By the ending, with the nodes beside it.
SurfaceFile read_poly(const Input& input);

/// The lines and points of these formats alone.
LinesFile read_obj_lines(const Input& input);
LinesFile read_ply_lines(const Input& input);
/// A text with a point in each line; polygons end at empty lines.
LinesFile read_line_table(const Input& input);

Told told_vtu(const FileHead& head);
RawMesh read_vtu(const Input& input);
Told told_vtk(const FileHead& head);
RawMesh read_vtk(const Input& input);
Told told_msh(const FileHead& head);
RawMesh read_msh(const Input& input);
Told told_medit(const FileHead& head);
RawMesh read_medit(const Input& input);
Told told_medit_binary(const FileHead& head);
RawMesh read_medit_binary(const Input& input);
Told told_mfem(const FileHead& head);
RawMesh read_mfem(const Input& input);
Told told_abaqus(const FileHead& head);
RawMesh read_abaqus(const Input& input);
Told told_nastran(const FileHead& head);
RawMesh read_nastran(const Input& input);
Told told_unv(const FileHead& head);
RawMesh read_unv(const Input& input);
Told told_netgen(const FileHead& head);
RawMesh read_netgen(const Input& input);
Told told_tetgen(const FileHead& head);
/// `input` is the .ele or .node file; the others are read beside it.
RawMesh read_tetgen(const Input& input);
// With HDF5 only.
/// The file with the values is read beside it.
RawMesh read_xdmf(const Input& input);
/// By the name of the input: HDF5 reads files itself.
RawMesh read_med(const Input& input);

/// The files of one mesh; null: there is none.
struct TetgenFiles {
  const Input &node, &ele;
  const Input *face, *edge;
};

RawMesh read_tetgen(const TetgenFiles& files);

}  // namespace octafront::io
