#pragma once

// Periodic cells in the pipeline: the input's opposite faces made the same, what stays where it is, nodes paired.

#include <octafront/domain.h>

#include "periodic/periodic_cell.h"
#include "pipeline/stages/run.h"

#include <optional>

namespace octafront {

struct Prepared;
struct TetMesh;

/// Throws OptionError for what is no list of axes, and what periods do not go with.
void check_periodic_options(const Options& options);

/// A domain whose opposite faces are the same triangles, and its cell.
struct PeriodicDomain {
  Domain domain;
  PeriodicCell cell;
};

/// Of the run's axes; nullopt where there are none, or the surface has defects, which prepare() refuses.
/// Throws InputError where opposite faces differ.
std::optional<PeriodicDomain> made_periodic(const Domain& domain, Run& run);

/// Mid-side nodes on periodic faces lie in them, and those of copies where their originals do; where an element would
/// not be valid then, the edges are straight. Nothing for linear meshes.
void pair_mid_nodes(TetMesh& mesh, const PeriodicCell& cell, const Stage& stage);

/// The same of a periodic mesh that is improved, by the pairs of its vertices; those nodes become pairs, too.
void pair_mid_nodes(TetMesh& mesh, Run& run);

/// Leaves periods and pairs of nodes in the mesh; patches that make up one face become one. Throws MeshingError if the
/// boundary faces of opposite faces are not the same.
void pair_nodes(const Prepared& input, TetMesh& mesh, Run& run);

}  // namespace octafront
