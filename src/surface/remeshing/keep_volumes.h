#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include "base/mesh/features.h"

#include <cstdint>

namespace octafront::remeshing {

/// Gives the regions of a complex the volumes that they had as triangles of the input: chords cut off what bulges. One
/// pressure per region moves the vertices inside patches, by a fifth of their shortest edge at most; those of features
/// and of flat parts stay. What crosses after that goes back. Returns how many vertices moved.
std::uint64_t keep_volumes(SurfaceMesh& complex, const Features& features, const SurfaceMesh& input,
                           const RunContext& context);

}  // namespace octafront::remeshing
