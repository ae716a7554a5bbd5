#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

#include "base/core/stage.h"
#include "base/mesh/known_surface.h"

namespace octafront {

/// Sizes for a surface that is kept: those of its own triangles (robust against needles and jumps), graded, combined
/// with the sources of `options` inside.
SizeField size_field_of_surface(const KnownSurface& surface, const SizeOptions& options, const Stage& stage);

}  // namespace octafront
