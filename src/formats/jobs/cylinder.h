#pragma once

#include <octafront/vec.h>

#include <array>
#include <optional>
#include <span>

namespace octafront::io {

/// The axis of a cylinder, a point on it in its middle, its radius, and how far it reaches to both sides.
struct Cylinder {
  Vec3 middle, axis;
  double radius = 0, half_length = 0;
};

/// The cylinder that triangles lie on; none where they lie on no cylinder, within a fiftieth of the radius.
std::optional<Cylinder> cylinder_of(std::span<const std::array<Vec3, 3>> triangles);

/// Parts of a vector at a point: radial, tangential, axial.
Vec3 in_system_of(const Cylinder& cylinder, Vec3 at, Vec3 vector);
/// Whether two have the same axis, as closely as facets tell.
bool share_axis(const Cylinder& a, const Cylinder& b);

}  // namespace octafront::io
