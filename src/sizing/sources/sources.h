#pragma once

// What asks for sizes.

#include <octafront/ids.h>
#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include "base/core/stage.h"
#include "base/mesh/features.h"
#include "base/mesh/known_surface.h"
#include "sizing/field/background_grid.h"
#include "sizing/sources/curvature.h"
#include "sizing/sources/surface_samples.h"

#include <functional>
#include <string>
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

/// What options.named asks for.
struct NamedSizes {
  std::vector<double> face;        ///< per triangle, infinite where nothing is asked; empty: nowhere
  std::vector<SizeSample> points;  ///< along curves and inside regions
};

/// Sizes that are asked for in a box or ball by `named` become some of `regions`. Throws OptionError.
void take_places_in_space(SizeOptions& options);

/// Finds the regions, patches and curves that are named. Throws OptionError for names that there are not, and for sizes
/// that would make more elements than a mesh can hold.
NamedSizes named_sizes(const KnownSurface& surface, const SizeOptions& options);

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

/// Sizes where a body is round and thinner than its elements would be, as needles, rods and wires are: so many to a
/// turn that it keeps its volume within 5 %, but none below `floor`. Empty where there is no such place. `face`: the
/// sizes that are wanted there, per triangle. Refers to the surface.
SizeAtPlace sizes_in_round_places(const KnownSurface& known, const SurfaceCurvature& curvature,
                                  const std::vector<double>& face, double floor);

/// Sizes where a wall curves, as those of tubes do, and is so thin that facets of the wanted size on both its sides
/// would cross. As above.
SizeAtPlace sizes_in_curved_walls(const KnownSurface& known, const SurfaceCurvature& curvature,
                                  const std::vector<double>& face, double floor);

/// A source of sizes that speaks of places in space, those inside the body too. Safe on any number of threads.
struct SizeInSpace {
  std::string name;                                  ///< for the report, e.g. "`size_near` bolt"
  std::function<double(Vec3)> at = {};               ///< infinity: nothing is asked there
  std::function<double(const Box3&)> least_in = {};  ///< no more than `at` is anywhere in the box
};

/// What options.near and options.mesh ask for, each by itself. Throws OptionError for names that there are not. They
/// refer to what `surface` and `options` hold.
std::vector<SizeInSpace> sizes_in_space(const KnownSurface& surface, const SizeOptions& options);

/// The smallest of them at places of the surface; empty if there are none.
SizeAtPlace least_at_places(const std::vector<SizeInSpace>& sources, double floor);

/// Samples all over the inside of the body, as dense as what the sources ask for there, no smaller than `floor`. Throws
/// OptionError where that would make more elements than a mesh can hold.
std::vector<SizeSample> samples_inside(const KnownSurface& surface, const std::vector<SizeInSpace>& sources,
                                       double floor, const RunContext& context);

/// Says how much of the surface lies outside of options.mesh, and how far. Throws OptionError if it is nowhere near.
void note_outside_of_mesh(const SurfaceMesh& surface, const SizeOptions& options, const Stage& stage);

}  // namespace octafront
