#pragma once

// Sizes that come to a number of elements: one that is asked for, or a budget that sizes of our own
// choice keep to.

#include <octafront/options.h>
#include <octafront/size_field.h>

#include "base/core/stage.h"
#include "base/mesh/known_surface.h"
#include "sizing/sources/wanted_sizes.h"

#include <cmath>

namespace octafront {

/// Builds the octree background grid from the sources of `options` on a clean surface: 2:1 balanced, sizes at leaf
/// corners, graded, continuous inside leaves. Throws OptionError for contradictions and values out of range.
/// With options.elements the sizes are scaled until expected_tets() meets it. `budget`: elements that sizes of our own
/// choice come to at most.
SizeField make_size_field(const KnownSurface& surface, const SizeOptions& options, const Stage& stage,
                          const FaceRules& rules = {}, double budget = HUGE_VAL);

}  // namespace octafront
