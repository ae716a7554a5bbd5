#include "sizing/background_grid.h"
#include "sizing/inside_fraction.h"
#include "sizing/make_size_field.h"
#include "sizing/size_sources.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// Mean of 1 / h^3 over a leaf by the two-point Gauss rule along each axis.
double mean_inverse_cube(const std::array<double, 8>& h) {
  constexpr double kAt[2] = {0.21132486540518713, 0.78867513459481287};
  const auto [low, high] = std::minmax_element(h.begin(), h.end());
  if (*low == *high) return 1 / (*low * *low * *low);
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const double v = trilinear(h, kAt[i & 1], kAt[i >> 1 & 1], kAt[i >> 2]);
    sum += 1 / (v * v * v);
  }
  return sum / 8;
}

double integral_over_grid(const OctreeField& field, const SurfaceMesh& surface) {
  const std::vector<SurfacePiece> pieces = surface_pieces(field.root, field.tree, surface);
  const std::vector<double> fraction = inside_fractions(field.root, field.tree, pieces);
  double sum = 0;
  for (std::size_t l = 0; l < field.tree.size(); ++l) {
    if (fraction[l] == 0) continue;
    const double side = 1.0 / (1u << field.tree.leaf(l).level());
    sum += fraction[l] * side * side * side * mean_inverse_cube(field.h[l]);
  }
  return sum;
}

/// A field that is no background grid, sampled onto one.
std::shared_ptr<const OctreeField> sampled_grid(const SizeField& sizes, const SurfaceMesh& surface) {
  constexpr int kLevel = 5;  // 32^3 leaves
  auto field = std::make_shared<OctreeField>();
  field->root = RootCube::around(bounding_box(surface.points), 0.02);
  std::vector<OctreeKey> leaves;
  for (OctreeKey k = OctreeKey::containing(0, 0, 0, kLevel); leaves.size() < 1u << (3 * kLevel);
       k = OctreeKey::from_id(k.range_max() + (k.id() - k.range_min()) + 2)) {
    leaves.push_back(k);
  }
  field->tree = Octree(std::move(leaves));
  field->h.resize(field->tree.size());
  const double side = field->root.side / (1 << kLevel);
  for (std::size_t l = 0; l < field->tree.size(); ++l) {
    const Vec3 lo = field->root.corner_of(field->tree.leaf(l));
    for (int k = 0; k < 8; ++k) {
      field->h[l][k] = sizes.at(lo + side * Vec3{double(k & 1), double(k >> 1 & 1), double(k >> 2)}) / field->root.side;
    }
  }
  return field;
}

}  // namespace

double expected_tets(const SizeField& sizes, const SurfaceMesh& surface) {
  if (sizes.min_size() == sizes.max_size()) {
    const double h = sizes.min_size();
    return kTetsPerCube * std::abs(enclosed_volume(surface)) / (h * h * h);
  }
  if (const OctreeField* grid = as_octree_field(sizes)) return kTetsPerCube * integral_over_grid(*grid, surface);
  return kTetsPerCube * integral_over_grid(*sampled_grid(sizes, surface), surface);
}

}  // namespace octafront
