#pragma once

#include <octafront/complex.h>
#include <octafront/image.h>
#include <octafront/image_surface.h>
#include <octafront/run_context.h>

#include "base/core/groups.h"
#include "images/nets/cells.h"
#include "images/nets/conflicts.h"
#include "images/nets/given_surfaces.h"
#include "images/nets/lattice.h"
#include "images/nets/net.h"
#include "images/nets/stencils.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// Throws InputError if a grid with so many voxels makes no sense, or lies where double precision cannot tell them
/// apart.
void check_grid(const ImageGrid& grid, std::size_t voxels);

/// Throws InputError for labels that are not there, or if there is none.
void check_labels(const LabelImage& image);

// The steps from an image to the surface of its labels.

/// How many voxels each label has, and their volume in straight space.
struct LabelSizes {
  std::vector<std::uint64_t> voxels;
  std::vector<double> volume;

  LabelSizes(const Lattice& lattice, std::size_t labels);
};

/// Gives each quad the diagonal whose triangles keep the voxels on its two sides apart, and of two such ones that with
/// the larger smallest angle. `x`: the vertices in straight space.
void choose_diagonals(Net& net, const Lattice& lattice, std::span<const Vec3> x);
void choose_diagonal(Net& net, const Lattice& lattice, std::span<const Vec3> x, std::uint32_t quad);

/// Moves the vertices such that the sum of squared second differences becomes least, each within its cell: surfaces
/// that bend evenly, without the steps of the voxels. Curves count by their own neighbours, and follow the surfaces
/// that end at them through theirs. `x`: where the vertices are and will be, straight space.
///
/// Projected gradient with Nesterov's momentum (A. Beck, M. Teboulle, "A Fast Iterative Shrinkage-Thresholding
/// Algorithm for Linear Inverse Problems", 2009).
void fair(const Stencils& stencils, const VertexCells& cells, std::vector<Vec3>& x, const RunContext& context);

/// Vertices that were put on surfaces; empty without surfaces.
struct PlacedVertices {
  std::vector<std::uint8_t> is_placed;  ///< per vertex
  std::vector<std::uint16_t> on;        ///< per vertex that is placed, the number of its surface
  std::vector<std::uint64_t> far;       ///< per surface: vertices that stay where they are, a voxel off and more
};

/// Puts the vertices between what a surface holds and what is around on it, within their cells, where they are no
/// farther than a voxel from it; of several surfaces on the nearest one.
PlacedVertices place_on_surfaces(const Net& net, const Lattice& lattice, std::span<const GivenSurface> surfaces,
                                 std::vector<Vec3>& x, const RunContext& context);

/// How far vertices lie from their surface at last.
struct Deviation {
  std::uint64_t vertices = 0;
  double sum = 0, largest = 0;
};
std::vector<Deviation> deviations(std::span<const GivenSurface> surfaces, const PlacedVertices& placed,
                                  std::span<const Vec3> world);

/// The volume of each label by the net's triangles, in straight space.
std::vector<double> volumes_of(const Net& net, std::span<const Vec3> x, std::size_t labels);

/// Moves the vertices, each within its cell, until the labels have these volumes: each label's surface by a pressure of
/// its own, the least motion to first order. A volume of 0 or less stands for any. `pinned`: vertices that stay where
/// they are; empty: none does.
void keep_volumes(Net& net, const Groups<>& quads_at, const VertexCells& cells, const Lattice& lattice,
                  const std::vector<double>& wanted, std::vector<Vec3>& x, const RunContext& context,
                  std::span<const std::uint8_t> pinned = {});

/// The net as a complex of those of the labels that have quads, in their order, with their names; with their values if
/// `keeps_values`. Notes say what settling did.
Complex assemble(const Net& net, const Lattice& lattice, ResolvedNet resolved, std::span<const Vec3> straight,
                 const std::vector<LabelImage::Label>& labels, bool keeps_values);

}  // namespace octafront::nets
