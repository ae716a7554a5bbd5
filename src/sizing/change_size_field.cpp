// New size fields from old ones: scaled, and capped near points.

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
constexpr double kCapReach = 1.5;

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

std::vector<SizeCap> caps_at(const std::vector<PointSize>& places) {
  std::vector<SizeCap> caps;
  caps.reserve(places.size());
  for (const PointSize& s : places) caps.push_back({s.p, s.p, s.size, kCapReach * s.size});
  return caps;
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

SizeField capped_at(const SizeField& sizes, const std::vector<PointSize>& places, const RunContext& context) {
  return places.empty() ? sizes : capped(sizes, caps_at(places), context);
}

SizeField capped_steeply(const SizeField& sizes, const std::vector<PointSize>& places, double gradation,
                         const RunContext& context) {
  return places.empty() ? sizes : capped(sizes, caps_at(places), context, gradation);
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
