#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include "soup/cells/misfit.h"

#include <cstdint>
#include <vector>

namespace octafront::cells {

/// A triangle of a body, and which one of the soup it is part of.
struct BodyFace {
  Triangle corners;
  std::uint32_t body, source;
};

/// Where a body lies on earlier ones, all its corners there theirs, its wall becomes theirs, triangle by triangle; what
/// it was between the corners does not count. Only where the body stays closed: else nothing changes.
void share_walls(const std::vector<Vec3>& points, const std::vector<BodyFace>& earlier, std::vector<BodyFace>& later,
                 const Misfits& misfits, const RunContext& context);

}  // namespace octafront::cells
