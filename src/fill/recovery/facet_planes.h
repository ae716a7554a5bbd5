#pragma once

#include "fill/recovery/exact_points.h"

#include <vector>

namespace octafront::recovery {

/// Per triangle the number of its plane: triangles that share an edge and lie in one plane, exactly, share the number.
std::vector<std::uint32_t> facet_planes(const ExactPoints& points, const std::vector<Triangle>& triangles);

}  // namespace octafront::recovery
