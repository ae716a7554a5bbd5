#pragma once

// Walls that are meant to be flat: nothing leaves them, however that would help the elements beside.

#include "base/geometry/triangle_tree.h"
#include "base/mesh/features.h"

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace octafront::improve {

class FlatWalls {
 public:
  /// All must outlive this. What takes time is done when the first question is asked.
  FlatWalls(const SurfaceMesh& input, const TriangleTree& tree, const Features& features)
      : input_(input), tree_(tree), features_(features) {}

  /// Whether one of the triangles around a vertex lies in a flat wall of the input. A facet of a scan is no wall: walls
  /// end at features for the most part, or have many triangles.
  bool hold(std::span<const TriangleCorners> around) const;

 private:
  void find() const;

  const SurfaceMesh& input_;
  const TriangleTree& tree_;
  const Features& features_;
  mutable std::once_flag is_found_;
  mutable std::vector<std::uint8_t> is_wall_;  ///< per triangle of the input
};

}  // namespace octafront::improve
