// Any bytes as an image, those behind four bytes 255 as the file beside it: a grid that maps to the world and back,
// with a finite value for each voxel, or an InputError. Labels of it are cleaned.

#include "image_oracle.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront::testing;
  int read = 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (!read_any(bytes, broken_by_cleaning, read).empty()) std::abort();
  return 0;
}
