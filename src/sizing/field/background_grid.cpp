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

RawVector<Sample> sorted_samples(const RootCube& root, std::span<const SizeSample> samples) {
  struct Place {
    OctreeKey cell;
    std::uint32_t sample;
    auto operator<=>(const Place&) const = default;
  };
  RawVector<Place> order(samples.size());
  parallel_for(samples.size(), [&](std::size_t i) {
    order[i] = {root.cell(samples[i].p), static_cast<std::uint32_t>(i)};
  });
  parallel_sort(order);
  RawVector<Sample> sorted(samples.size());
  parallel_for(order.size(), [&](std::size_t k) {
    const SizeSample& s = samples[order[k].sample];
    sorted[k] = {order[k].cell,   (s.p - root.lo) / root.side, s.n,
                 s.h / root.side, s.reach / root.side,         s.area / (root.side * root.side)};
  });
  return sorted;
}

double side_of(OctreeKey cell) {
  return 1.0 / (1u << cell.level());
}

class GridMaker {
 public:
  GridMaker(const RootCube& root, std::span<const SizeSample> samples, const GridRules& rules,
            const RunContext& context)
      : root_(root),
        samples_(sorted_samples(root, samples)),
        rules_(rules),
        context_(context),
        ceiling_(std::min(rules.ceiling, root.side) / root.side) {}

  std::shared_ptr<OctreeField> run() {
    divide_by_samples();
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
  /// The samples in a cell, and the least and greatest size at them.
  struct Inside {
    OctreeKey cell;
    std::span<const Sample> samples;
    double low = kInfinity, high = 0;

    Inside(OctreeKey in, std::span<const Sample> those) : cell(in), samples(those) {
      for (const Sample& s : samples) low = std::min(low, s.h), high = std::max(high, s.h);
    }
    /// What the cells inside it hold together.
    Inside(OctreeKey in, std::span<const Inside> parts) : cell(in) {
      for (const Inside& part : parts) low = std::min(low, part.low), high = std::max(high, part.high);
    }
  };

  bool is_divided(const Inside& inside) const {
    if (inside.high == 0 || inside.cell.level() == OctreeKey::kMaxLevel) return false;
    if (side_of(inside.cell) <= rules_.leaf_per_size * inside.low) return false;
    return rules_.resolve_surface || inside.high > kPlainRatio * inside.low || inside.cell.level() < rules_.plain_level;
  }

  /// What lies in one cell of kTopLevel is a thread's own. Where a cell is not divided none inside it would be.
  void divide_by_samples() {
    const std::vector<Inside> tops = samples_in_tops();
    divide_above(OctreeKey::root(), tops);
    const auto divided = parallel_collect<OctreeKey>(
        tops.size(), 1, [&](std::size_t begin, std::size_t end, std::vector<OctreeKey>& cells) {
          for (std::size_t i = begin; i < end; ++i) divide_below(tops[i], cells);
        });
    cells_.divide(divided);
  }

  static constexpr int kTopLevel = 4;

  std::vector<Inside> samples_in_tops() const {
    std::vector<std::span<const Sample>> parts;
    for (std::span<const Sample> rest = samples_; !rest.empty(); rest = rest.subspan(parts.back().size()))
      parts.push_back(samples_within(rest.front().cell.ancestor(kTopLevel), rest));
    std::vector<Inside> tops(parts.size(), Inside({}, std::span<const Sample>{}));
    parallel_for(
        parts.size(),
        [&](std::size_t i) {
          tops[i] = {parts[i].front().cell.ancestor(kTopLevel), parts[i]};
        },
        Split::kSingly);
    return tops;
  }

  /// Those that begin with the first in a cell, as far as they lie in it.
  static std::span<const Sample> samples_within(OctreeKey cell, std::span<const Sample> from) {
    const auto end = std::partition_point(from.begin(), from.end(),
                                          [&](const Sample& s) { return s.cell.id() <= cell.range_max(); });
    return {from.begin(), end};
  }

  void divide_above(OctreeKey cell, std::span<const Inside> tops) {
    if (cell.level() == kTopLevel || !is_divided(Inside(cell, tops))) return;
    cells_.divide(cell);
    for (int i = 0; i < 8; ++i) {
      const OctreeKey child = cell.child(i);
      const auto end = std::partition_point(tops.begin(), tops.end(),
                                            [&](const Inside& t) { return t.cell.id() <= child.range_max(); });
      divide_above(child, {tops.begin(), end});
      tops = {end, tops.end()};
    }
  }

  void divide_below(const Inside& inside, std::vector<OctreeKey>& divided) const {
    if (!is_divided(inside)) return;
    divided.push_back(inside.cell);
    std::span<const Sample> rest = inside.samples;
    for (int i = 0; i < 8; ++i) {
      const OctreeKey child = inside.cell.child(i);
      const std::span<const Sample> part = samples_within(child, rest);
      divide_below(Inside(child, part), divided);
      rest = rest.subspan(part.size());
    }
  }

  /// What the samples in a leaf allow at its corners. A sample speaks for its tangent plane: its size holds along the
  /// normal within the leaf, so that a surface of one size has that size, and rises at the gradation along the plane.
  RawVector<double> corner_caps() const {
    RawVector<double> caps = parallel_filled(corners_.size(), kInfinity);
    for_each_cap([&](std::uint32_t corner, double cap, double) { SharedValue(caps[corner]).lower_to(cap); });
    return caps;
  }

  /// The sizes of the samples that these caps come from.
  RawVector<double> sizes_behind(const RawVector<double>& caps) const {
    RawVector<double> sizes = parallel_filled(corners_.size(), kInfinity);
    for_each_cap([&](std::uint32_t corner, double cap, double h) {
      if (cap == caps[corner]) SharedValue(sizes[corner]).lower_to(h);
    });
    return sizes;
  }

  /// Calls visit(corner, cap, size) for each free corner that a leaf's values depend on, with the lowest cap by a
  /// sample in the leaf, and the least size of those that have it.
  template <class Visit>
  void for_each_cap(const Visit& visit) const {
    parallel_ranges(tree_.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> corners;
      for (std::size_t l = begin; l < end; ++l) {
        const std::span<const Sample> samples = samples_in(l);
        if (samples.empty()) continue;
        find_free_corners(l, corners);
        for (const std::uint32_t corner : corners) {
          const auto [cap, h] = lowest_cap(corner, samples);
          visit(corner, cap, h);
        }
      }
    });
  }

