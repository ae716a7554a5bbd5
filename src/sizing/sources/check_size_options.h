#pragma once

#include <octafront/options.h>

#include "base/core/stage.h"

namespace octafront {

struct SurfaceMesh;

/// Throws OptionError for values out of range and for contradictions.
void check_size_options(const SizeOptions& options);

/// Says which regions and points of `options` lie outside of the model's box, and how much of the surface a field does
/// not cover. Throws OptionError for a field that covers none of it.
void note_misplaced_sizes(const SurfaceMesh& surface, const SizeOptions& options, const Stage& stage);

}  // namespace octafront
