// New size fields from old ones: scaled, and capped near points.

#include "sizing/grid_caps.h"
#include "sizing/make_size_field.h"
#include "sizing/octree_field.h"

#include <algorithm>

namespace octafront {

namespace {

/// A cap holds unchanged within this many of the old sizes around its point, and rises at the gradation from there.
constexpr double kCapReach = 1.5;

struct Scaled final : SizeField::Impl {
  Scaled(SizeField old, double factor) : sizes(std::move(old)), by(factor) {}
  double at(Vec3 p) const override { return sizes.at(p) * by; }
  double min_size() const override { return sizes.min_size() * by; }
  double max_size() const override { return sizes.max_size() * by; }
  SizeField sizes;
  double by;
};

/// A field that is no background grid, with caps on top. The caps are few there.
struct Capped final : SizeField::Impl {
  Capped(SizeField old, std::vector<SizeCap> by, double g) : sizes(std::move(old)), caps(std::move(by)), gradation(g) {
    low = sizes.min_size();
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
  double gradation, low;
};

SizeField capped(const SizeField& sizes, std::vector<SizeCap> caps, double gradation) {
  if (const OctreeField* grid = as_octree_field(sizes))
    return SizeField(capped_grid(*grid, caps, gradation, RunContext{}));
  return SizeField(std::make_shared<Capped>(sizes, std::move(caps), gradation));
}

}  // namespace

SizeField capped_near(const SizeField& sizes, const std::vector<Vec3>& points, double factor, double gradation) {
  if (points.empty()) return sizes;
  std::vector<SizeCap> caps;
  caps.reserve(points.size());
  for (const Vec3 p : points) {
    const double h = sizes.at(p);
    caps.push_back({p, p, factor * h, kCapReach * h});
  }
  return capped(sizes, std::move(caps), gradation);
}

SizeField capped_at(const SizeField& sizes, const std::vector<PointSize>& places, double gradation) {
  if (places.empty()) return sizes;
  std::vector<SizeCap> caps;
  caps.reserve(places.size());
  for (const PointSize& s : places) caps.push_back({s.p, s.p, s.size, kCapReach * s.size});
  return capped(sizes, std::move(caps), gradation);
}

SizeField scaled(const SizeField& sizes, double factor) {
  const OctreeField* grid = as_octree_field(sizes);
  if (grid == nullptr) return SizeField(std::make_shared<Scaled>(sizes, factor));
  auto copy = std::make_shared<OctreeField>(*grid);
  for (auto& leaf : copy->h) {
    for (double& v : leaf) v *= factor;
  }
  copy->gradation *= factor;
  copy->find_range();
  return SizeField(std::move(copy));
}

}  // namespace octafront
