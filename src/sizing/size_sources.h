#pragma once

#include <octafront/options.h>
#include <octafront/surface_mesh.h>

#include "base/core/stage.h"
#include "base/mesh/index_range.h"
#include "base/mesh/known_surface.h"
#include "sizing/background_grid.h"
#include "sizing/make_size_field.h"
#include "sizing/surface_samples.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// Tetrahedra per cube of the wanted edge length. Measured on uniform sizes of 1/20 and 1/50 of the diagonal over some
/// twenty models: 9.24 with a spread of 3 %. (Space filled by regular tetrahedra would have 6 sqrt(2) = 8.49, the
/// body-centred cubic lattice of that mean edge length has 9.45.)
inline constexpr double kTetsPerCube = 9.24;
/// The same per square of the surface where a wall has one layer of them: 1.47 for each triangle.
inline constexpr double kTetsPerSquare = 3.4;

/// What all sources together want on a surface, before any of it is put into a grid. Input units.
struct WantedSizes {
  std::vector<double> face;        ///< per triangle
  std::vector<SizeSample> points;  ///< at feature curves and the like
  SizeAtPlace at_place;            ///< asked at each sample of the surface; may be empty
  double ceiling = 0;              ///< no size inside rises above this
  bool even = false;               ///< one size everywhere
  bool automatic = false;          ///< the user left the choice to us
};

/// Whether nothing says what the sizes are, so that all are of our own choice, up to a largest one.
bool has_no_size_source(const SizeOptions& options);

/// A measure of the model that neither rotation nor triangulation changes: 2 sqrt(3) times the root mean square
/// distance of the surface from its centre of gravity. A sphere's is the diagonal of its bounding box, a rod's is its
/// length.
double model_extent(const SurfaceMesh& surface);

/// Asks every source that `options` names; the automatic choice if it names none. Throws OptionError. Refers to the
/// surface, which must outlive it.
WantedSizes wanted_sizes(const KnownSurface& known, const SizeOptions& options, const Stage& stage,
                         const FaceRules& rules = {});

/// The sources that are asked place by place and that hold for every kind of surface: options.point_sizes and the
/// callback, whose answers are checked. Empty if there are none. Refers to `surface`, which must outlive it.
SizeAtPlace given_sizes(const SurfaceMesh& surface, const SizeOptions& options);
/// The points of options.point_sizes themselves, no smaller than `floor`: a small size at one corner of a large
/// triangle must not be missed.
std::vector<SizeSample> samples_of_points(const SizeOptions& options, double floor);

/// The centroid of an equilateral triangle with its corners on a sphere of curvature k lies k h^2 / 6 below it.
inline double size_of_chord_error(double error, double k) {
  return std::sqrt(6 * error / k);
}

/// Throws OptionError for values out of range and for contradictions.
void check_size_options(const SizeOptions& options);

}  // namespace octafront
