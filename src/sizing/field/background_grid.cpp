#include "sizing/field/background_grid.h"

#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/core/shared_value.h"
#include "sizing/field/gradation.h"
#include "sizing/field/inside_fraction.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace octafront {

namespace {

/// Room between the model and the faces of the root cube, in parts of its side.
constexpr double kRootMargin = 0.02;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Sizes in a leaf that differ by less count as equal.
constexpr double kPlainRatio = 1.02;

/// A sample in units of the root cube's side.
struct Sample {
  OctreeKey cell;
  Vec3 p, n;
  double h, reach, area;
};

std::vector<Sample> sorted_samples(const RootCube& root, const std::vector<SizeSample>& samples) {
  std::vector<std::pair<OctreeKey, std::uint32_t>> order(samples.size());
  parallel_for(samples.size(), [&](std::size_t i) {
    order[i] = {root.cell(samples[i].p), static_cast<std::uint32_t>(i)};
  });
  parallel_sort(order);
  std::vector<Sample> sorted(samples.size());
  parallel_for(order.size(), [&](std::size_t k) {
    const SizeSample& s = samples[order[k].second];
    sorted[k] = {order[k].first,  (s.p - root.lo) / root.side, s.n,
                 s.h / root.side, s.reach / root.side,         s.area / (root.side * root.side)};
  });
  return sorted;
}

double side_of(OctreeKey cell) {
  return 1.0 / (1u << cell.level());
}

class GridMaker {
 public:
  GridMaker(const RootCube& root, const std::vector<SizeSample>& samples, const GridRules& rules,
            const RunContext& context)
      : root_(root),
        samples_(sorted_samples(root, samples)),
        rules_(rules),
        context_(context),
        ceiling_(std::min(rules.ceiling, root.side) / root.side) {}

  std::shared_ptr<OctreeField> run() {
    divide_by_samples(OctreeKey::root(), samples_);
    make_field();
    if (rules_.interior_below_surface && !samples_.empty()) {
      ceiling_ = std::min(ceiling_, largest_at_samples());
    }
    if (!rules_.only_surface && divide_by_field()) {
      make_field();
    } else {
      fill_field();
    }
    field_->find_range();
    return field_;
  }

 private:
  /// `inside`: the samples in the cell.
  void divide_by_samples(OctreeKey cell, std::span<const Sample> inside) {
    if (inside.empty() || cell.level() == OctreeKey::kMaxLevel) return;
    double low = kInfinity, high = 0;
    for (const Sample& s : inside) {
      low = std::min(low, s.h);
      high = std::max(high, s.h);
    }
    if (side_of(cell) <= rules_.leaf_per_size * low) return;
    if (!rules_.resolve_surface && high <= kPlainRatio * low && cell.level() >= rules_.plain_level) return;
    cells_.divide(cell);
    for (int i = 0; i < 8; ++i) {
      const OctreeKey child = cell.child(i);
      const auto end = std::partition_point(inside.begin(), inside.end(),
                                            [&](const Sample& s) { return s.cell.id() <= child.range_max(); });
      divide_by_samples(child, {inside.begin(), end});
      inside = {end, inside.end()};
    }
  }

  /// What the samples in a leaf allow at its corners. A sample speaks for its tangent plane: its size holds along the
  /// normal within the leaf, so that a surface of one size has that size, and rises at the gradation along the plane.
  std::vector<double> corner_caps() const {
    std::vector<double> caps(corners_.size(), kInfinity);
    for_each_cap([&](std::uint32_t corner, double cap, const Sample&) { SharedValue(caps[corner]).lower_to(cap); });
    return caps;
  }

  /// The sizes of the samples that these caps come from.
  std::vector<double> sizes_behind(const std::vector<double>& caps) const {
    std::vector<double> sizes(corners_.size(), kInfinity);
    for_each_cap([&](std::uint32_t corner, double cap, const Sample& s) {
      if (cap == caps[corner]) SharedValue(sizes[corner]).lower_to(s.h);
    });
    return sizes;
  }

  /// Calls visit(corner, cap, sample) for each free corner that a leaf's values depend on and each sample in it.
  template <class Visit>
  void for_each_cap(const Visit& visit) const {
    const auto lay_on = [&](std::uint32_t corner, const Sample& s) {
      const auto& u = corners_.position[corner];
      const Vec3 d = Vec3{double(u[0]), double(u[1]), double(u[2])} / OctreeKey::kSide - s.p;
      const double along = dot(d, s.n);
      const double offset = std::sqrt(std::max(0.0, squared_length(d) - along * along));
      visit(corner, s.h + rules_.gradation * std::max(0.0, offset - s.reach), s);
    };
    parallel_for(tree_.size(), [&](std::size_t l) {
      for (const Sample& s : samples_in(l))
        for (const std::uint32_t corner : corners_.of_leaf[l]) {
          if (!corners_.hangs(corner)) lay_on(corner, s);
          for (const auto& share : corners_.shares_of(corner)) lay_on(share.corner, s);
        }
    });
  }

  std::span<const Sample> samples_in(std::size_t leaf) const {
    return std::span(samples_).subspan(first_sample_[leaf], first_sample_[leaf + 1] - first_sample_[leaf]);
  }

