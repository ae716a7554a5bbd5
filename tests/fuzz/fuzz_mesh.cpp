// Any bytes: a mesh whose indices are in range, whose points are finite and all used, or an InputError.

#include <octafront/error.h>

#include "io/readers.h"

#include <cstdint>
#include <cstdlib>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  try {
    const TetMesh m = io::read_mesh_bytes({"a.mesh", {reinterpret_cast<const char*>(data), size}}).mesh;
    if (m.tets.empty() || (!m.region.empty() && m.region.size() != m.tets.size())) std::abort();
    if (!m.patch.empty() && m.patch.size() != m.boundary.size()) std::abort();
    if (!m.source.empty() && m.source.size() != m.boundary.size()) std::abort();
    std::vector<bool> used(m.points.size(), false);
    for (const Tet& t : m.tets) {
      for (const VertexIndex v : t) {
        if (v >= m.points.size() || !is_finite(m.points[v])) std::abort();
        used[v] = true;
      }
    }
    for (const Triangle& t : m.boundary)
      for (const VertexIndex v : t)
        if (v >= m.points.size()) std::abort();
    for (const bool is_used : used)
      if (!is_used) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
