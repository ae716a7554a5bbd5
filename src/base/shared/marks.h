#pragma once

#include "base/shared/comm.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace octafront {

/// What a rank has marked (1) of things that all have, all have then. A rank takes about a quarter of a byte a thing,
/// less where few are marked, however many ranks there are.
void join_marks(const Comm& comm, std::vector<std::uint8_t>& marks, std::string_view what);

/// Marks what more than one rank has marked.
std::vector<std::uint8_t> marked_by_several(const Comm& comm, const std::vector<std::uint8_t>& marks,
                                            std::string_view what);

}  // namespace octafront
