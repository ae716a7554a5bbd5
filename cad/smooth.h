#pragma once

#include "topology.h"

#include <vector>

namespace octafront::cad {

/// Whether an edge has two faces, or one on both sides, that have the same tangent plane at all these parameters of its
/// curve, within 1 degree.
bool is_smooth_across(const Topology& topology, const Topology::OfEdge& edge, const std::vector<double>& parameters);

}  // namespace octafront::cad
