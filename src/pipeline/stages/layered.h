#pragma once

// Boundary layers in the pipeline: grown from the surface before the volume is filled, put under the mesh when that is
// done, and reported; or grown on the outside of a mesh that is done.

#include <octafront/surface_mesh.h>

#include "layers/with_layers.h"
#include "pipeline/stages/run.h"
#include "surface/remeshing/remesh.h"

#include <optional>
#include <span>
#include <vector>

namespace octafront {

struct Filled;
struct Prepared;

/// The surface that layers grow from, and what grows in its regions.
struct GrownLayers {
  SurfaceMesh whole;
  std::vector<layers::LayeredRegion> regions;
  layers::Opened opened;
  /// Once they are part of the mesh: what in it follows the input, and what goes along.
  SurfaceMesh ground = {};
  std::vector<VertexIndex> below = {};
};

/// Throws OptionError for contradictions, values out of range, and what layers do not go with.
void check_layer_options(const Options& options);

/// How many tetrahedra the layers are if all of them can be. Throws OptionError for names that are not there.
double expected_layer_tets(const SurfaceMesh& surface, const LayersOptions& asked);
/// How many they will be; outside, where they are yet to grow, at most.
double layer_tets(const Filled& filled, const LayersOptions& asked);

/// Grows the layers that the run asks for from `boundary`, which becomes the surface without them. Layers outside wait
/// for add_layers(). Throws OptionError for patches and regions that are not there, MeshingError if too little of a
/// wall has layers.
std::optional<GrownLayers> grow_layers(const Prepared& input, Remeshed& boundary, Run& run);

/// Puts the layers under the mesh of what is inside, whose edges are measured against the sizes before, or grows them
/// outside of it. Nothing if none are asked for.
void add_layers(const Prepared& input, Filled& filled, Run& run);

/// Of the volumes of all regions those of layers, each by the region that they grow in.
std::vector<double> layers_volumes(const Filled& filled, const std::vector<double>& volumes);

/// Per vertex the one of the wall below it; empty if nothing grows.
std::span<const VertexIndex> vertices_below(const Filled& filled);

}  // namespace octafront
