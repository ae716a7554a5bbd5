#pragma once

// Where the surface that is being made deviates from the input, and the sizes by which it would not.

#include "surface/edits/deviation.h"
#include "surface/remeshing/front_work.h"

#include <vector>

namespace octafront::surface {

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

}  // namespace octafront::surface
