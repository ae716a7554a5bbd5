#pragma once

#include "part.h"
#include "topology.h"

#include <functional>
#include <vector>

namespace octafront::cad {

/// How a face's triangles are tried: as asked, four times coarser inside, sixteen times, not at all.
inline constexpr int kLastRung = 3;

/// Triangulates all faces on common points of their edges, by the library. A face that throws, or that takes too
/// many steps, is tried coarser. `first_rung`: per face, where to begin; returned: where each ended.
/// `on_face`: called before each.
std::vector<int> triangulate(const Part& part, const Topology& topology, const Fineness& fineness,
                             const std::vector<int>& first_rung, const std::function<void(std::size_t)>& on_face);

}  // namespace octafront::cad
