#pragma once

#include <array>
#include <limits>

namespace octafront {

/// What a new tetrahedron must keep to, beyond being valid. Lengths are in units of the wanted size. The levers and
/// their order were found by measurement (docs/how/volume-front.md): each one keeps the front from closing up into
/// shapes that no good element fits.
struct Limits {
  double search_radius;   ///< of the sphere of candidates around the ideal point
  double ideal_factor;    ///< shortens the distance of the ideal point
  double longest_edge;    ///< of the edges that the tetrahedron adds to the front
  double face_clearance;  ///< distance of a new vertex from the faces of the front
  double edge_clearance;  ///< distance of new edges from the edges of the front
  double least_quality;   ///< beta of the tetrahedron
  bool new_points;        ///< the ideal point may become a vertex
};

/// One for each attempt: a face that finds no tetrahedron waits until everything else is done, then tries the next. The
/// last levels add no points: a front that has come to them would only shrink around its trouble.
inline constexpr std::array<Limits, 5> kLimits{{
    {0.65, 1.0, 1.5, 0.3, 0.25, 0.2, true},
    {1.0, 0.8, 1.6, 0.15, 0.15, 0.1, true},
    {1.3, 0.6, 2.0, 0.1, 0.1, 0.03, true},
    {2.0, 0.5, std::numeric_limits<double>::infinity(), 0.02, 0.02, 0.01, false},
    {3.0, 0.35, std::numeric_limits<double>::infinity(), 0, 0, 0, false},
}};

}  // namespace octafront
