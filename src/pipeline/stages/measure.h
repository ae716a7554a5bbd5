#pragma once

#include <octafront/report.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/shared/comm.h"

namespace octafront {

/// Edge lengths over wanted lengths: of the boundary's edges, and of all edges of the mesh.
SizeSummary summarize_surface_edges(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                    const SizeField& sizes);
/// `comm`, here and below: of ranks whose tetrahedra are shares, numbered by rank; all get the same answer.
SizeSummary summarize_volume_edges(const TetMesh& mesh, const SizeField& sizes, const Comm& comm = Comm(nullptr));

/// Fills in what the report says of sizes: asked for against made.
void describe_sizes(const TetMesh& mesh, const SizeField& sizes, Report& report, const Comm& comm = Comm(nullptr));

/// Fills in what the report says of the elements, and of each region.
void describe_quality(const TetMesh& mesh, Report& report, const Comm& comm = Comm(nullptr));
void describe_regions(const TetMesh& mesh, Report& report, const Comm& comm = Comm(nullptr));

/// A fingerprint of coordinates (bits), tets, regions, boundary, interfaces, patches and mid-side nodes, 64 bits: equal
/// meshes, equal hash. A sum over the items, each mixed with its place, so that no number of threads or ranks is seen.
std::uint64_t mesh_hash(const TetMesh& mesh, const Comm& comm = Comm(nullptr));

/// Largest resident memory of this process so far.
std::uint64_t peak_memory_bytes();

}  // namespace octafront
