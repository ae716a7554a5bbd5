#pragma once

// Polynomials through points of a surface or a curve, by least squares: the surface between the vertices of the input.

#include "base/geometry/frame.h"

#include <array>
#include <span>

namespace octafront::curved {

/// The height of a smooth surface over the tangent plane of one vertex, a polynomial of degree four or less that goes
/// through the vertex. Where the points around do not follow such a polynomial (noise, a kink, a flat face that meets a
/// fillet), it is not trusted, and the surface there is what the input's triangles say.
struct SurfaceFit {
  Frame frame;
  std::array<double, 14> coefficient{};  ///< of u, v, uu, uv, vv, uuu ... vvv, uuuu ... vvvv
  bool trusted = false;

  /// Where the smooth surface passes p, seen along the normal; p itself if it is not trusted.
  Vec3 at(Vec3 p) const;
};

/// `normal`: unit, roughly that of the surface. The fit follows the normal wherever the points say it points.
SurfaceFit fit_surface(Vec3 vertex, Vec3 normal, std::span<const Vec3> around);

/// The same for a curve in space: two heights over its tangent.
struct CurveFit {
  Frame frame;
  std::array<double, 4> in_v{}, in_n{};  ///< of u, uu, uuu, uuuu
  bool trusted = false;

  Vec3 at(Vec3 p) const;
};

/// `tangent`: unit, roughly that of the curve.
CurveFit fit_curve(Vec3 vertex, Vec3 tangent, std::span<const Vec3> around);

}  // namespace octafront::curved
