#pragma once

// How many elements a metric comes to on a mesh or a surface: known before anything is divided.

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "adapt/metric/metric.h"

namespace octafront::adapt {

/// About so many tetrahedra, or triangles, fit the metric. Where it changes much within an element its integral is
/// taken in parts; beyond all that a mesh could hold only the magnitude is right. The same for any number of threads.
double expected_tets(const TetMesh& mesh, const MetricField& metric);
double expected_triangles(const SurfaceMesh& surface, const MetricField& metric);

}  // namespace octafront::adapt
