#pragma once

#include <octafront/run_context.h>

#include "fill/recovery/exact_points.h"
#include "fill/recovery/labelled_complex.h"

#include <cstdint>

namespace octafront::recovery {

/// What the steps of one attempt at a surface work on.
struct RecoveryTask {
  ExactPoints& points;  ///< those of the surface, of the frame, and the Steiner points behind
  LabelledComplex& mesh;
  VertexIndex frame;   ///< the first of its kFrameVertices, which lie away from the surface and are not coplanar
  std::uint32_t seed;  ///< other seeds make other choices
  const RunContext& context;
};

}  // namespace octafront::recovery
