#pragma once

#include <octafront/surface_mesh.h>

#include <vector>

namespace octafront {

/// Gives each pair of regions of each patch of a complex a patch of its own. One that has no name yet is called by the
/// regions on its sides, "bone|skin", or by the one region behind it; where a name stood for several pairs, the regions
/// follow it: "wall (bone|skin)". Numbered by patch, in order of the first triangle of each pair.
void divide_by_sides(SurfaceMesh& complex);

/// The regions on the sides of each patch of a complex whose patches are divided so.
std::vector<Sides> sides_of_patches(const SurfaceMesh& complex);

}  // namespace octafront
