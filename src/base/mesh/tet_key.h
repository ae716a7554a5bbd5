#pragma once

#include <octafront/tet_mesh.h>

#include <algorithm>

namespace octafront {

/// The corners of a tet in ascending order: its name, wherever it is kept, for no two of a valid mesh have the same.
inline Tet tet_key(const Tet& t) {
  const VertexIndex a = std::min(t[0], t[1]), b = std::max(t[0], t[1]), c = std::min(t[2], t[3]),
                    d = std::max(t[2], t[3]);
  const VertexIndex low = std::max(a, c), high = std::min(b, d);
  return {std::min(a, c), std::min(low, high), std::max(low, high), std::max(b, d)};
}

}  // namespace octafront
