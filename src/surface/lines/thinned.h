#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

#include <vector>

namespace octafront::surface {

/// Of places within half a size of each other the first one.
std::vector<Vec3> thinned(const SizeField& sizes, const std::vector<Vec3>& places);

/// At thinned() places this part of the size.
std::vector<PointSize> smaller_at(const std::vector<Vec3>& places, double part, const SizeField& sizes);

/// Of places within their size of each other that of the smallest size, by size.
std::vector<PointSize> smallest_ones(std::vector<PointSize> places);

}  // namespace octafront::surface
