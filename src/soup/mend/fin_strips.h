#pragma once

#include "soup/mend/loops.h"

#include <vector>

namespace octafront::mend {

/// Per triangle, whether it is of a fin: a strip with nothing but rim, which no cap makes a body. Of a piece that hangs
/// together by edges of two triangles all vertices lie on edges of another number; some of these are open, and either
/// the others are joined to something or the open ones are one loop. A tube, which has two, is no fin.
std::vector<char> triangles_of_fins(std::span<const Triangle> triangles, const EdgeTable& table,
                                    const std::vector<Loop>& loops);

}  // namespace octafront::mend
