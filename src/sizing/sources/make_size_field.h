#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "base/core/stage.h"
#include "base/mesh/known_surface.h"
#include "sizing/sources/wanted_sizes.h"

#include <cmath>

namespace octafront {

struct SurfaceMesh;

// Sizes that come to a number of elements: one that is asked for, or a budget that sizes of our own
// choice keep to.

/// Builds the octree background grid from the sources of `options` on a clean surface: 2:1 balanced, sizes at leaf
/// corners, graded, continuous inside leaves. Throws OptionError for contradictions and values out of range.
/// With options.elements the sizes are scaled until expected_tets() meets it. `budget`: elements that sizes of our own
/// choice come to at most.
SizeField make_size_field(const KnownSurface& surface, const SizeOptions& options, const Stage& stage,
                          const FaceRules& rules = {}, double budget = HUGE_VAL);

/// Sizes for a surface that is kept: those of its own triangles (robust against needles and jumps), graded, combined
/// with the sources of `options` inside.
SizeField size_field_of_surface(const KnownSurface& surface, const SizeOptions& options, const Stage& stage);

/// Throws OptionError for values out of range and for contradictions.
void check_size_options(const SizeOptions& options);

/// Says which regions and points of `options` lie outside of the model's box, and how much of the surface a field does
/// not cover. Throws OptionError for a field that covers none of it.
void note_misplaced_sizes(const SurfaceMesh& surface, const SizeOptions& options, const Stage& stage);

}  // namespace octafront
