#pragma once

#include "formats/containers/input.h"
#include "formats/parts/raw_mesh.h"

namespace octafront::io {

/// The files of one mesh; null: there is none.
struct TetgenFiles {
  const Input &node, &ele;
  const Input *face, *edge;
};

RawMesh read_tetgen(const TetgenFiles& files);

}  // namespace octafront::io
