#pragma once

#include <octafront/inside.h>
#include <octafront/size_field.h>

#include "base/geometry/triangle_tree.h"

#include <vector>

namespace octafront {

/// The lines of a net as polygons between ends, forks and corners: equal points are one, edges that occur twice or have
/// no length are dropped. A closed one begins and ends with the same point. Throws InputError, with the name.
std::vector<std::vector<Vec3>> polygons_of(const LineNet& net);

/// The same polygon with edges that fit the sizes, and a vertex wherever it goes through a wall.
std::vector<Vec3> divided(const std::vector<Vec3>& polygon, const SizeField& sizes, const TriangleTree& walls);

}  // namespace octafront
