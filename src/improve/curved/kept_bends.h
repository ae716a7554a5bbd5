#pragma once

#include "improve/curved/bends.h"

namespace octafront::curved {

/// How edges and faces of a linear mesh are bent to be as those of a curved mesh `before` that have the same corners,
/// bit for bit by their coordinates. The order may be another than that of `before`: polynomials are taken, not nodes.
Bends kept_bends(const TetMesh& mesh, const TetMesh& before, int order);

}  // namespace octafront::curved
