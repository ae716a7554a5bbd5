#pragma once

// cad/shapes: the records of faces and edges, asked: points and derivatives (nurbs.h), the nearest point (nearest.h),
// and all of a model as a TrueGeometry (shapes.h).

#include "cad/model/cad_model.h"

#include <optional>

namespace octafront::cad {

/// A point of a face near which another is looked for.
struct SurfaceSeed {
  Uv at;   ///< asked by kNurbs alone
  Vec3 p;  ///< asked by the others where the nearest point is not unique: on axes, at centres
};

/// The point of the whole surface nearest to p, on the sheet of the seed: analytic, or Newton's iteration from the
/// seed. Nothing for kNone, or where the iteration does not come nearer than the seed.
std::optional<Vec3> nearest_on(const SurfaceRecord& surface, const SurfaceSeed& seed, Vec3 p);

/// A point of an edge near which another is looked for.
struct CurveSeed {
  double at = 0;
  Vec3 p;
};

/// The same for a curve.
std::optional<Vec3> nearest_on(const CurveRecord& curve, const CurveSeed& seed, Vec3 p);

}  // namespace octafront::cad
