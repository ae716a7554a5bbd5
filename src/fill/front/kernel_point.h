#pragma once

#include <octafront/vec.h>

#include <vector>

namespace octafront {

/// The half-space n . x >= d, |n| = 1.
struct HalfSpace {
  Vec3 n;
  double d = 0;
};

struct KernelPoint {
  Vec3 at;
  double depth = 0;  ///< least signed distance from the planes; the kernel has an inside where it is positive
};

/// The point of `box` whose least signed distance from the planes is largest: a linear programme in four variables,
/// solved by R. Seidel's incremental algorithm ("Small-dimensional linear programming and convex hulls made easy",
/// 1991) in a fixed pseudo-random order. Expected time linear in the number of planes. The answer is floating point:
/// whoever relies on it checks it by exact predicates.
KernelPoint deepest_point(const std::vector<HalfSpace>& planes, const Box3& box);

}  // namespace octafront
