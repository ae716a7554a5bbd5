#pragma once

#include <octafront/run_context.h>

#include "sizing/field/octree_field.h"

#include <memory>
#include <span>

namespace octafront {

struct SurfaceMesh;

/// A size wanted at a point of the surface, or in space.
struct SizeSample {
  Vec3 p;
  Vec3 n;    ///< unit normal of the surface there: the size holds for the tangent plane; zero: for the point alone
  double h;  ///< input units
  double reach = 0;  ///< within this distance the size holds unchanged: the radius of what the sample stands for
  double area = 0;   ///< of the part of the surface that the sample stands for
};

/// The cube that the background grid of a surface fills.
RootCube root_around(const SurfaceMesh& surface);

/// How a background grid is made of samples.
struct GridRules {
  double gradation = 0.2;
  double ceiling = 0;                  ///< no size rises above this, input units, nor above the root's side; required
  bool interior_below_surface = true;  ///< no size rises above the largest one at a sample (the paper's Cmax)
  /// Leaves with samples are divided until their side is at most this multiple of the size wanted there; away from the
  /// surface twice that. 2 puts sides into (h, 2 h].
  double leaf_per_size = 2;
  /// Where the wanted sizes in a leaf are equal, nothing is gained below this level.
  int plain_level = 5;
  bool resolve_surface = false;  ///< divide by leaf_per_size even where sizes are equal
  bool keep_sources = false;     ///< leave OctreeField::source
  bool only_surface = false;     ///< leaves without samples may stay too large for the sizes in them
};

/// Leaves on the surface follow the samples, those inside the graded field; 2:1 balanced. Samples are not kept. What is
/// inside follows from the samples' normals and areas.
std::shared_ptr<OctreeField> make_background_grid(const RootCube& root, std::span<const SizeSample> samples,
                                                  const GridRules& rules, const RunContext& context);

}  // namespace octafront
