#pragma once

// Curved elements as Netgen keeps them ("curvedelements" of .vol files, which it has from April 2026 on): what each
// edge and face adds to straight elements, in hierarchical polynomials; inside elements nothing is added.

#include <octafront/tet_mesh.h>

#include "base/core/function_ref.h"
#include "base/geometry/tet_lattice.h"
#include "formats/parts/tet_parts.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::io {

struct NetgenCurves {
  /// What edges, or faces, add: `order` 1 is nothing; coefficients of number n begin at first[n], the last is their
  /// end.
  struct Part {
    NumberedParts numbers;  ///< sorted
    std::vector<std::int64_t> order, first;
    std::vector<Vec3> coefficients;
  };

  /// Straight edges and faces of these tetrahedra, which are kept.
  NetgenCurves(std::span<const Tet> tets, std::size_t vertices);
  /// Those of elements of order 3 or 4 (or 2) whose nodes, by their places in tet_lattice(), node_at() knows.
  NetgenCurves(std::span<const Tet> tets, std::size_t vertices, int order,
               FunctionRef<Vec3(TetIndex, std::size_t)> node_at);

  /// What is added to the straight element t where the barycentric coordinates are `at`.
  Vec3 added(TetIndex t, const std::array<double, 4>& at) const;

  std::span<const Tet> tets;
  Part edges, faces;

 private:
  Vec3 of_edges(TetIndex t, const std::array<double, 4>& at) const;
};

/// So many coefficients has an edge, or a face, of that order.
constexpr std::int64_t netgen_coefficients(std::int64_t order, bool is_edge) {
  return is_edge ? order - 1 : (order - 1) * (order - 2) / 2;
}

}  // namespace octafront::io
