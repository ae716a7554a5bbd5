#pragma once

// Whether a result is still the body that went in. Bounds on distance alone do not say so: a plate thinner than the
// bound may become any number of times as thick within it.

#include "pipeline/stages/stages.h"

#include <cmath>
#include <functional>

namespace octafront {

/// With automatic sizes a body keeps its volume within this part of it, as far as elements stay good, and improvement
/// keeps it so at any size.
inline constexpr double kVolumeKept = 0.01;

/// By which part of it a volume has changed.
double change_of_volume(double made, double input);

/// The surface made by `sizes`. If its volume is off by more than the mesh could give back and sizes are automatic:
/// made again by smaller ones, and the input's own triangles if that does not help, or takes more elements than
/// `budget`. A note says so.
Remeshed remeshed_in_shape(const Prepared& input, const SizeField& sizes, const Run& run, const Stage& stage,
                           const std::function<Remeshed(const SizeField&)>& remesh, double budget = HUGE_VAL);

/// Whether automatic sizes have cost a body volume that its mesh is to get back: moves of the boundary's vertices,
/// where no true geometry says where they are.
bool owes_volume(const Prepared& input, const Remeshed& boundary, const Run& run);

/// The volume filled and improved. Where improvement changes the volume by more than kVolumeKept it is done once more
/// on a boundary that stays where it is.
void improve_in_shape(const Prepared& input, Filled& filled, Run& run);

/// Throws MeshingError if sizes are automatic and the volume of a single surface is far out still, or its
/// extent by more than it may stray.
void check_shape(const Prepared& input, const Filled& filled, Run& run);

}  // namespace octafront
