#pragma once

#include <octafront/run_context.h>

#include "report/picture/canvas.h"
#include "report/picture/scene.h"

#include <cstdint>
#include <vector>

namespace octafront {

/// A parallel projection: lengths are the same everywhere in a picture.
struct Camera {
  Vec3 right, up, back;  ///< of length 1; back goes to the viewer
  Vec3 target;           ///< is in the middle of the window
  double scale = 1;      ///< pixels per unit
  Rectangle window;

  Pixel project(Vec3 p) const {
    const Vec3 d = p - target;
    return {(window.x0 + window.x1) / 2 + scale * dot(d, right), (window.y0 + window.y1) / 2 - scale * dot(d, up)};
  }
};

/// That looks from there. Where the view is along `up`, z is up, or else y. REQUIRES directions that are not zero.
Camera looking_from(Vec3 view, Vec3 up = {0, 0, 1});
/// Moves and scales it so that the corners of all triangles are in the window.
void fit(Camera& camera, const Scene& scene, const Rectangle& window);
/// So that a ball fills that part of the window.
void fit(Camera& camera, Vec3 middle, double radius, double part, const Rectangle& window);

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
