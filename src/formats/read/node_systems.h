#pragma once

#include <octafront/vec.h>

#include <array>
#include <utility>

namespace octafront::io {

/// Sine and cosine of an angle in degrees; of quarter turns exactly.
std::pair<double, double> sine_and_cosine(double degrees);

/// A system of coordinates of the nodes of a file: where its origin and axes are, and what its numbers mean.
struct NodeSystem {
  enum class Kind {
    kRectangular,
    kCylindrical,  ///< radius, degrees about Z from X, height
    kLatitude,     ///< radius, degrees about Z from X, degrees up from there (Abaqus)
    kPolar         ///< radius, degrees down from Z, degrees about Z from X (Nastran)
  };
  Kind kind = Kind::kRectangular;
  Vec3 origin{};
  std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

  Vec3 global(Vec3 numbers) const;
};

/// Right-handed unit axes with X along `x`, and Y towards `near_y`; false if they are along one line.
bool set_axes_by_xy(NodeSystem& system, Vec3 x, Vec3 near_y);
/// The same with Z along `z`, and X towards `near_x`.
bool set_axes_by_zx(NodeSystem& system, Vec3 z, Vec3 near_x);

}  // namespace octafront::io
