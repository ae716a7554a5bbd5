#pragma once

#include "cad/model/cad_model.h"

namespace octafront::cad {

/// Points by the formulas of cad_model.h, not by OpenCASCADE: what a record means to who receives it. Not for kNone.
Vec3 point_of(const CurveRecord& curve, double t);
Vec3 point_of(const SurfaceRecord& surface, Uv at);

/// A parameter brought into the range of the knots by whole periods; 0: there are none.
double wrapped(double t, const Knots& knots, double period);

}  // namespace octafront::cad
