#pragma once

#include <octafront/named_groups.h>

#include "base/geometry/true_geometry.h"
#include "pipeline/stages/stages.h"

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace octafront {

// Where the true geometry of the input is known (CAD): the mesh on it, and its volumes against the true ones.

/// The options for a domain of CAD: lines are borders of patches, so that features by angle are those that a face has
/// within itself; for sizes and layers parts and groups become their patches and regions.
Options options_for_geometry(const Domain& domain, Options options);
/// Of a body in a wind tunnel its sizes, layers on it, and the Reynolds number of a flow of given speed.
Options options_for_flow(const Domain& domain, Options options);

/// The surface as it is meshed: where solids could not be given common faces each pair has patches of its own.
SurfaceMesh divided(SurfaceMesh surface);

/// The names of the patches that have a triangle: of a file whose solids are meshed one by one not all do.
std::set<std::string> names_with_triangles(const SurfaceMesh& surface);

/// Moves the vertices of boundary and interfaces to the true geometry, and numbers patches as it does;
/// `filled.boundary` follows. Where the input's triangles are kept only the patches change.
void place_on_geometry(const Prepared& input, Filled& filled, Run& run);

/// Patches of the mesh become the named parts that its faces lie in; groups of parts and regions become sets. Parts
/// without a face of the mesh are named in a note.
void name_parts(const Prepared& input, Filled& filled, Run& run);

/// Patches of a mesh, where those of one name are one.
struct MeshPatches {
  std::vector<std::uint32_t> number;  ///< per part, or patch of a surface
  std::vector<std::string> names;
};
/// What becomes of the parts.
MeshPatches patches_of_parts(const TrueGeometry& geometry);
/// What becomes of the patches of a surface of this geometry, each by the largest of its parts; of none they stay.
MeshPatches patches_in_mesh(const SurfaceMesh& surface, const TrueGeometry* geometry);

/// Enters the true volumes into the report, beside those of the mesh, curved as it is.
void describe_true_volumes(const Filled& filled, const Domain& domain, Report& report);

// Sets of a mesh at places that say what something is like, as far as the true geometry knows it.

/// The places of groups (Options::groups) that nothing of the geometry, and no region, is called by.
std::vector<std::string> places_without_names(const TrueGeometry& geometry, std::span<const std::string> groups,
                                              const TetMesh& mesh);

/// Adds what these places mean to a mesh whose patches are parts, as sets that are called like them, of faces or nodes.
/// Returns those of edges, which are for a mesh with curves.
std::vector<PlacedSet> add_found_shapes(const TrueGeometry& geometry, std::span<const std::string> places,
                                        TetMesh& mesh);

}  // namespace octafront
