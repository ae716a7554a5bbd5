#pragma once

#include <octafront/options.h>

#include "sizing/field/background_grid.h"
#include "sizing/sources/surface_samples.h"

#include <vector>

namespace octafront {

struct SurfaceMesh;

/// What options.point_sizes and options.callback want at places of a surface, be it kept or made anew; the smaller
/// where both speak, empty if neither does. Answers of the callback are checked. Refers to `surface`, which must
/// outlive it.
SizeAtPlace given_sizes(const SurfaceMesh& surface, const SizeOptions& options);

/// A sample at each of options.point_sizes, no smaller than `floor`: a small size at one corner of a large triangle
/// must not be missed.
std::vector<SizeSample> samples_of_points(const SizeOptions& options, double floor);

}  // namespace octafront
