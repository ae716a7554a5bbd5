#pragma once

#include "base/geometry/leeway.h"
#include "surface/edits/working_mesh.h"

#include <cstdint>
#include <vector>

namespace octafront::surface {

/// Closes what feature lines leave too narrow for an element: lines that part at a few degrees, that run side by side,
/// or that nearly touch. Such lines are mostly one line of the input, drawn with needles. The short edge of a bad
/// triangle between two of them collapses, even if the lines merge then; a line along a flat triangle runs through its
/// apex instead. Vertices move by a quarter of the size at most, and by no more than `tolerance` (input units) and
/// the leeway there. Only where the worst triangle around gets better, patches remain and no triangle turns over.
/// Vertices marked in `is_fixed` (by number, the rest is not) stay. Returns the number of operations.
std::uint64_t merge_lines(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed, double tolerance,
                          const Leeway& leeway);

}  // namespace octafront::surface
