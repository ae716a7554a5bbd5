#pragma once

#include <octafront/surface_mesh.h>

namespace octafront::testing {

// Round bodies as programs facet them, each in its own way.

/// A cylinder along z; its first corner is turned by so many radians.
SurfaceMesh faceted_pin(int sides, double radius, double low, double high, double turn = 0);

/// A ring along z from 0, with as many sides inside as outside.
SurfaceMesh faceted_ring(int sides, double inner, double outer, double height);

/// What fills a hole of radius 1 that opens as a cone, and a plate with that hole, 1.2 high.
SurfaceMesh faceted_plug(int sides, double turn);
SurfaceMesh faceted_countersink(int sides);

/// A ball by longitude and latitude.
SurfaceMesh faceted_ball(int around, int down, double radius);

/// The part of a ring between two angles, radians, from `low` to `high`.
SurfaceMesh faceted_segment(int sides, double inner, double outer, double low, double high, double from, double to);

/// A screw of radius 1 and height 1.2 with a turn and a half of a round thread that fades out towards its ends, in
/// `steps` rows; and what it fits in, with an outer radius of 2.
SurfaceMesh faceted_screw(int sides, int steps, double turn = 0);
SurfaceMesh faceted_nut(int sides, int steps);

}  // namespace octafront::testing
