#pragma once

#include "sizing/field/octree.h"

#include <cstdint>
#include <span>

namespace octafront {

struct SurfaceMesh;

/// A small flat part of the surface.
struct SurfacePiece {
  Vec3 p;                  ///< its centroid, input units
  Vec3 n;                  ///< its area times its outward unit normal
  std::uint32_t leaf = 0;  ///< in which its centroid lies
};

/// The surface in pieces that are no longer than the leaf that their centroid lies in.
RawVector<SurfacePiece> surface_pieces(const RootCube& root, const Octree& tree, const SurfaceMesh& surface);

/// Per leaf, which part of its volume lies inside the surface, in [0, 1]; exactly 0 or 1 for leaves without pieces, up
/// to the error of counting each piece to one leaf. Needs no search for neighbours and no ray: the averages of the
/// indicator function over all cells come from sums over the pieces (its Haar wavelets; J. Manson, G. Petrova,
/// S. Schaefer, "Streaming surface reconstruction using wavelets", 2008). O(pieces log leaves).
RawVector<double> inside_fractions(const RootCube& root, const Octree& tree, std::span<const SurfacePiece> pieces);

}  // namespace octafront
