#pragma once

#include <octafront/surface_mesh.h>

#include <cstddef>
#include <cstdint>

namespace octafront {

/// The first byte says how fine the lattice of the coordinates is, each of the others is one.
inline SurfaceMesh triangles_of_bytes(const std::uint8_t* data, std::size_t size) {
  SurfaceMesh s;
  // Coarse lattices make triangles meet in corners and edges; tenths and thirds are never exact.
  constexpr double kSteps[] = {1, 0.1, 1.0 / 3, 0x1p-40};
  const double step = kSteps[data[0] % 4];
  const int most = 2 + data[0] / 4 % 16;
  for (std::size_t i = 1; i + 9 <= size; i += 9) {
    for (std::size_t k = 0; k < 9; k += 3)
      s.points.push_back(
          {step * (data[i + k] % most), step * (data[i + k + 1] % most), step * (data[i + k + 2] % most)});
    const auto n = static_cast<VertexIndex>(s.points.size());
    s.triangles.push_back({n - 3, n - 2, n - 1});
  }
  return s;
}

}  // namespace octafront
