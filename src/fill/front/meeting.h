#pragma once

#include <octafront/vec.h>

#include <array>
#include <cstdint>

namespace octafront {

/// A corner as the exact tests see it: two corners are the same one if and only if their ids are equal.
struct NamedPoint {
  std::uint32_t id = 0;
  Vec3 at;
};

/// True if the positive tetrahedron `t` and the non-degenerate triangle `f` have a point in common that does not belong
/// to the simplex spanned by the corners with equal ids. Exact for every configuration, coplanar and collinear ones
/// too.
bool meets_beyond_shared_simplex(const std::array<NamedPoint, 4>& t, const std::array<NamedPoint, 3>& f);

}  // namespace octafront
