#pragma once

// Better triangles once the front has gone: flips, smoothing, small mending (shaping), lengths that
// fit the sizes (lengths). Takes the mesh, leaves it with the same lines.

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/edits/working_mesh.h"
#include "surface/lines/curves.h"

namespace octafront::surface {

struct ImproveCounts {
  std::uint64_t flips = 0, moves = 0, splits = 0, collapses = 0;
};

/// Makes the triangles of the working mesh better: flips towards six triangles a vertex and towards Delaunay, and
/// smoothing along the input surface, of division points along their curves. Corners stay; the others move only where
/// the mean quality of their triangles rises.
void improve_surface(WorkingMesh& mesh, const InputSurface& input, const std::vector<Curve>& curves,
                     const SizeField& sizes, const RunContext& context, ImproveCounts& counts);

}  // namespace octafront::surface
