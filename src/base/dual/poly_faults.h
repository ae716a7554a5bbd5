#pragma once

#include <octafront/poly_mesh.h>

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace octafront::dual {

struct PolyFaults {
  /// That are not sound, or have a face that solvers complain of: not seen from the middle of a cell beside it, or
  /// lying askew to the line between the middles of its cells. Ascending.
  std::vector<std::uint32_t> cells;
  std::size_t unsound = 0;  ///< how many of them are not closed, or of no volume
  std::size_t turned = 0;   ///< how many have a face that is not seen from a middle

  bool is_less(const PolyFaults& other) const {
    return std::tuple(unsound, turned, cells.size()) < std::tuple(other.unsound, other.turned, other.cells.size());
  }
};

PolyFaults faults_of(const PolyMesh& mesh);

}  // namespace octafront::dual
