#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/edits/working_mesh.h"

namespace octafront::surface {

struct CoarsenCounts {
  std::uint64_t collapses = 0, flips = 0;
  std::uint64_t input_vertices_left = 0;
};

/// Collapses the input's own vertices into the points of the front, with Delaunay flips between passes, until none is
/// left (but those on seams) that connections, features and normals let go. Those left become free (or stay on their
/// curve).
void remove_input_vertices(WorkingMesh& mesh, const SizeField& sizes, const RunContext& context, CoarsenCounts& counts);

}  // namespace octafront::surface
