#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/lines/curves.h"

#include <vector>

namespace octafront::surface {

/// Places where triangles of the wanted size would deviate from the input by more than `tolerance`, and the size by
/// which they would not: of triangles no larger than the part of the patch around the place that stays between two
/// planes about so far apart, and of edges along a curve no longer than the part of it that stays as near to its chord.
/// Of places within their size of each other that of the smallest one. What is finer than the input's own triangles is
/// not asked for, and nothing where 600 of these are flat together. A place speaks for what is within a quarter of its
/// patch's radius. Cost: O(n), at most 10 us for each triangle of the input.
std::vector<PointSize> sizes_by_flatness(const InputSurface& input, const std::vector<Curve>& curves,
                                         const SizeField& sizes, double tolerance, const RunContext& context);

}  // namespace octafront::surface
