
#include "sizing/field/gradation.h"

#include <limits>
#include <numeric>

namespace octafront {

namespace {

/// As GridRules::leaf_per_size.
constexpr double kLeafPerSize = 2;

/// A background grid divided further around the caps, and graded again.
class GridCapper {
 public:
  GridCapper(const OctreeField& old, const std::vector<SizeCap>& caps, double gradation, const RunContext& context)
      : old_(old), caps_(caps), gradation_(gradation), context_(context), cells_(divided_cells(old.tree)) {}

  std::shared_ptr<OctreeField> run() {
    descend(OctreeKey::root(), all_caps());
    cells_.close();
    const Octree tree = cells_.tree();
    corners_ = octree_corners(tree);
    return graded_field(old_.root, tree, corners_, corner_limits(tree), gradation_, old_.high, context_);
  }

 private:
  /// The least and the most that a cap allows in a cell.
  struct Span {
    double least, most;
  };
  Span span_in(OctreeKey cell, const SizeCap& cap) const {
    const Vec3 lo = old_.root.corner_of(cell);
    const double side = old_.root.side_of(cell);
    const Vec3 hi = lo + Vec3{side, side, side};
    Vec3 far;
    for (int a = 0; a < 3; ++a) far[a] = cap.lo[a] - lo[a] > hi[a] - cap.hi[a] ? lo[a] : hi[a];
    // Along each axis the nearest point of the cell to the box; the gap between the two boxes is theirs.
    return {cap.at(max(lo, min(max(cap.lo, min(lo, cap.hi)), hi)), gradation_), cap.at(far, gradation_)};
  }

  /// What may matter in a cell of the caps `near`.
  struct Mattering {
    std::vector<std::uint32_t> caps;
    double least = std::numeric_limits<double>::infinity();
  };

  /// Those below the old sizes, but for what another one stays below all over the cell: of the many caps that grow into
  /// a cell from afar few are left.
  Mattering mattering(OctreeKey cell, const std::vector<std::uint32_t>& near) const {
    double most = old_size_in(cell);
    Mattering here;
    std::vector<double> least;
    for (const std::uint32_t i : near) {
      const Span span = span_in(cell, caps_[i]);
      if (span.least >= most) continue;
      most = std::min(most, span.most);
      here.caps.push_back(i);
      least.push_back(span.least);
      here.least = std::min(here.least, span.least);
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < least.size(); ++k)
      if (least[k] <= most) here.caps[kept++] = here.caps[k];
    here.caps.resize(kept);
    return here;
  }

  double old_size_in(OctreeKey cell) const {
    const std::size_t l = old_.tree.find(cell);
    if (!old_.tree.leaf(l).contains(cell)) return old_.high * old_.root.side;
    return *std::max_element(old_.h[l].begin(), old_.h[l].end()) * old_.root.side;
  }

  std::vector<std::uint32_t> all_caps() const {
    std::vector<std::uint32_t> all(caps_.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  /// Divides cells that are too large for the caps in them; `near`: the caps that may matter in the cell.
  void descend(OctreeKey cell, const std::vector<std::uint32_t>& near) {
    context_.check();
    const Mattering here = mattering(cell, near);
    if (here.caps.empty() || old_.root.side_of(cell) <= kLeafPerSize * here.least ||
        cell.level() == OctreeKey::kMaxLevel)
      return;
    cells_.divide(cell);
    for (int i = 0; i < 8; ++i) descend(cell.child(i), here.caps);
  }

  /// The old size at each corner, lowered by the caps near it.
  RawVector<double> corner_limits(const Octree& tree) const {
    RawVector<double> limit(corners_.size());
    parallel_for(corners_.size(),
                 [&](std::size_t c) { limit[c] = old_.at(old_.root.position(corners_.position[c])) / old_.root.side; });
    std::size_t next = 0;
    lower(tree, OctreeKey::root(), all_caps(), next, limit);
    return limit;
  }

  void lower(const Octree& tree, OctreeKey cell, const std::vector<std::uint32_t>& near, std::size_t& next,
             RawVector<double>& limit) const {
    const std::vector<std::uint32_t> here = mattering(cell, near).caps;
    if (tree.leaf(next) != cell) {
      for (int i = 0; i < 8; ++i) lower(tree, cell.child(i), here, next, limit);
      return;
    }
    for (const std::uint32_t corner : corners_.of_leaf[next]) {
      const auto lay_on = [&](std::uint32_t free) {
        const Vec3 p = old_.root.position(corners_.position[free]);
        for (const std::uint32_t i : here) {
          limit[free] = std::min(limit[free], caps_[i].at(p, gradation_) / old_.root.side);
        }
      };
      if (!corners_.hangs(corner)) lay_on(corner);
      for (const auto& share : corners_.shares_of(corner)) lay_on(share.corner);
    }
    ++next;
  }

  const OctreeField& old_;
  const std::vector<SizeCap>& caps_;
  const double gradation_;
  const RunContext& context_;
  DividedCells cells_;
  OctreeCorners corners_;
};

}  // namespace

std::shared_ptr<OctreeField> capped_grid(const OctreeField& field, const std::vector<SizeCap>& caps, double gradation,
                                         const RunContext& context) {
  return GridCapper(field, caps, gradation, context).run();
}

}  // namespace octafront
