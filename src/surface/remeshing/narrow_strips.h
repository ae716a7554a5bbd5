#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "surface/remeshing/walk.h"

namespace octafront::remeshing {

/// How far sizes may fall, in parts of what they were. The narrower strips are finer than the mesh can show.
struct StripRules {
  double floor;          ///< no size falls below this part
  double hopeless;       ///< strips narrower than this part stay bad even so
  double gradation = 0;  ///< from strips sizes may rise so fast, or as fast as elsewhere if that is faster
};
/// Of single surfaces lines that are nearer may merge; of a complex nothing may move.
inline constexpr StripRules kStrips{.floor = 0.3, .hopeless = 0.08};
inline constexpr StripRules kStripsOfWalls{.floor = 0.05, .hopeless = 0.01, .gradation = 0.7};

/// The sizes made smaller in narrow strips: where two feature lines run side by side, nearer to each other than about
/// half an element, triangles between them can be well shaped only if the lines are divided finer. Needs `input` with
/// feature marks. Returns `sizes` itself where there is no such strip.
SizeField fitted_to_strips(const InputSurface& input, const SizeField& sizes, const StripRules& rules,
                           const RunContext& context);

}  // namespace octafront::remeshing