  /// Samples and leaves are in the same order.
  void find_samples_of_leaves() {
    first_sample_.assign(tree_.size() + 1, 0);
    std::size_t next = 0;
    for (std::size_t l = 0; l < tree_.size(); ++l) {
      for (; next < samples_.size() && samples_[next].cell.id() <= tree_.leaf(l).range_max();) ++next;
      first_sample_[l + 1] = next;
    }
  }

  void make_field() {
    cells_.close();
    tree_ = cells_.tree();
    find_samples_of_leaves();
    corners_ = octree_corners(tree_);
    context_.check();
    std::vector<double> caps = corner_caps();
    std::vector<double> sources = rules_.keep_sources ? sizes_behind(caps) : caps;
    graded_ =
        graded_corners(tree_, corners_, {std::move(caps), std::move(sources)}, rules_.gradation, ceiling_, context_);
    fill_field();
  }

  /// Values above the ceiling are cut off at the free corners; hanging ones follow.
  void fill_field() {
    std::vector<double>&value = graded_.value, &source = graded_.source;
    parallel_for(corners_.size(), [&](std::size_t c) {
      if (value[c] > ceiling_) value[c] = source[c] = ceiling_;
    });
    parallel_for(corners_.size(), [&](std::size_t i) {
      const auto c = static_cast<std::uint32_t>(i);
      if (!corners_.hangs(c)) return;
      value[c] = source[c] = 0;
      for (const OctreeCorners::Share& s : corners_.shares_of(c)) {
        value[c] += s.weight * value[s.corner];
        source[c] += s.weight * source[s.corner];
      }
    });
    field_ = std::make_shared<OctreeField>();
    field_->root = root_;
    field_->gradation = rules_.gradation;
    field_->h = corners_.at_leaves(value);
    if (rules_.keep_sources) field_->source = corners_.at_leaves(source);
    field_->tree = tree_;
  }

  /// The largest size that is wanted on the surface and that gradation allows there.
  double largest_at_samples() const {
    std::vector<double> largest(tree_.size(), 0);
    parallel_for(tree_.size(), [&](std::size_t l) {
      const double scale = 1u << tree_.leaf(l).level();
      const auto corner = tree_.leaf(l).corner();
      const auto local = [&](double x, int axis) {
        return std::clamp((x - double(corner[axis]) / OctreeKey::kSide) * scale, 0.0, 1.0);
      };
      for (const Sample& s : samples_in(l)) {
        const double h = trilinear(field_->h[l], local(s.p.x, 0), local(s.p.y, 1), local(s.p.z, 2));
        largest[l] = std::max(largest[l], std::min(h, s.h));
      }
    });
    return *std::ranges::max_element(largest);
  }

  /// Leaves that are too large for the graded sizes in them are divided. True if there are any.
  bool divide_by_field() {
    const std::vector<double> inside = inside_fractions_of_samples();
    bool any = false;
    for (std::size_t l = 0; l < tree_.size(); ++l) {
      const bool has_samples = !samples_in(l).empty();
      if (inside[l] == 0 && !has_samples) continue;
      const double factor = rules_.leaf_per_size * (has_samples ? 1 : 2);
      any = divide_leaf(tree_.leaf(l), field_->h[l], factor) || any;
    }
    return any;
  }

  std::vector<double> inside_fractions_of_samples() const {
    std::vector<SurfacePiece> pieces;
    for (std::uint32_t l = 0; l < tree_.size(); ++l)
      for (const Sample& s : samples_in(l))
        if (s.area > 0) pieces.push_back({s.p, s.n * s.area, l});
    if (pieces.empty()) return std::vector<double>(tree_.size(), 1.0);
    return inside_fractions(RootCube{}, tree_, pieces);
  }

  bool divide_leaf(OctreeKey cell, const std::array<double, 8>& h, double factor) {
    double low = kInfinity, high = 0;
    for (const double v : h) {
      low = std::min({low, v, ceiling_});
      high = std::max(high, std::min(v, ceiling_));
    }
    if (side_of(cell) <= factor * low || high <= kPlainRatio * low || cell.level() == OctreeKey::kMaxLevel)
      return false;
    cells_.divide(cell);
    for (int i = 0; i < 8; ++i) {
      std::array<double, 8> part;
      for (int k = 0; k < 8; ++k) {
        const auto at = [&](int axis) { return 0.5 * ((i >> axis & 1) + (k >> axis & 1)); };
        part[k] = trilinear(h, at(0), at(1), at(2));
      }
      divide_leaf(cell.child(i), part, factor);
    }
    return true;
  }

  const RootCube& root_;
  std::vector<Sample> samples_;
  const GridRules& rules_;
  const RunContext& context_;
  double ceiling_;
  DividedCells cells_;
  Octree tree_;
  std::vector<std::size_t> first_sample_;  ///< per leaf, and one more
  OctreeCorners corners_;
  GradedCorners graded_;
  std::shared_ptr<OctreeField> field_;
};

}  // namespace

RootCube root_around(const SurfaceMesh& surface) {
  return RootCube::around(bounding_box(surface.points), kRootMargin);
}

std::shared_ptr<OctreeField> make_background_grid(const RootCube& root, const std::vector<SizeSample>& samples,
                                                  const GridRules& rules, const RunContext& context) {
  return GridMaker(root, samples, rules, context).run();
}

}  // namespace octafront
