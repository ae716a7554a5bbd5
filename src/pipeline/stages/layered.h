#pragma once

// Boundary layers in the pipeline: grown from the surface before the volume is filled, put under the mesh when that is
// done, and reported.

#include <octafront/surface_mesh.h>

#include "layers/columns/columns.h"
#include "pipeline/stages/run.h"
#include "surface/remeshing/remesh.h"

#include <optional>

namespace octafront {

struct Filled;

/// The surface that layers grow from, and their columns.
struct GrownLayers {
  SurfaceMesh wall;
  layers::Columns columns;
};

/// Throws OptionError for contradictions, values out of range, and what layers do not go with.
void check_layer_options(const Options& options);

/// Grows the layers that the run asks for from `boundary`, whose vertices move to their tops. Throws OptionError for
/// patches that are not there, MeshingError if too little of a wall has them.
std::optional<GrownLayers> grow_layers(Remeshed& boundary, Run& run);

/// Puts the layers under the mesh of what is inside, whose edges are measured against the sizes before. Nothing if
/// there are none.
void add_layers(Filled& filled, Run& run);

}  // namespace octafront
