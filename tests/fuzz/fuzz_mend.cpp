// Any triangles: the first byte says how fine the lattice of the coordinates is, each of the others is one. Mended,
// they are a clean surface, the same again when mended once more, or an InputError.

#include <octafront/error.h>
#include <octafront/mend.h>
#include <octafront/repair.h>

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
    const Mended mended = mend_surface(surface_of(data, size));
    if (!find_defects(repair_surface(mended.surface)).clean()) std::abort();
    if (!mended.report.clean && mended.surface.source.size() != mended.surface.triangles.size() &&
        !mended.surface.source.empty())
      std::abort();
    if (to_json(mended.report).empty()) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
