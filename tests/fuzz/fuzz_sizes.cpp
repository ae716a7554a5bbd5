// Any bytes: sizes above 0 at finite places, or an InputError.

#include <octafront/error.h>

#include "formats/files/size_readers.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  const io::Input input{"a", {reinterpret_cast<const char*>(data), size}};
  const auto is_size = [](double h) { return std::isfinite(h) && h > 0; };
  try {
    for (const PointSize& s : read_point_sizes_bytes(input))
      if (!is_finite(s.p) || !is_size(s.size)) std::abort();
  } catch (const InputError&) {
  }
  try {
    for (const SizeRegion& r : read_size_regions_bytes(input))
      if (!is_finite(r.lo) || !is_finite(r.hi) || !is_size(r.size) || !(r.radius >= 0)) std::abort();
  } catch (const InputError&) {
  }
  try {
    const SizeField sizes = read_size_field_bytes(input, 0.2);
    if (!is_size(sizes.min_size()) || !is_size(sizes.at({0.5, 0.5, 0.5}))) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
