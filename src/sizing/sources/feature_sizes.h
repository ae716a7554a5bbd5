#pragma once

#include <octafront/ids.h>

#include "base/mesh/features.h"
#include "sizing/field/background_grid.h"

#include <vector>

namespace octafront {

struct SurfaceMesh;

/// A chain of feature edges between two corners, or a closed one.
struct FeatureCurve {
  std::vector<VertexIndex> vertices;  ///< in order; a closed curve repeats its first vertex at the end
  double length = 0;
};
std::vector<FeatureCurve> feature_curves(const SurfaceMesh& surface, const Features& features);

/// Samples that give each feature curve at least `elements` elements (closed ones at least twice that, and three), but
/// no size below `floor`.
std::vector<SizeSample> feature_samples(const SurfaceMesh& surface, const std::vector<FeatureCurve>& curves,
                                        double elements, double floor, double ceiling);

}  // namespace octafront
