#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/remeshing/walk.h"

namespace octafront::remeshing {

/// The sizes made smaller in narrow strips: where two feature lines run side by side, nearer to each other than about
/// half an element, triangles between them can be well shaped only if the lines are divided finer. Needs `input` with
/// feature marks. Down to a part of the size; narrower strips are finer than the mesh can show.
/// Returns `sizes` itself where there is no such strip.
SizeField fitted_to_strips(const InputSurface& input, const SizeField& sizes, const RunContext& context);

}  // namespace octafront::remeshing
