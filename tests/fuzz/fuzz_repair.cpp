// Any surface that a file can hold: repair leaves indices in range, moves no vertex, and the check for defects ends.

#include <octafront/error.h>
#include <octafront/repair.h>

#include "formats/files/formats.h"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  try {
    const SurfaceFile file = io::read_surface_bytes({"a", {reinterpret_cast<const char*>(data), size}});
    const RepairedSurface repaired = repair_surface(file.surface);
    const SurfaceMesh& s = repaired.surface;
    if (!s.source.empty() && s.source.size() != s.triangles.size()) std::abort();
    for (const Triangle& t : s.triangles)
      for (const VertexIndex v : t)
        if (v >= s.points.size()) std::abort();
    const SurfaceDefects defects = find_defects(repaired);
    if (defects.clean() != defects.describe().empty()) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
