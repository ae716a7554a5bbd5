#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>

#include "sizing/octree_field.h"

#include <memory>

namespace octafront {

/// The grid with options.regions laid on. Throws OptionError where a region would make more elements than a mesh can
/// hold.
std::shared_ptr<OctreeField> with_regions(std::shared_ptr<OctreeField> grid, const SizeOptions& options,
                                          const RunContext& context);

}  // namespace octafront
