// Any triangles (triangles_of_bytes.h). Mended, they are a clean surface, the same again when mended once more, or an
// InputError.

#include <octafront/error.h>
#include <octafront/mend.h>
#include <octafront/repair.h>

#include "triangles_of_bytes.h"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  if (size < 10 || size > 400) return 0;
  try {
    const Mended mended = mend_surface(triangles_of_bytes(data, size));
    if (!find_defects(repair_surface(mended.surface)).clean()) std::abort();
    if (!mended.report.clean && mended.surface.source.size() != mended.surface.triangles.size() &&
        !mended.surface.source.empty())
      std::abort();
    if (to_json(mended.report).empty()) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
