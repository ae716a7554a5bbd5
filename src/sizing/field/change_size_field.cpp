#include "sizing/field/change_size_field.h"

#include "sizing/field/gradation.h"
#include "sizing/field/octree_corners.h"

#include <algorithm>
#include <utility>

namespace octafront {

namespace {

/// A cap holds unchanged within this many of the old sizes around its point, and rises at the gradation from there.
constexpr double kCapReach = CapShape{}.reach;

/// A field that is no background grid, with caps on top. The caps are few there.
SizeField capped_function(const SizeField& sizes, std::vector<SizeCap> caps, double gradation) {
  double low = sizes.min_size();
  for (const SizeCap& c : caps) low = std::min(low, c.h);
  const auto at = [sizes, caps = std::move(caps), gradation](Vec3 p) {
    double h = sizes.at(p);
    for (const SizeCap& c : caps) h = std::min(h, c.at(p, gradation));
    return h;
  };
  return SizeFunction::field(at, low, sizes.max_size(), gradation);
}

/// `gradation`: at least so much, and the field's own where that is more.
SizeField capped(const SizeField& sizes, std::vector<SizeCap> caps, const RunContext& context, double gradation = 0) {
  context.check();
  const double rise = std::max(gradation, SizeFunction::behind(sizes).gradation);
  if (const OctreeField* grid = as_octree_field(sizes))
    return SizeFunction::field(capped_grid(*grid, caps, rise, context));
  return capped_function(sizes, std::move(caps), rise);
}

std::vector<SizeCap> caps_at(const std::vector<PointSize>& places, double reach) {
  std::vector<SizeCap> caps;
  caps.reserve(places.size());
  for (const PointSize& s : places) caps.push_back({s.p, s.p, s.size, reach * s.size});
  return caps;
}

}  // namespace

SizeField capped_near(const SizeField& sizes, const std::vector<Vec3>& points, double factor,
                      const RunContext& context) {
  if (points.empty()) return sizes;
  std::vector<SizeCap> caps;
  for (const Vec3 p : points) {
    const double h = sizes.at(p);
    caps.push_back({p, p, factor * h, kCapReach * h});
  }
  return capped(sizes, std::move(caps), context);
}

SizeField capped_at(const SizeField& sizes, const std::vector<PointSize>& places, const RunContext& context,
                    const CapShape& shape) {
  return places.empty() ? sizes : capped(sizes, caps_at(places, shape.reach), context, shape.gradation);
}

SizeField scaled(const SizeField& sizes, double factor, const RunContext& context) {
  context.check();
  const OctreeField* grid = as_octree_field(sizes);
  if (grid == nullptr)
    return SizeFunction::field([sizes, factor](Vec3 p) { return sizes.at(p) * factor; }, sizes.min_size() * factor,
                               sizes.max_size() * factor, SizeFunction::behind(sizes).gradation);
  auto copy =
      std::make_shared<OctreeField>(with_sizes(*grid, [&](std::size_t l, int k) { return grid->h[l][k] * factor; }));
  copy->source = parallel_copy(grid->source);
  if (factor > 1) grade_again(*copy, context);
  return SizeFunction::field(std::move(copy));
}

void grade_again(OctreeField& field, const RunContext& context) {
  const OctreeCorners corners = octree_corners(field.tree);
  RawVector<double> caps(corners.size());
  parallel_for(corners.size(), [&](std::size_t c) {
    const std::uint32_t last = corners.leaves[c].back();
    caps[c] = field.h[last / 8][last % 8];
  });
  field.find_range();
  GradedCorners both{parallel_copy(caps), std::move(caps)};
  field.h = corners.at_leaves(
      graded_corners(field.tree, corners, std::move(both), field.gradation, field.high, context).value);
  field.find_range();
}

}  // namespace octafront
