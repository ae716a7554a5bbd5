// Any bytes as TetGen's .poly or .smesh, with nodes beside behind a byte 255: a surface, or an InputError.

#include <octafront/error.h>

#include "formats/read/readers.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(all.find('\xff'), all.size());
  const io::Input facets{"a", all.substr(0, end)}, nodes{"b", all.substr(std::min(all.size(), end + 1))};
  try {
    const SurfaceFile file = io::read_poly(facets, size % 2 == 0, nodes.bytes.empty() ? nullptr : &nodes);
    for (const Triangle& t : file.surface.triangles)
      for (const VertexIndex v : t)
        if (v >= file.surface.points.size()) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
