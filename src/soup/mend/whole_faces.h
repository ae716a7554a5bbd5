#pragma once

#include <octafront/ids.h>

#include "soup/mend/skin.h"

#include <vector>

namespace octafront::mend {

/// Puts faces that were divided, and of which all parts came to be skin, back in the place of their parts: where a fin
/// that is gone crossed them nothing shall be left of it, for its cuts leave needles by which sizes would go. `given`:
/// the triangles that were arranged. Points that only such parts use are used no more. The points of `skin` are those
/// of the arrangement.
void restore_whole_faces(const Arrangement& arranged, const std::vector<Triangle>& given, Skin& skin,
                         const RunContext& context);

}  // namespace octafront::mend
