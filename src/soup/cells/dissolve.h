#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include <cstdint>
#include <vector>

namespace octafront::cells {

/// Takes vertices out of a complex that only the meeting of walls made: each goes to a neighbour, along its line where
/// it is on one, if nothing deviates from where it was by more than `most`, folds, or crosses. Others stay where they
/// are. Regions, patches and lines stay what they are. Returns how many went.
std::uint64_t dissolve(SurfaceMesh& complex, const std::vector<char>& may_go, double most, const RunContext& context);

}  // namespace octafront::cells
