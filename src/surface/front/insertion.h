#pragma once

#include <octafront/run_context.h>

#include "surface/edits/working_mesh.h"
#include "surface/front/surface_front.h"

namespace octafront::surface {

struct InsertionCounts {
  std::uint64_t inserted = 0;  ///< as new vertices
  std::uint64_t adopted = 0;   ///< input vertices that are points of the front
  std::uint64_t skipped = 0;   ///< too near to a feature or to another point
};

/// The input triangulation with the points of the front put in: each in the face or edge where it lies.
WorkingMesh insert_points(const InputSurface& input, const std::vector<Curve>& curves, const FrontPoints& front,
                          const RunContext& context, InsertionCounts& counts);

}  // namespace octafront::surface
