#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

#include "sizing/field/octree.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

namespace octafront {

/// What stands behind a SizeField: one subclass per way to answer at(). Immutable once it is in a field. A function
/// counts the fields that refer to it and holds itself as long as there are any, so that the public header gets by
/// without <memory>.
class SizeFunction {
 public:
  SizeFunction() = default;
  /// A copy is in no field yet.
  SizeFunction(const SizeFunction& other) : gradation(other.gradation) {}
  virtual ~SizeFunction() = default;
  virtual double at(Vec3 p) const = 0;
  virtual double min_size() const = 0;
  virtual double max_size() const = 0;

  /// The rate at which sizes may change, and caps on the field grow. One that knows of none has the default.
  double gradation = kDefaultGradation;

  static SizeField field(std::shared_ptr<const SizeFunction> function) {
    const SizeFunction& f = *function;
    f.self_ = std::move(function);
    return SizeField(f);
  }
  /// As SizeField::from_function(), of this gradation.
  static SizeField field(std::function<double(Vec3)> h, double lo, double hi, double gradation);
  static const SizeFunction& behind(const SizeField& sizes) { return *sizes.function_; }

 private:
  friend class SizeField;
  mutable std::atomic<std::size_t> fields_ = 0;
  mutable std::shared_ptr<const SizeFunction> self_;
};

// sizing/field: a size for each place. An octree, 2:1 balanced, carries sizes at the corners of its leaves; they are
// continuous inside leaves and graded by a law that holds between any two points. How such a field is made of samples
// (background_grid.h), graded (gradation.h), scaled and capped (change_size_field.h), and packed for other processes.

/// The background grid as a size field: sizes at leaf corners, trilinear between them.
struct OctreeField final : SizeFunction {
  RootCube root;
  Octree tree;
  RawVector<std::array<double, 8>> h;  ///< per leaf, corner i with the halves of child i; in units of root.side
  /// Of each of these the part that a source of size asked for; the rest is what it grew by on the way. May be empty.
  RawVector<std::array<double, 8>> source;
  double low = 0, high = 0;  ///< least and greatest of h

  double at(Vec3 p) const override { return at(p, tree.find(root.cell(p))); }
  /// The same, of a point in leaf l.
  double at(Vec3 p, std::size_t l) const;
  double min_size() const override { return low * root.side; }
  double max_size() const override { return high * root.side; }
  /// Fills in low and high.
  void find_range();
};

/// Other sizes on the same leaves: of(l, k) at corner k of leaf l, in units of root.side. They have no sources.
template <class Of>
OctreeField with_sizes(const OctreeField& grid, const Of& of) {
  OctreeField result;
  result.root = grid.root;
  result.gradation = grid.gradation;
  result.tree = grid.tree;
  result.h.resize(grid.h.size());
  parallel_for(grid.h.size(), [&](std::size_t l) {
    for (int k = 0; k < 8; ++k) result.h[l][k] = of(l, k);
  });
  result.find_range();
  return result;
}

/// The field behind `sizes` if it is a background grid, else null.
const OctreeField* as_octree_field(const SizeField& sizes);

/// Sizes at the corners of leaves, in units of root.side, as OctreeField::h has them.
RawVector<std::array<double, 8>> sizes_at_leaves(const SizeField& sizes, const RootCube& root, const Octree& tree);

/// Interpolation of eight corner values at local coordinates in [0, 1].
inline double trilinear(const std::array<double, 8>& v, double x, double y, double z) {
  const double v00 = v[0] + x * (v[1] - v[0]), v10 = v[2] + x * (v[3] - v[2]);
  const double v01 = v[4] + x * (v[5] - v[4]), v11 = v[6] + x * (v[7] - v[6]);
  const double v0 = v00 + y * (v10 - v00), v1 = v01 + y * (v11 - v01);
  return v0 + z * (v1 - v0);
}

}  // namespace octafront
