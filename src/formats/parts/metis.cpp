#include <octafront/error.h>

#include "formats/parts/division.h"

#include <array>
#include <type_traits>

#include <fmt/core.h>
#include <metis.h>

namespace octafront {

bool has_metis() {
  return true;
}

namespace io {

static_assert(std::is_same_v<idx_t, std::int32_t>, "METIS built with IDXTYPEWIDTH 32");

std::vector<std::uint32_t> divide_graph(std::vector<std::int32_t> first, std::vector<std::int32_t> next,
                                        std::uint32_t parts) {
  auto elements = static_cast<idx_t>(first.size() - 1);
  idx_t constraints = 1, wanted = static_cast<idx_t>(parts), cut = 0;
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_SEED] = 1;
  std::vector<idx_t> part(first.size() - 1);
  const int status = METIS_PartGraphKway(&elements, &constraints, first.data(), next.data(), nullptr, nullptr, nullptr,
                                         &wanted, nullptr, nullptr, options.data(), &cut, part.data());
  if (status != METIS_OK)
    throw OutputError(fmt::format("METIS could not divide the mesh into {} parts{}; divide it along the curve", parts,
                                  status == METIS_ERROR_MEMORY ? ": out of memory" : ""));
  return {part.begin(), part.end()};
}

}  // namespace io

}  // namespace octafront
