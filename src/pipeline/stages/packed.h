#pragma once

#include <octafront/report.h>
#include <octafront/tet_mesh.h>

#include "base/comm/packing.h"
#include "surface/remeshing/remesh.h"

namespace octafront {

/// A mesh and its boundary once they are improved.
struct ImprovedMesh {
  TetMesh mesh;
  Remeshed boundary;
};

/// What goes from stage to stage, as bytes for a later run of the same program.
void pack(const TetMesh& mesh, Packer& to);
void pack(const Remeshed& made, Packer& to);
void pack(const ImprovedMesh& improved, Packer& to);
void pack(const StageReport& stage, Packer& to);

template <class Result>
Result unpacked(Unpacker& from);
template <>
TetMesh unpacked(Unpacker& from);
template <>
Remeshed unpacked(Unpacker& from);
template <>
ImprovedMesh unpacked(Unpacker& from);
template <>
StageReport unpacked(Unpacker& from);

}  // namespace octafront
