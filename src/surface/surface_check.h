#pragma once

#include <octafront/surface_mesh.h>

#include <optional>
#include <string>

namespace octafront {

/// The first way in which `result` fails to be a clean surface of the same kind as `input`, as a sentence with ids and
/// coordinates; nullopt if it is one:
///   - indices in range, coordinates finite, no vertex unused, no face without area
///   - closed, 2-manifold, consistently oriented, outward (shells inside an odd number of others inward)
///   - no self-intersection, exactly
///   - as many shells as `input`, of the same genus and nested as deep
/// Requires that `input` is clean. Cost: O(n log n), about 1.5 s per million triangles of `result`.
std::optional<std::string> first_surface_defect(const SurfaceMesh& result, const SurfaceMesh& input);

}  // namespace octafront
