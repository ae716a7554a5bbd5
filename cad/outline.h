#pragma once

#include "part.h"
#include "topology.h"

namespace octafront::cad {

/// What is known without triangles: solids, labels, areas, volumes, which faces meet in edges, what surfaces a few
/// numbers give, which faces of a contact are one piece, notes.
CadModel model_without_triangles(const Part& part, const Topology& topology);

}  // namespace octafront::cad
