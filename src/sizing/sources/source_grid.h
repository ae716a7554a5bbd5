#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "sizing/field/background_grid.h"
#include "sizing/sources/wanted_sizes.h"

#include <memory>

namespace octafront {

struct SurfaceMesh;

/// How background grids are made by these options, with no size above `ceiling`.
GridRules grid_rules(const SizeOptions& options, double ceiling);

/// A background grid with options.regions laid on. Throws OptionError where a region would make more elements than a
/// mesh can hold.
std::shared_ptr<OctreeField> with_regions(std::shared_ptr<OctreeField> grid, const SizeOptions& options,
                                          const RunContext& context);

/// For a look at what sizes come to: leaves are so many times larger than they are to be, and OctreeField::source
/// stays.
struct GridLook {
  double coarser = 1;
  bool keeps_sources = false;
};

/// The sizes wanted on a surface and those of options.regions, in a background grid. With options.elements
/// OctreeField::source stays.
SizeField source_grid(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                      const RunContext& context, const GridLook& look = {});

}  // namespace octafront
