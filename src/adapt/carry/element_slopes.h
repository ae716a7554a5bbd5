#pragma once

#include <octafront/tet_mesh.h>

#include "adapt/carry/regions.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::adapt {

/// Slopes of values of elements: at each vertex by least squares of what the elements around it have in their middles,
/// region by region, in an element the mean of those at its corners; then made smaller until at no corner the element
/// is beyond what the elements around that have (the limiter of D. Kuzmin, A vertex-based hierarchical slope limiter
/// for p-adaptive discontinuous Galerkin methods, 2010). So linear functions inside a body are exact, and no part of an
/// element has a mean beyond its neighbours.
class ElementSlopes {
 public:
  /// `components` values for each tet.
  ElementSlopes(const TetMesh& mesh, const MatchedRegions& regions, std::span<const double> values,
                std::size_t components);

  /// Those of functions that are linear in each element, by `components` values at each of its corners.
  static ElementSlopes of_corners(const TetMesh& mesh, std::span<const double> values, std::size_t components);

  Vec3 slope(TetIndex t, std::size_t component) const { return slopes_[t * components_ + component]; }

 private:
  ElementSlopes(const TetMesh& mesh, std::size_t components) : mesh_(mesh), components_(components) {}

  /// A vertex, as the elements of one region see it.
  using Corner = std::uint32_t;

  void number_corners(const MatchedRegions& regions);
  void find_slopes_at_corners(std::span<const double> values);
  void find_slopes(std::span<const double> values);
  Vec3 centre(TetIndex t) const;
  Corner corner(TetIndex t, std::size_t i) const { return corners_.empty() ? mesh_.tets[t][i] : corners_[4 * t + i]; }

  const TetMesh& mesh_;
  std::size_t components_, corner_count_ = 0;
  std::vector<Corner> corners_;  ///< four per tet; empty: the vertices
  std::vector<Vec3> at_corners_;
  std::vector<std::uint8_t> is_known_;  ///< whether enough elements are around a corner
  std::vector<double> least_, greatest_;
  std::vector<Vec3> slopes_;
};

}  // namespace octafront::adapt
