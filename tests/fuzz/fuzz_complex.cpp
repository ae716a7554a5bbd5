// Any triangles: the first byte says how fine the lattice of the coordinates is, each of the others is one. Arranged,
// no triangles cross any more and input points stay; cells have volumes, and what becomes of them is a complex or an
// InputError.

#include <octafront/complex.h>
#include <octafront/error.h>

#include "arrangement/arrange.h"
#include "cells/find_cells.h"
#include "geometry/self_intersection.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace {

octafront::SurfaceMesh surface_of(const std::uint8_t* data, std::size_t size) {
  octafront::SurfaceMesh s;
  // Coarse lattices make triangles meet in corners and edges; tenths and thirds are never exact.
  constexpr double kSteps[] = {1, 0.1, 1.0 / 3, 0x1p-40};
  const double step = kSteps[data[0] % 4];
  const int most = 2 + data[0] / 4 % 16;
  for (std::size_t i = 1; i + 9 <= size; i += 9) {
    for (std::size_t k = 0; k < 9; k += 3)
      s.points.push_back(
          {step * (data[i + k] % most), step * (data[i + k + 1] % most), step * (data[i + k + 2] % most)});
    const auto n = static_cast<octafront::VertexIndex>(s.points.size());
    s.triangles.push_back({n - 3, n - 2, n - 1});
  }
  return s;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  if (size < 10 || size > 400) return 0;
  try {
    const SurfaceMesh s = surface_of(data, size);
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
