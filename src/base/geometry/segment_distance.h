#pragma once

#include <octafront/vec.h>

#include <algorithm>

namespace octafront {

/// Squared distance of the segments (p, p + u) and (q, q + v), in plain floating point; neither may be a point.
inline double squared_segment_distance(Vec3 p, Vec3 u, Vec3 q, Vec3 v) {
  // Below this squared sine the lines count as parallel: rounding would decide where on the first they are nearest.
  constexpr double kParallel = 1e-12;
  const Vec3 w = p - q;
  const double a = dot(u, u), b = dot(u, v), c = dot(v, v), d = dot(u, w), e = dot(v, w);
  const double det = a * c - b * b;
  double s = det > kParallel * a * c ? std::clamp((b * e - c * d) / det, 0.0, 1.0) : 0.0;
  double t = (b * s + e) / c;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - d) / a, 0.0, 1.0);
  }
  return squared_length(w + u * s - v * t);
}

}  // namespace octafront
