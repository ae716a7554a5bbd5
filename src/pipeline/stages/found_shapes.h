#pragma once

// Sets of a mesh at places that say what something is like, as far as the true geometry knows it.

#include <octafront/named_groups.h>

#include "base/geometry/true_geometry.h"

#include <span>
#include <string>
#include <vector>

namespace octafront {

/// The places of groups (Options::groups) that nothing of the geometry, and no region, is called by.
std::vector<std::string> places_without_names(const TrueGeometry& geometry, std::span<const std::string> groups,
                                              const TetMesh& mesh);

/// Adds what these places mean to a mesh whose patches are parts, as sets that are called like them, of faces or nodes.
/// Returns those of edges, which are for a mesh with curves.
std::vector<PlacedSet> add_found_shapes(const TrueGeometry& geometry, std::span<const std::string> places,
                                        TetMesh& mesh);

}  // namespace octafront
