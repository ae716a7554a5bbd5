// New size fields from old ones: scaled, and capped near points.

#include "base/core/parallel.h"
#include "sizing/gradation.h"
#include "sizing/grid_caps.h"
#include "sizing/make_size_field.h"
#include "sizing/octree_corners.h"
#include "sizing/octree_field.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// A cap holds unchanged within this many of the old sizes around its point, and rises at the gradation from there.
constexpr double kCapReach = CapShape{}.reach;

struct Scaled final : SizeFunction {
  Scaled(SizeField old, double factor) : sizes(std::move(old)), by(factor) {
    gradation = SizeFunction::behind(sizes).gradation;
  }
  double at(Vec3 p) const override { return sizes.at(p) * by; }
  double min_size() const override { return sizes.min_size() * by; }
  double max_size() const override { return sizes.max_size() * by; }
  SizeField sizes;
  double by;
};

/// A field that is no background grid, with caps on top. The caps are few there.
struct Capped final : SizeFunction {
  Capped(SizeField old, std::vector<SizeCap> by, double rise)
      : sizes(std::move(old)), caps(std::move(by)), low(sizes.min_size()) {
    gradation = rise;
    for (const SizeCap& c : caps) low = std::min(low, c.h);
  }
  double at(Vec3 p) const override {
    double h = sizes.at(p);
    for (const SizeCap& c : caps) h = std::min(h, c.at(p, gradation));
    return h;
  }
  double min_size() const override { return low; }
  double max_size() const override { return sizes.max_size(); }
  SizeField sizes;
  std::vector<SizeCap> caps;
  double low;
};

/// `gradation`: at least so much, and the field's own where that is more.
SizeField capped(const SizeField& sizes, std::vector<SizeCap> caps, const RunContext& context, double gradation = 0) {
  context.check();
  const double rise = std::max(gradation, SizeFunction::behind(sizes).gradation);
  if (const OctreeField* grid = as_octree_field(sizes))
    return SizeFunction::field(capped_grid(*grid, caps, rise, context));
  return SizeFunction::field(std::make_shared<Capped>(sizes, std::move(caps), rise));
}

std::vector<SizeCap> caps_at(const std::vector<PointSize>& places, double reach) {
  std::vector<SizeCap> caps;
  caps.reserve(places.size());
  for (const PointSize& s : places) caps.push_back({s.p, s.p, s.size, reach * s.size});
  return caps;
}

/// How often the floor of sizes is corrected: to a hundredth of the way between the least and greatest size.
constexpr int kFloorSteps = 8;

/// The sizes of `first` at the corners of the leaves of `grid`, in its units.
std::vector<std::array<double, 8>> at_corners(const OctreeField& grid, const SizeField& first) {
  std::vector<std::array<double, 8>> h(grid.tree.size());
  parallel_for(h.size(), [&](std::size_t l) {
    const OctreeKey leaf = grid.tree.leaf(l);
    const Vec3 lo = grid.root.corner_of(leaf);
    const double side = grid.root.side / (1u << leaf.level());
    for (int k = 0; k < 8; ++k)
      h[l][k] = first.at(lo + side * Vec3{double(k & 1), double(k >> 1 & 1), double(k >> 2)}) / grid.root.side;
  });
  return h;
}

/// The sizes of `grid` raised to a floor, but not above `most`.
OctreeField raised_grid(const OctreeField& grid, const std::vector<std::array<double, 8>>& most, double floor) {
  OctreeField result = grid;
  for (std::size_t l = 0; l < result.h.size(); ++l)
    for (int k = 0; k < 8; ++k) result.h[l][k] = std::max(result.h[l][k], std::min(most[l][k], floor));
  result.find_range();
  return result;
}

/// Cuts sizes that rise faster than the field's gradation.
void grade_again(OctreeField& field, const RunContext& context) {
  const OctreeCorners corners = octree_corners(field.tree);
  std::vector<double> caps(corners.size(), HUGE_VAL);
  double highest = 0;
  for (std::size_t l = 0; l < field.tree.size(); ++l) {
    for (int k = 0; k < 8; ++k) {
      caps[corners.of_leaf[l][k]] = field.h[l][k];
      highest = std::max(highest, field.h[l][k]);
    }
  }
  const std::vector<double> value = graded_corner_values(field.tree, corners, caps, field.gradation, highest, context);
  for (std::size_t l = 0; l < field.tree.size(); ++l) {
    for (int k = 0; k < 8; ++k) field.h[l][k] = value[corners.of_leaf[l][k]];
  }
}

}  // namespace

SizeField capped_near(const SizeField& sizes, const std::vector<Vec3>& points, double factor,
                      const RunContext& context) {
  if (points.empty()) return sizes;
  std::vector<SizeCap> caps;
  caps.reserve(points.size());
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

WithinCount within_count(const SizeField& finer, const SizeField& first, const TetPrediction& expected, double most,
                         const RunContext& context) {
  context.check();
  const OctreeField* grid = as_octree_field(finer);
  if (grid == nullptr) return {finer, expected(finer), 0};
  const auto expected_here = expected.on_leaves_of(*grid);
  const double asked = expected_here(*grid);
  if (asked <= most) return {finer, asked, 0};
  const auto most_sizes = at_corners(*grid, first);
  double low = std::log(grid->low), high = std::log(first.max_size() / grid->root.side);
  for (int step = 0; step < kFloorSteps; ++step) {
    const double floor = 0.5 * (low + high);
    (expected_here(raised_grid(*grid, most_sizes, std::exp(floor))) > most ? low : high) = floor;
  }
  auto coarser = std::make_shared<OctreeField>(raised_grid(*grid, most_sizes, std::exp(high)));
  grade_again(*coarser, context);
  coarser->find_range();
  return {SizeField(SizeFunction::field(std::move(coarser))), asked, std::exp(high) * grid->root.side};
}

SizeField scaled(const SizeField& sizes, double factor, const RunContext& context) {
  context.check();
  const OctreeField* grid = as_octree_field(sizes);
  if (grid == nullptr) return SizeFunction::field(std::make_shared<Scaled>(sizes, factor));
  auto copy = std::make_shared<OctreeField>(*grid);
  for (auto& leaf : copy->h) {
    for (double& v : leaf) v *= factor;
  }
  if (factor > 1) grade_again(*copy, context);
  copy->find_range();
  return SizeFunction::field(std::move(copy));
}

}  // namespace octafront
