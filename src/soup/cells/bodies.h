#pragma once

#include <octafront/complex.h>

#include <optional>
#include <vector>

namespace octafront::cells {

/// As join_bodies(); `nested`: of two bodies that have space in common one always lies within the other.
struct Joined {
  Complex complex;
  bool nested = true;
};
Joined joined_bodies(const std::vector<Body>& bodies, const ComplexOptions& options, const RunContext& context);

/// The complex of solids that one surface holds under names of their own, each closed and facing outward, where some of
/// them touch or lie in others: a region each, the inner ones cut out of the outer ones. nullopt if it is none, or if
/// solids overlap; solids apart are one only where the options ask for regions.
std::optional<Complex> complex_of_solids(const SurfaceMesh& surface, const ComplexOptions& options,
                                         const RunContext& context);

}  // namespace octafront::cells
