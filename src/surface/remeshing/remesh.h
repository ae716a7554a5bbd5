#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>

#include "base/core/stage.h"
#include "base/mesh/known_surface.h"
#include "periodic/periodic_cell.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront {

/// A surface triangulated to the size field, and how it relates to the one it was made from.
struct Remeshed {
  SurfaceMesh surface;                ///< clean, same topology; vertices lie on the input surface; patches kept
  Features features;                  ///< of `surface`
  std::vector<std::uint32_t> source;  ///< per triangle: the input triangle that lies nearest to its centroid
  SizeField sizes;                    ///< what was asked, capped where self-intersections forced smaller elements
  /// The corners of triangles that lie nearly as far from the input as they may.
  std::vector<VertexIndex> near_limit = {};
  bool stays = false;  ///< vertices that moved would change the volume too much: improvement leaves them where they are
};

/// How far a wish may be missed to spare work.
struct FrontLimits {
  double slack = 1;  ///< the surface is not made anew for a few places that deviate so many times as far as it may
  /// Elements that the sizes come to at most, by the prediction. What strips and the deviation ask for beyond that is
  /// given up, and said; what crosses is not.
  double budget = HUGE_VAL;
  /// Strips and corners ask for no size below this, input units; strips narrower than `narrowest_strip` for none at
  /// all.
  double least = 0, narrowest_strip = 0;
  /// From strips sizes may rise so fast, or as fast as elsewhere if that is faster.
  double rise = 0;
  /// Sizes in strips are no smaller than so many widths of them.
  double per_strip = 0;
  /// A complex with more sides of triangles on seams than this, for each triangle, is noise: it is kept as it is.
  double most_seams = HUGE_VAL;
};

/// The surface front. Requires a clean surface (see surface_mesh.h). The result is checked: closed, manifold, same
/// components and genus, no self-intersection, features present; throws MeshingError if no attempt passes. `bound`: per
/// triangle of the surface what options.max_deviation is there, if that is less; empty: so nowhere. `cell`: of a
/// complex that make_periodic() has made; triangles on opposite faces are then the same in the result, bit for bit.
Remeshed remesh_surface(const KnownSurface& surface, const SizeField& sizes, const SurfaceOptions& options,
                        const Stage& stage, std::span<const double> bound = {}, const FrontLimits& limits = {},
                        const PeriodicCell& cell = {});

/// The input's own triangles in the place of new ones.
Remeshed input_as_it_is(const KnownSurface& surface, const SizeField& sizes);

}  // namespace octafront
