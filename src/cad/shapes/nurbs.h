#pragma once

#include "cad/model/cad_model.h"

namespace octafront::cad {

/// A point of a curve, and its first two derivatives by the parameter.
struct CurveJet {
  Vec3 p, d, dd;
};
/// A point of a surface, and its first two derivatives by u and v.
struct SurfaceJet {
  Vec3 p, u, v, uu, uv, vv;
};

/// Of a curve of kind kNurbs; t within its knots. (L. Piegl, W. Tiller, "The NURBS Book", 1997: A2.3, A4.2.)
CurveJet jet(const CurveRecord& curve, double t);
/// Of a surface of kind kNurbs; u and v within its knots.
SurfaceJet jet(const SurfaceRecord& surface, Uv at);

}  // namespace octafront::cad
