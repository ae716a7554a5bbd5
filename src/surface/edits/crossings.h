#pragma once

#include <octafront/surface_mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace octafront::surface {

/// Pairs of triangles that meet in more than what they share, exactly; the smaller id first, sorted. Degenerate
/// triangles pair with themselves.
std::vector<std::array<std::uint32_t, 2>> find_crossings(const SurfaceMesh& surface);

}  // namespace octafront::surface
