// Any bytes: a surface whose indices are in range and whose points are finite, or an InputError.

#include <octafront/error.h>

#include "formats/files/formats.h"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  // The name matters only for a missing keyword OFF and for STL of a wrong size.
  static constexpr const char* kNames[] = {"a.off", "a.stl", "a"};
  const char* const name = kNames[size % 3];
  try {
    const SurfaceFile file = io::read_surface_bytes({name, {reinterpret_cast<const char*>(data), size}});
    const SurfaceMesh& s = file.surface;
    if (s.triangles.empty() || (!s.source.empty() && s.source.size() != s.triangles.size())) std::abort();
    if (!s.patch.empty() && s.patch.size() != s.triangles.size()) std::abort();
    for (const Triangle& t : s.triangles)
      for (const VertexIndex v : t)
        if (v >= s.points.size() || !is_finite(s.points[v])) std::abort();
    // Small multiple of the size, whatever the header claims.
    if (s.points.size() > size || s.triangles.size() > size) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
