#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include <vector>

namespace octafront::mend {

struct Separated {
  std::vector<Vec3> places;   ///< of the vertices that were there more than once
  std::vector<double> moves;  ///< how far the farthest copy of each went
  bool done = true;           ///< false: some copies find no place of their own; the surface is as it was
};

/// Draws apart what touches itself in edges and vertices only: each part gets vertices of its own, whose tips move away
/// from each other, by no more than `most`; tips that have no way to go are cut off. Requires triangles that meet in
/// shared vertices and edges only, with the outside in front.
Separated separate_contacts(SurfaceMesh& surface, double most, const RunContext& context);

}  // namespace octafront::mend
