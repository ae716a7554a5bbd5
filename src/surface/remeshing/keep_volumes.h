#pragma once

#include <octafront/ids.h>
#include <octafront/no_context.h>
#include <octafront/surface_mesh.h>

#include "base/mesh/features.h"
#include "base/mesh/known_surface.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace octafront {

/// Looks at the surface as it is now: vertices that have gone too far, ascending.
using TooFar = std::function<std::vector<VertexIndex>()>;

/// Moves vertices inside patches until regions have the volumes `wanted`, by their numbers, as far as these vertices
/// can do so: a pressure in each region moves its walls, none by more than a fifth of an edge; those that are too far
/// go back half of their way, or all of it. Vertices of feature edges, of flat parts and of `fixed` stay. First they
/// move to where triangles lie nearest to `input`, unless that is null. Returns how many have moved.
std::uint64_t keep_volumes(SurfaceMesh& surface, const Features& features, std::span<const double> wanted,
                           const TooFar& too_far, std::span<const VertexIndex> fixed = {},
                           const KnownSurface* input = nullptr, const RunContext& context = no_context());

namespace surface {

/// The same of a clean surface or complex, which stays one: nothing crosses, and regions agree.
std::uint64_t keep_volumes_clean(SurfaceMesh& surface, const Features& features, std::span<const double> wanted,
                                 std::span<const VertexIndex> fixed = {}, const KnownSurface* input = nullptr,
                                 const RunContext& context = no_context());

/// Vertices of triangles that cross, ascending.
std::vector<VertexIndex> vertices_in_crossings(const SurfaceMesh& surface);

}  // namespace surface
}  // namespace octafront
