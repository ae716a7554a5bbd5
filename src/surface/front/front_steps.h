#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/edits/working_mesh.h"
#include "surface/front/surface_front.h"
#include "surface/lines/curve_points.h"
#include "surface/lines/curves.h"

namespace octafront::surface {

struct InsertionCounts {
  std::uint64_t inserted = 0;  ///< as new vertices
  std::uint64_t adopted = 0;   ///< input vertices that are points of the front
  std::uint64_t skipped = 0;   ///< too near to a feature or to another point
};

/// The input triangulation with the points of the front put in: each in the face or edge where it lies.
WorkingMesh insert_points(const InputSurface& input, const std::vector<Curve>& curves, const FrontPoints& front,
                          const RunContext& context, InsertionCounts& counts);

// Better triangles once the front has gone: flips, smoothing, small mending (shaping), lengths that
// fit the sizes (lengths). Takes the mesh, leaves it with the same lines.

struct ImproveCounts {
  std::uint64_t flips = 0, moves = 0, splits = 0, collapses = 0;
};

/// Makes the triangles of the working mesh better: flips towards six triangles a vertex and towards Delaunay, and
/// smoothing along the input surface, of division points along their curves. Corners stay; the others move only where
/// the mean quality of their triangles rises.
void improve_surface(WorkingMesh& mesh, const InputSurface& input, const std::vector<Curve>& curves,
                     const SizeField& sizes, const RunContext& context, ImproveCounts& counts);

/// Mends what the front left too long, too short or too flat: splits long edges inside patches, collapses short ones,
/// and turns edges, moves, adds or removes vertices of bad triangles where that makes the worst triangle around better.
void adjust_lengths(WorkingMesh& mesh, const InputSurface& input, CurvePoints& curve_points, const SizeField& sizes,
                    ImproveCounts& counts);
/// The last of these steps alone: the badly shaped triangles.
void mend_triangles(WorkingMesh& mesh, const InputSurface& input, CurvePoints& curve_points, const SizeField& sizes,
                    ImproveCounts& counts);

}  // namespace octafront::surface
