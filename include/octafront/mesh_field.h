#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace octafront {

/// Numbers on a mesh, at its vertices or of its elements.
struct MeshField {
  std::string name;
  bool of_elements = false;
  std::size_t components = 1;  ///< numbers for each, > 0
  std::vector<double> values;  ///< those of the first vertex or element, then those of the second, ...
};

}  // namespace octafront
