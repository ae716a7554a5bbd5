#pragma once

// io: files in and out. It takes the bytes of a file, recognises their kind by content, and leaves a SurfaceFile or a
// TetMesh behind, unrepaired but with every index in range and every coordinate finite; the other way, it writes
// surfaces and meshes so that a file is either complete or not there. Readers believe nothing that a file says about
// itself before its bytes bear it out.
//
// One file per format and direction (read_ply.cpp, write_ply.cpp); formats.h has the one table of formats. To add one:
// a reader in readers.h with its case in recognize.cpp, a writer in writers.h, a line in formats.cpp.
//
// input.h            bytes, and complaints about places in them
// scanner.h          words and numbers of a text
// surface_builder.h  faces to triangles; polygon.h divides polygons
// raw_mesh.h         elements of a file to an ordered TetMesh
// atomic_file.h      written beside, renamed into place

#include <octafront/io.h>

#include "io/formats.h"
#include "io/readers.h"
#include "io/writers.h"
