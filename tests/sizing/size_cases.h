#pragma once

// Size fields of many kinds, made from surfaces and options.

#include <octafront/options.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>

#include "base/mesh/features.h"

#include <functional>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace octafront::testing {

SizeField sizes_of(const SurfaceMesh& surface, const SizeOptions& options, const Features& features = {});

/// A callback that looks at one point after the other.
std::function<void(std::span<const Vec3>, std::span<double>)> each(double (*size_at)(Vec3));

/// Fields of many kinds on one surface each.
struct SizeCase {
  std::string name;
  SurfaceMesh surface;
  SizeOptions options;
};
std::vector<SizeCase> size_cases();

/// In a box or near it.
Vec3 random_point(std::mt19937& random, const Box3& box);

}  // namespace octafront::testing
