#pragma once

// formats/files: files in and out. It takes the bytes of a file, recognises their kind by content, and leaves a
// SurfaceFile or a TetMesh behind, unrepaired but with every index in range and every coordinate finite; the other
// way, it writes surfaces and meshes so that a file is either complete or not there. Readers believe nothing that a
// file says about itself before its bytes bear it out.
//
// To add a format: a reader in read/readers.h with its case in table/recognize.cpp, a writer in write/writers.h, a line
// in table/formats.cpp.
