#pragma once

// Smaller sizes that the surface itself asks for: strips between lines (narrow_strips), corners of
// complexes (corner_sizes), patches that are not as flat as their elements (flat_sizes). Takes the input and its
// curves, leaves sizes.

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/edits/walk.h"

#include <optional>

namespace octafront::surface {

/// What a strip is, and what becomes of sizes there.
struct StripRules {
  double size_per_width;  ///< size wanted in a strip, in widths of it
  double parallel;        ///< cosine between the lines of a strip: those that part at a corner are none
  double floor;           ///< no size falls below this part of what it was
  double hopeless;        ///< strips narrower than this part of the size stay bad even so
  double gradation = 0;   ///< from strips sizes may rise so fast, or as fast as elsewhere if that is faster
  double least = 0;       ///< no size falls below this, input units
  double narrowest = 0;   ///< strips narrower than this stay as they come, input units
};
/// Triangles of 1.5 widths between the lines have 2r/R of .94. (At 2 widths models full of strips lose .01 of their
/// mean; at 1.2 they gain .005 and have a third more triangles.) The lines differ by 12 degrees at most.
inline constexpr StripRules kStrips{.size_per_width = 1.5, .parallel = 0.978, .floor = 0.3, .hopeless = 0.08};
/// Of single surfaces lines that are nearer may merge; of a complex nothing may move, and walls as narrow as one likes
/// are common: triangles of 2r/R .83 shall do, and 8 degrees.
inline constexpr StripRules kStripsOfWalls{
    .size_per_width = 2, .parallel = 0.99, .floor = 0.1, .hopeless = 0.02, .gradation = 0.7};

/// The sizes made smaller in narrow strips: where two feature lines run side by side, nearer to each other than about
/// half an element, triangles between them can be well shaped only if the lines are divided finer. Needs `input` with
/// feature marks. Empty where there is no such strip.
std::optional<SizeField> fitted_to_strips(const InputSurface& input, const SizeField& sizes, const StripRules& rules,
                                          const RunContext& context);

}  // namespace octafront::surface
