#pragma once

#include "base/core/parallel.h"
#include "surface/edits/working_mesh.h"

#include <cstdint>
#include <vector>

namespace octafront::surface {

/// Work on few items of many, in ascending order, while the mesh changes. All threads look for the items first; behind
/// what work changed each item is looked at once more when its turn comes, as if one thread had gone through all.
///
/// `count()`: how many items there are, which may grow. `is_wanted(i)` depends on the triangles at the vertices of the
/// item alone, and `is_changed(i)` tells whether one of these is marked kForSweep. `work(i)` is called for items that
/// are wanted, or were before others changed; returns whether it changed the mesh.
template <class Count, class IsWanted, class IsChanged, class Work>
bool sweep(WorkingMesh& mesh, const Count& count, const IsWanted& is_wanted, const IsChanged& is_changed,
           const Work& work) {
  constexpr std::size_t kRange = 8192;
  const std::size_t known = count();
  const std::vector<std::uint32_t> wanted = parallel_select(known, is_wanted, kRange);
  std::size_t next = 0;
  for (; next < wanted.size(); ++next) {
    if (next == 0) mesh.clear_marks(WorkingMesh::kForSweep);
    if (work(wanted[next])) break;
  }
  if (next == wanted.size()) return false;
  for (std::uint32_t i = wanted[next++] + 1; i < count(); ++i) {
    const bool is_next = next < wanted.size() && wanted[next] == i;
    if (is_next) ++next;
    if (is_next || i >= known || is_changed(i)) work(i);
  }
  return true;
}

}  // namespace octafront::surface
