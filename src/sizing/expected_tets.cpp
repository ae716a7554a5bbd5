#include "sizing/background_grid.h"
#include "sizing/inside_fraction.h"
#include "sizing/make_size_field.h"
#include "sizing/size_sources.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

/// The inside is filled by a lattice whose cells have powers of two of one edge length: that which most of the surface
/// wants. A cell is divided while its edges are more than kLatticeTooLong times the wanted ones.
constexpr double kLatticeTooLong = 1.5;

/// Where the lattice steps from one cell size to the next it has more elements; how often it does grows with the slope.
/// Measured over 80 models at automatic size: with 1.8 all predictions lie within 12 %, with 0 a tenth of them beyond
/// 15 %.
constexpr double kTetsPerSlope = 1.8;

double lattice_size(double h, double common) {
  const double exponent = std::floor(std::log2(kLatticeTooLong * h / common));
  return common * std::exp2(exponent);
}

/// The size that half of the triangles to come will exceed: the median over the surface, each part of it weighted by
/// the number of its triangles. In units of the root's side, as the pieces are.
double common_size(const OctreeField& field, const std::vector<SurfacePiece>& pieces) {
  std::vector<std::pair<double, double>> sizes;
  sizes.reserve(pieces.size());
  double all = 0;
  for (const SurfacePiece& piece : pieces) {
    const double h = field.at(piece.p) / field.root.side, count = length(piece.n) / (h * h);
    sizes.push_back({h, count});
    all += count;
  }
  std::sort(sizes.begin(), sizes.end());
  double below = 0;
  for (const auto& [h, count] : sizes) {
    below += count;
    if (below >= 0.5 * all) return h;
  }
  return field.high;
}

/// Mean of 1 / h^3 over a leaf by the two-point Gauss rule along each axis; `size_at` turns the wanted size into the
/// made.
template <class SizeAt>
double mean_inverse_cube(const std::array<double, 8>& h, SizeAt&& size_at) {
  constexpr double kAt[2] = {0.21132486540518713, 0.78867513459481287};
  const auto [low, high] = std::minmax_element(h.begin(), h.end());
  const auto inverse_cube = [&](double wanted) {
    const double made = size_at(wanted);
    return 1 / (made * made * made);
  };
  if (*low == *high) return inverse_cube(*low);
  double sum = 0;
  for (int i = 0; i < 8; ++i) sum += inverse_cube(trilinear(h, kAt[i & 1], kAt[i >> 1 & 1], kAt[i >> 2]));
  return sum / 8;
}

/// How fast the size changes in a leaf of the given side: the gradient at its centre.
double slope_in(const std::array<double, 8>& h, double side) {
  double sum = 0;
  for (int axis = 1; axis < 8; axis *= 2) {
    double rise = 0;
    for (int k = 0; k < 8; ++k) rise += (k & axis) ? h[k] : -h[k];
    sum += rise * rise / 16;
  }
  return std::sqrt(sum) / side;
}

double integral_over_grid(const OctreeField& field, const SurfaceMesh& surface) {
  const std::vector<SurfacePiece> pieces = surface_pieces(field.root, field.tree, surface);
  const std::vector<double> fraction = inside_fractions(field.root, field.tree, pieces);
  const double common = common_size(field, pieces);
  double sum = 0;
  for (std::size_t l = 0; l < field.tree.size(); ++l) {
    if (fraction[l] == 0) continue;
    const double side = 1.0 / (1u << field.tree.leaf(l).level());
    const bool lattice = fraction[l] == 1;
    const double steps = 1 + kTetsPerSlope * slope_in(field.h[l], side);
    const double per_volume =
        lattice ? steps * mean_inverse_cube(field.h[l], [&](double h) { return lattice_size(h, common); })
                : mean_inverse_cube(field.h[l], [](double h) { return h; });
    sum += fraction[l] * side * side * side * per_volume;
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
