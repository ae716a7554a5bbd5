#pragma once

#include <octafront/ids.h>

#include <optional>
#include <string>
#include <vector>

namespace octafront {

/// An edge that the faces do not run through as often one way as the other; none if they are closed and oriented alike.
std::optional<Edge> first_open_edge(const std::vector<Triangle>& faces);

/// The same as a sentence about `what` (in the plural), for validators.
std::optional<std::string> why_not_closed(const std::vector<Triangle>& faces, const std::string& what);

}  // namespace octafront
