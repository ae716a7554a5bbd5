#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include "base/core/stage.h"
#include "base/mesh/known_surface.h"
#include "sizing/field/background_grid.h"
#include "sizing/sources/surface_samples.h"

#include <functional>
#include <string>
#include <vector>

namespace octafront {

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