  void find_free_corners(std::size_t leaf, std::vector<std::uint32_t>& free) const {
    free.clear();
    const auto add = [&](std::uint32_t corner) {
      if (std::ranges::find(free, corner) == free.end()) free.push_back(corner);
    };
    for (const std::uint32_t corner : corners_.of_leaf[leaf]) {
      if (!corners_.hangs(corner)) add(corner);
      for (const auto& share : corners_.shares_of(corner)) add(share.corner);
    }
  }

  std::pair<double, double> lowest_cap(std::uint32_t corner, std::span<const Sample> samples) const {
    const auto& u = corners_.position[corner];
    const Vec3 at = Vec3{double(u[0]), double(u[1]), double(u[2])} / OctreeKey::kSide;
    std::pair<double, double> lowest{kInfinity, kInfinity};
    for (const Sample& s : samples) {
      const Vec3 d = at - s.p;
      const double along = dot(d, s.n);
      const double offset = std::sqrt(std::max(0.0, squared_length(d) - along * along));
      lowest = std::min(lowest, {s.h + rules_.gradation * std::max(0.0, offset - s.reach), s.h});
    }
    return lowest;
  }

  std::span<const Sample> samples_in(std::size_t leaf) const {
    return std::span(samples_).subspan(first_sample_[leaf], first_sample_[leaf + 1] - first_sample_[leaf]);
  }

