#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include "sizing/background_grid.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace octafront {

/// What the sampling asks at a place of a triangle; at least one must answer. Input units.
struct PlaceOnSurface {
  Vec3 p, n;  ///< n: unit normal
  std::uint32_t face;
};
using SizeAtPlace = std::function<double(const PlaceOnSurface&)>;

/// Samples of a surface, dense enough for its sizes: triangles longer than the size at their centroid are halved along
/// their longest edge until they are not. `face_size` bounds the size on each triangle; `size_at`, which may be empty,
/// may ask for less at a place. Throws OptionError if more than 50 million samples were needed.
std::vector<SizeSample> sample_surface(const SurfaceMesh& surface, const std::vector<double>& face_size,
                                       const SizeAtPlace& size_at, const RunContext& context);

}  // namespace octafront
