#pragma once

#include "surface/edits/deviation.h"
#include "surface/remeshing/front_work.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront::surface {

// Where the surface that is being made deviates from the input, and the sizes by which it would not.

/// From this part of the bound on deviation on nobody shall move triangles later: sliding vertices deviate by a fifth
/// more.
inline constexpr double kLeftAlone = 0.75;
/// Points of the input are put in from this part of it on.
inline constexpr double kComeNear = 0.9;

/// Where the mesh is too far from the input, or nearly so, by the numbers of its triangles; nowhere without a bound.
std::vector<FarPlace> far_places(const FrontWork& work, const WorkingMesh& mesh, DeviationWatch& watch);

/// Where the places are that lie at least as far as the limit, but not as far as `end`.
std::vector<Vec3> positions_beyond(double limit, const std::vector<FarPlace>& places, double end = HUGE_VAL);
double farthest_of(const std::vector<FarPlace>& places);

/// Of the places beyond the tolerance, sizes by which it would deviate no more there: what chords cut off grows with
/// the square of their length. Of places near to each other that of the smallest size.
std::vector<PointSize> sizes_against(const std::vector<FarPlace>& places, double tolerance, const SizeField& sizes);

// What a round leaves: the parts of the working mesh that are alive.

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
