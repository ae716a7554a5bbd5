#pragma once

#include <octafront/run_context.h>

#include "report/picture/camera.h"
#include "report/picture/scene.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// How finely a picture is drawn.
struct RasterOptions {
  int samples = 3;  ///< along each side of a pixel, 1 to 4
  Rectangle clip;   ///< nothing is drawn outside
};

/// Draws the triangles of a scene into the whole picture, the nearest in front; where nothing is it stays as it is.
/// Returns for each pixel the face in its middle, kNone where there is none.
///
/// Corners are rounded to a 256th of a sample, then whole numbers decide which samples a triangle covers, so triangles
/// that share an edge leave no gap and never both take one; of equally near triangles the first is in front. Strong
/// lines go over what is as near. Rows are drawn by several threads, a band each.
std::vector<std::uint32_t> rasterise(const Scene& scene, const Camera& camera, Picture& picture,
                                     const RasterOptions& options, const RunContext& context);

}  // namespace octafront
