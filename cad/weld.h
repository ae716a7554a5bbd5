#pragma once

#include "part.h"
#include "topology.h"

#include <functional>
#include <vector>

namespace octafront::cad {

/// Fills in the triangles that the faces have, welded by topology, edges as polylines, and geometry as records.
/// `rung`: per face, of triangulate(). `on_face`: called before each face's record.
void add_triangles(const Part& part, const Topology& topology, const Fineness& fineness, const std::vector<int>& rung,
                   const std::function<void(std::size_t)>& on_face, CadModel& model);

}  // namespace octafront::cad
