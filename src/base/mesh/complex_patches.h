#pragma once

namespace octafront {

struct SurfaceMesh;

/// Gives each pair of regions of each patch of a complex a patch of its own. One that has no name yet is called by the
/// regions on its sides, "bone|skin", or by the one region behind it; where a name stood for several pairs, the regions
/// follow it: "wall (bone|skin)". Numbered by patch, in order of the first triangle of each pair.
void divide_by_sides(SurfaceMesh& complex);

}  // namespace octafront
