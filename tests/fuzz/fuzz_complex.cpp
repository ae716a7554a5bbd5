// Any surface that a file can hold: arranged, no triangles cross any more and input points stay; its cells have
// volumes, and what becomes of them is a complex or an InputError.

#include <octafront/complex.h>
#include <octafront/error.h>

#include "arrangement/arrange.h"
#include "cells/find_cells.h"
#include "geometry/self_intersection.h"
#include "io/readers.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  try {
    const SurfaceFile file = io::read_surface_bytes({"a", {reinterpret_cast<const char*>(data), size}});
    const SurfaceMesh& s = file.surface;
    for (const Vec3 p : s.points)
      for (int i = 0; i < 3; ++i)
        if (std::abs(p[i]) > 1e50 || (p[i] != 0 && std::abs(p[i]) < 1e-40)) return 0;  // beyond the predicates
    const Arrangement arranged = arrange(s.points, s.triangles);
    if (!self_intersections(arranged.points, arranged.triangles).empty()) std::abort();
    for (std::size_t v = 0; v < s.points.size(); ++v)
      if (arranged.points[v] != s.points[v]) std::abort();
    if (arranged.triangles.empty()) return 0;
    const Cells cells(arranged.points, arranged.triangles);
    if (cells.volumes().size() != cells.count()) std::abort();
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
