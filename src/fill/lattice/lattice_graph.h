#pragma once

#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include "fill/lattice/graded_bcc.h"
#include "fill/lattice/implicit_domain.h"
#include "fill/lattice/site_table.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront {

/// The lattice as far as a domain needs it: the tetrahedra with a corner inside, their sites, on which side each lies,
/// and the edges that cross the boundary.
struct LatticeGraph {
  std::vector<LatticeSite> sites;
  std::vector<Vec3> at;                            ///< per site; moves when it is warped
  std::vector<std::int8_t> side;                   ///< per site: +1, 0, -1
  std::vector<std::array<std::uint32_t, 4>> tets;  ///< positive, indices of sites, at least one inside

  struct CutEdge {
    std::uint32_t inside, outside;  ///< indices of sites
    double part = 0.5;              ///< of the way from `inside` at which the boundary is
  };
  std::vector<CutEdge> cuts;  ///< sorted by (smaller index, larger index)

  /// Index of the cut edge between two sites, one inside and one outside.
  std::uint32_t cut_between(std::uint32_t a, std::uint32_t b) const;
};

LatticeGraph build_lattice_graph(const RootCube& root, const Octree& tree, const ImplicitDomain& domain,
                                 const RunContext& context);

}  // namespace octafront
