// Any triangles (triangles_of_bytes.h). Arranged, no triangles cross any more and input points stay; cells have
// volumes, and what becomes of them is a complex or an InputError.

#include <octafront/complex.h>
#include <octafront/error.h>

#include "base/geometry/self_intersection.h"
#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"
#include "triangles_of_bytes.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  if (size < 10 || size > 400) return 0;
  try {
    const SurfaceMesh s = triangles_of_bytes(data, size);
    const Arrangement arranged = arrange(s.points, s.triangles);
    if (!self_intersections(arranged.points, arranged.triangles).empty()) std::abort();
    for (std::size_t v = 0; v < s.points.size(); ++v)
      if (arranged.points[v] != s.points[v]) std::abort();
    if (arranged.triangles.empty()) return 0;
    const Cells cells(arranged.points, arranged.triangles);
    for (std::uint32_t c = 1; c < cells.count(); ++c)
      if (!(cells.volumes()[c] >= 0)) std::abort();
    ComplexOptions options;
    options.cells = ComplexOptions::Cells::kRegions;
    const auto complex = complex_of_walls(s, options);
    if (complex && !complex->surface.sides.empty() &&
        complex->surface.sides.size() != complex->surface.triangles.size())
      std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
