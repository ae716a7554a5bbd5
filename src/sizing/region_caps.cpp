#include "sizing/region_caps.h"

#include <octafront/error.h>

#include "base/mesh/index_range.h"
#include "sizing/grid_caps.h"
#include "sizing/size_sources.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Regions as caps; what they come to inside the root cube must be a number of elements that a mesh can hold.
std::vector<SizeCap> caps_of_regions(const SizeOptions& options, const RootCube& root) {
  std::vector<SizeCap> caps;
  for (const SizeRegion& r : options.regions) {
    const double h = std::max(r.size, options.min_size.value_or(0));
    caps.push_back({r.lo, r.hi, h, r.radius + 0.5 * h});  // leaves reach across the edge of the region
    const Vec3 reach{r.radius, r.radius, r.radius}, side{root.side, root.side, root.side};
    const Vec3 extent = max(min(r.hi + reach, root.lo + side) - max(r.lo - reach, root.lo), Vec3{});
    const double count = kTetsPerCube * extent.x / h * extent.y / h * extent.z / h;
    if (count > static_cast<double>(kMostElements)) {
      throw OptionError(
          fmt::format("size {:.4g} in the region at ({:.6g}, {:.6g}, {:.6g}) would give about {:.3g} elements, "
                      "more than the {} that a mesh can hold: ask for a larger size",
                      h, r.lo.x, r.lo.y, r.lo.z, count, kMostElements));
    }
  }
  return caps;
}

}  // namespace

std::shared_ptr<OctreeField> with_regions(std::shared_ptr<OctreeField> grid, const SizeOptions& options,
                                          const RunContext& context) {
  if (options.regions.empty()) return grid;
  return capped_grid(*grid, caps_of_regions(options, grid->root), grid->gradation, context);
}

}  // namespace octafront
