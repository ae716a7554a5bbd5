#include <octafront/error.h>

#include "formats/parts/division.h"

namespace octafront {

bool has_metis() {
  return false;
}

namespace io {

std::vector<std::uint32_t> divide_graph(std::vector<std::int32_t>, std::vector<std::int32_t>, std::uint32_t) {
  throw OptionError(
      "this octafront was built without METIS; build it with libmetis-dev installed, or divide along the "
      "curve");
}

}  // namespace io

}  // namespace octafront
