#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

#include "base/mesh/known_surface.h"

#include <vector>

namespace octafront::surface {

/// What details of a surface may ask for at least: a size for all of it, and less on shells of a complex (pieces of
/// regions, holes in them) that are too small for elements of that size. Refers to the surface.
class LeastSizes {
 public:
  /// `least` in input units; 0: there is no such limit.
  LeastSizes(const KnownSurface& known, double least);

  double at(Vec3 p) const;
  /// Places on shells that would be lost among elements of these sizes, and the sizes that keep them. None without a
  /// limit.
  std::vector<PointSize> small_shells(const SizeField& sizes) const;

 private:
  const KnownSurface& known_;
  double least_;
  std::vector<double> of_triangle_;  ///< empty: `least_` holds everywhere
};

}  // namespace octafront::surface
