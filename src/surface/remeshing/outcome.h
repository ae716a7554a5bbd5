#pragma once

// What a round leaves: the parts of the working mesh that are alive.

#include "surface/remeshing/front_work.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront::surface {

/// Numbered anew in their order.
struct Outcome {
  Remeshed result;
  std::vector<std::uint32_t> vertex_face;  ///< per vertex: an input face that it lies in
  std::vector<std::uint8_t> is_inner;      ///< per vertex: not on a feature
  bool is_clear = false;                   ///< it is known that nothing crosses
  Nearness nearness;
};

/// `input`: the surface or complex that the draft triangulates anew.
Outcome outcome_of(const Draft& draft, const SurfaceMesh& input);

/// The living triangles of these numbers, which are no backs, with all points; sewn.
SurfaceMesh sewn_triangles(const WorkingMesh& mesh, const std::vector<std::uint32_t>& number);

/// Per triangle of the working mesh whether it crosses another, or has no area.
std::vector<std::uint8_t> crossing_triangles(const WorkingMesh& mesh);

/// The triangles of the pairs, each once, ascending.
std::vector<std::uint32_t> triangles_of(const std::vector<std::array<std::uint32_t, 2>>& pairs);

}  // namespace octafront::surface
