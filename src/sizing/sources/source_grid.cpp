#include "sizing/sources/source_grid.h"

#include "base/core/parallel.h"
#include "sizing/field/affordable.h"
#include "sizing/field/gradation.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Samples along the side of the root cube where one size holds everywhere: two to a leaf of GridRules::plain_level.
constexpr double kPlainSamples = 64;

/// Where one size holds everywhere the grid has a plain level of leaves, and samples need be no denser than these.
RawVector<SizeSample> even_samples(const SurfaceMesh& surface, double h, const RootCube& root,
                                   const RunContext& context) {
  const double spacing = std::max(h, root.side / kPlainSamples);
  auto samples = sample_surface(surface, std::vector<double>(surface.triangles.size(), spacing), {}, context);
  parallel_for(samples.size(), [&](std::size_t i) { samples[i].h = h; });
  return samples;
}

/// Regions as caps; what they come to inside the root cube must be a number of elements that a mesh can hold.
std::vector<SizeCap> caps_of_regions(const SizeOptions& options, const RootCube& root) {
  std::vector<SizeCap> caps;
  for (const SizeRegion& r : options.regions) {
    const double h = std::max(r.size, options.min_size.value_or(0));
    caps.push_back({r.lo, r.hi, h, r.radius + 0.5 * h});  // leaves reach across the edge of the region
    const Vec3 reach{r.radius, r.radius, r.radius}, side{root.side, root.side, root.side};
    const Vec3 extent = max(min(r.hi + reach, root.lo + side) - max(r.lo - reach, root.lo), Vec3{});
    const double count = kTetsPerCube * extent.x / h * extent.y / h * extent.z / h;
    require_affordable(fmt::format("size {:.4g} in the region at ({:.6g}, {:.6g}, {:.6g})", h, r.lo.x, r.lo.y, r.lo.z),
                       count);
  }
  return caps;
}

}  // namespace

GridRules grid_rules(const SizeOptions& options, double ceiling) {
  GridRules rules;
  rules.gradation = options.gradation.value_or(kDefaultGradation);
  rules.interior_below_surface = options.interior == SizeOptions::Interior::kUniform;
  rules.resolve_surface = !rules.interior_below_surface;
  rules.ceiling = ceiling;
  rules.keep_sources = options.elements.has_value();
  return rules;
}

std::shared_ptr<OctreeField> with_regions(std::shared_ptr<OctreeField> grid, const SizeOptions& options,
                                          const RunContext& context) {
  if (options.regions.empty()) return grid;
  return capped_grid(*grid, caps_of_regions(options, grid->root), grid->gradation, context);
}

SizeField source_grid(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                      const RunContext& context, const GridLook& look) {
  const RootCube root = root_around(surface);
  GridRules rules = grid_rules(options, wanted.ceiling);
  rules.leaf_per_size *= look.coarser;
  rules.keep_sources = rules.keep_sources || look.keeps_sources;
  RawVector<SizeSample> samples = wanted.even && !rules.resolve_surface
                                      ? even_samples(surface, wanted.face.front(), root, context)
                                      : sample_surface(surface, wanted.face, wanted.at_place, context);
  samples.insert(samples.end(), wanted.points.begin(), wanted.points.end());
  auto grid = make_background_grid(root, samples, rules, context);
  return SizeFunction::field(with_regions(std::move(grid), options, context));
}

}  // namespace octafront
