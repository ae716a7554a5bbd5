#pragma once

#include <octafront/vec.h>

#include "base/geometry/triangle_tree.h"
#include "base/geometry/winding_number.h"

namespace octafront {

struct SurfaceMesh;

/// What isosurface stuffing asks of the body that it fills. Queries are const and thread-safe.
class ImplicitDomain {
 public:
  virtual ~ImplicitDomain() = default;
  /// +1 inside, 0 on the boundary, -1 outside.
  virtual int side(Vec3 p) const = 0;
  /// Where the segment from `inside` to `outside` leaves the body: a part of its length, in (0, 1).
  virtual double crossing(Vec3 inside, Vec3 outside) const = 0;
  /// True only if every point within `reach` of p lies on the same side as p. May be false without need.
  virtual bool is_clear(Vec3 p, double reach) const = 0;
};

/// The inside of a triangle surface. Clean surfaces are decided exactly. Surfaces with defects are decided by their
/// generalised winding number: inside is where it is above one half in magnitude, so holes are closed by a smooth cap,
/// overlapping shells are united, and a shell that faces inward counts like one that faces outward.
class SurfaceDomain final : public ImplicitDomain {
 public:
  enum class Defects { kClean, kClosed, kOpen };
  SurfaceDomain(const SurfaceMesh& surface, Defects defects);

  int side(Vec3 p) const override;
  double crossing(Vec3 inside, Vec3 outside) const override;
  bool is_clear(Vec3 p, double reach) const override;

  const TriangleTree& triangles() const { return triangles_; }
  /// Holes let inside and outside meet where there is no triangle.
  bool has_holes() const { return defects_ == Defects::kOpen; }

 private:
  double bisect(Vec3 inside, Vec3 outside, double from, double to) const;

  Defects defects_;
  TriangleTree triangles_;
  WindingNumber winding_;
};

}  // namespace octafront
