#pragma once

#include <octafront/repair.h>
#include <octafront/run_context.h>

#include "base/mesh/edge_table.h"

namespace octafront {

/// repair_surface() and find_defects() in one, with the edges of the repaired surface, which both look at.
struct Examined {
  RepairedSurface repaired;
  EdgeTable edges;
  SurfaceDefects defects;
};
/// `is_clean`: the soup is known to have no defect, and none is looked for.
Examined examine_surface(const SurfaceMesh& soup, bool is_clean, const RunContext& context);

}  // namespace octafront
