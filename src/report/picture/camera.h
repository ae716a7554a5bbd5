#pragma once

#include "report/picture/canvas.h"
#include "report/picture/scene.h"

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

}  // namespace octafront
