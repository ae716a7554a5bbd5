#pragma once

// What stays as it is while a mesh is adapted: what the options name, and what the mesh itself has as required.

#include <octafront/options.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace octafront {

/// Sets that are added to a mesh for as long as it is adapted, for sets go along with what they hold.
struct KeptItems {
  std::vector<std::uint32_t> sets;  ///< all that are to stay, by number
  std::vector<Triangle> faces;      ///< of them
  std::size_t own_sets = 0;         ///< how many the mesh had before
};
/// Throws OptionError for names of nothing that could stay.
KeptItems add_kept_items(TetMesh& mesh, const Options& options, const Stage& stage);
/// Takes away what was added.
void drop_kept_items(TetMesh& mesh, const KeptItems& kept);

}  // namespace octafront