  /// Samples and leaves are in the same order.
  void find_samples_of_leaves() {
    first_sample_.resize(tree_.size() + 1);
    parallel_ranges(tree_.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
      std::size_t next = begin == 0 ? 0 : samples_up_to(tree_.leaf(begin - 1));
      for (std::size_t l = begin; l < end; ++l) {
        first_sample_[l] = next;
        while (next < samples_.size() && samples_[next].cell.id() <= tree_.leaf(l).range_max()) ++next;
      }
    });
    first_sample_[tree_.size()] = samples_.size();
  }

  /// How many lie in a leaf and before it.
  std::size_t samples_up_to(OctreeKey leaf) const { return samples_within(leaf, samples_).size(); }

  void make_field() {
    cells_.close();
    tree_ = cells_.tree();
    find_samples_of_leaves();
    corners_ = octree_corners(tree_);
    context_.check();
    RawVector<double> caps = corner_caps();
    RawVector<double> sources = rules_.keep_sources ? sizes_behind(caps) : parallel_copy(caps);
    graded_ =
        graded_corners(tree_, corners_, {std::move(caps), std::move(sources)}, rules_.gradation, ceiling_, context_);
    fill_field();
  }

  /// Values above the ceiling are cut off at the free corners; hanging ones follow.
  void fill_field() {
    RawVector<double>&value = graded_.value, &source = graded_.source;
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
    return parallel_max(tree_.size(), 0.0, [&](std::size_t l) {
      const double scale = 1u << tree_.leaf(l).level();
      const auto corner = tree_.leaf(l).corner();
      const auto local = [&](double x, int axis) {
        return std::clamp((x - double(corner[axis]) / OctreeKey::kSide) * scale, 0.0, 1.0);
      };
      double largest = 0;
      for (const Sample& s : samples_in(l)) {
        const double h = trilinear(field_->h[l], local(s.p.x, 0), local(s.p.y, 1), local(s.p.z, 2));
        largest = std::max(largest, std::min(h, s.h));
      }
      return largest;
    });
  }

  /// Leaves that are too large for the graded sizes in them are divided. True if there are any.
  bool divide_by_field() {
    const RawVector<double> inside = inside_fractions_of_samples();
    const auto divided = parallel_collect<OctreeKey>(
        tree_.size(), kLeavesAtOnce, [&](std::size_t begin, std::size_t end, std::vector<OctreeKey>& cells) {
          for (std::size_t l = begin; l < end; ++l) {
            const bool has_samples = !samples_in(l).empty();
            if (inside[l] == 0 && !has_samples) continue;
            divide_leaf(tree_.leaf(l), field_->h[l], rules_.leaf_per_size * (has_samples ? 1 : 2), cells);
          }
        });
    cells_.divide(divided);
    return !divided.empty();
  }

  static constexpr std::size_t kLeavesAtOnce = 512;

  RawVector<double> inside_fractions_of_samples() const {
    const auto pieces = parallel_collect<SurfacePiece, RawVector<SurfacePiece>>(
        tree_.size(), kLeavesAtOnce, [&](std::size_t begin, std::size_t end, std::vector<SurfacePiece>& found) {
          for (std::size_t l = begin; l < end; ++l)
            for (const Sample& s : samples_in(l))
              if (s.area > 0) found.push_back({s.p, s.n * s.area, static_cast<std::uint32_t>(l)});
        });
    if (pieces.empty()) return parallel_filled(tree_.size(), 1.0);
    return inside_fractions(RootCube{}, tree_, pieces);
  }

  void divide_leaf(OctreeKey cell, const std::array<double, 8>& h, double factor,
                   std::vector<OctreeKey>& divided) const {
    double low = kInfinity, high = 0;
    for (const double v : h) {
      low = std::min({low, v, ceiling_});
      high = std::max(high, std::min(v, ceiling_));
    }
    if (side_of(cell) <= factor * low || high <= kPlainRatio * low || cell.level() == OctreeKey::kMaxLevel) return;
    divided.push_back(cell);
    for (int i = 0; i < 8; ++i) {
      std::array<double, 8> part;
      for (int k = 0; k < 8; ++k) {
        const auto at = [&](int axis) { return 0.5 * ((i >> axis & 1) + (k >> axis & 1)); };
        part[k] = trilinear(h, at(0), at(1), at(2));
      }
      divide_leaf(cell.child(i), part, factor, divided);
    }
  }

  const RootCube& root_;
  RawVector<Sample> samples_;
  const GridRules& rules_;
  const RunContext& context_;
  double ceiling_;
  DividedCells cells_;
  Octree tree_;
  RawVector<std::size_t> first_sample_;  ///< per leaf, and one more
  OctreeCorners corners_;
  GradedCorners graded_;
  std::shared_ptr<OctreeField> field_;
};

}  // namespace

RootCube root_around(const SurfaceMesh& surface) {
  return RootCube::around(bounding_box(surface.points), kRootMargin);
}

std::shared_ptr<OctreeField> make_background_grid(const RootCube& root, std::span<const SizeSample> samples,
                                                  const GridRules& rules, const RunContext& context) {
  return GridMaker(root, samples, rules, context).run();
}

}  // namespace octafront
