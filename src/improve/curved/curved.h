#pragma once

// improve/curved: elements of order 2, 3 and 4. Takes a valid linear mesh and the surface that its boundary stands for,
// leaves mid-side nodes: those of the boundary on the smooth surface, as far as every element is proven valid. The
// public face is octafront/second_order.h.

#include <octafront/second_order.h>
#include <octafront/surface_mesh.h>

#include "base/geometry/true_geometry.h"
#include "base/mesh/known_surface.h"

#include <span>
#include <vector>

namespace octafront {

// `below`: per vertex the boundary vertex at the foot of its column of boundary layers, or itself. A column moves along
// with its foot. Empty: there are no layers.

/// As make_curved(), with what the pipeline knows already. `sharp`: feature edges of the boundary of the mesh,
/// sorted, those between patches too. `fixed`: frozen corners, ascending.
SecondOrderSummary curve_to_surface(TetMesh& mesh, const std::vector<Edge>& sharp, const KnownSurface& surface,
                                    double feature_angle, std::span<const VertexIndex> below,
                                    std::span<const VertexIndex> fixed, int order, const RunContext& context);

/// Moves the corners on the boundary and on interfaces of a linear mesh to the true geometry, as far as elements keep
/// half of their volume; what did not go the whole way tries again, for a few rounds. Counts `moved` and `held`.
SecondOrderSummary move_to_geometry(TetMesh& mesh, const TrueGeometry& geometry, std::span<const VertexIndex> below,
                                    const RunContext& context);

/// Gives a linear mesh whose corners are on the true geometry the nodes of this order, on it.
SecondOrderSummary curve_to_geometry(TetMesh& mesh, const TrueGeometry& geometry, std::span<const VertexIndex> below,
                                     int order, const RunContext& context);

/// Gives a linear mesh the nodes of this order: edges and faces that have the corners, bit for bit, of some of a curved
/// mesh `before` follow these, as far as every element is proven valid. So improvement keeps the walls of a mesh.
SecondOrderSummary curve_as_before(TetMesh& mesh, const TetMesh& before, int order, const RunContext& context);

/// Boundary and interfaces of a mesh of any order as triangles between all of their nodes; patches as the mesh has
/// them.
SurfaceMesh walls_with_nodes(const TetMesh& mesh);

/// curved_volume() of each region of a mesh.
std::vector<double> curved_volumes(const TetMesh& mesh);

/// What chords of a linear mesh cut off each region: the volume between flat faces and those that parabolas on the true
/// geometry bound, which is negative where they bend inward. Unit: input unit cubed.
std::vector<double> volumes_cut_off(const TetMesh& mesh, const TrueGeometry& geometry);

/// With straight edges.
SecondOrderSummary add_straight_edges(TetMesh& mesh, int order, const RunContext& context);

}  // namespace octafront
