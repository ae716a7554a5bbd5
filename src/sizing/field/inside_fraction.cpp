#include "sizing/field/inside_fraction.h"

#include <octafront/surface_mesh.h>

#include "base/core/buckets.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace octafront {

namespace {

/// Integrals over the part of the surface in one cell, lengths in units of the root's side.
struct Moments {
  Vec3 n;   ///< of n dA
  Vec3 nx;  ///< of (n_x x, n_y y, n_z z) dA, coordinates from the cell's lower corner
  bool any = false;

  void add(Vec3 area, Vec3 at) {
    n += area;
    nx += Vec3{area.x * at.x, area.y * at.y, area.z * at.z};
    any = true;
  }
  void add(const Moments& child, Vec3 offset) {
    if (!child.any) return;
    n += child.n;
    nx += child.nx + Vec3{child.n.x * offset.x, child.n.y * offset.y, child.n.z * offset.z};
    any = true;
  }
};

/// A divided cell some levels below the root: what lies in it is done by a thread of its own.
struct Branch {
  OctreeKey cell;
  std::size_t first = 0, end = 0;  ///< leaves
  Moments sum;
  double average = 0;  ///< of the indicator function
};

/// Enough of them for all threads, and what lies above them is nothing.
constexpr int kBranchLevel = 4;

std::vector<Branch> branches_of(const Octree& tree) {
  std::vector<Branch> branches;
  const std::span<const OctreeKey> leaves = tree.leaves();
  for (auto leaf = leaves.begin(); leaf != leaves.end();) {
    if (leaf->level() <= kBranchLevel) {
      ++leaf;
      continue;
    }
    const OctreeKey cell = leaf->ancestor(kBranchLevel);
    const auto end = std::partition_point(leaf, leaves.end(), [&](OctreeKey k) { return k.id() <= cell.range_max(); });
    branches.push_back(
        {cell, static_cast<std::size_t>(leaf - leaves.begin()), static_cast<std::size_t>(end - leaves.begin()), {}, 0});
    leaf = end;
  }
  return branches;
}

/// The cells from one down to the leaves, or to branches.
///
/// With sigma_a = -1 in the lower and +1 in the upper half of a cell along axis a, the average of the indicator
/// function over child i is its average over the cell plus the sum, over the seven non-empty sets e of axes, of c_e
/// prod_{a in e} sigma_a(i); and c_e = 1/V * integral of it times prod sigma. The latter is the divergence of
/// (antiderivative of sigma_a) prod_{b in e, b != a} sigma_b along any axis a of e, which vanishes on the cell's faces:
/// what is left by Gauss is an integral over the surface in the cell, linear in the moments of the children.
class Haar {
 public:
  /// `first`: the first leaf in the cell. REQUIRES: the moments of the branches are known.
  Haar(const Octree& tree, const RawVector<Moments>& of_leaf, OctreeKey cell, std::size_t first,
       std::span<Branch> branches)
      : tree_(tree), of_leaf_(of_leaf), cell_(cell), first_(first), branches_(branches) {
    std::size_t next_leaf = first, next_branch = 0;
    sum_ = gather(cell, next_leaf, next_branch);
  }

  const Moments& sum() const { return sum_; }

  /// Sets the fractions of the leaves in the cell, and the averages of the branches that have any surface.
  void spread(double average, RawVector<double>& fraction) const {
    if (inner_.empty())
      fraction[first_] = std::clamp(average, 0.0, 1.0);
    else
      spread(cell_, average, 0, first_, fraction);
  }

 private:
  static constexpr std::int32_t kLeaf = -1;
  struct Inner {
    std::array<Moments, 8> child;
    std::array<std::uint32_t, 8> leaves_end;  ///< leaf behind the child
    std::array<std::int32_t, 8> inner;        ///< number of the child if it is divided, kLeaf, or kLeaf - 1 - branch
  };

  Moments gather(OctreeKey cell, std::size_t& next_leaf, std::size_t& next_branch) {
    if (tree_.leaf(next_leaf) == cell) return of_leaf_[next_leaf++];
    if (next_branch < branches_.size() && branches_[next_branch].cell == cell) {
      next_leaf = branches_[next_branch].end;
      return branches_[next_branch++].sum;
    }
    const std::size_t me = inner_.size();
    inner_.emplace_back();
    Moments sum;
    const double half = 0.5 / (1u << cell.level());
    for (int i = 0; i < 8; ++i) {
      const bool divided = tree_.leaf(next_leaf) != cell.child(i);
      const auto number = static_cast<std::int32_t>(inner_.size()), branch = static_cast<std::int32_t>(next_branch);
      const Moments m = gather(cell.child(i), next_leaf, next_branch);
      const bool is_branch =
          static_cast<std::size_t>(branch) < next_branch && inner_.size() == static_cast<std::size_t>(number);
      inner_[me].child[i] = m;
      inner_[me].inner[i] = is_branch ? kLeaf - 1 - branch : divided ? number : kLeaf;
      inner_[me].leaves_end[i] = static_cast<std::uint32_t>(next_leaf);
      sum.add(m, Vec3{half * (i & 1), half * (i >> 1 & 1), half * (i >> 2)});
    }
    return sum;
  }

  static double sigma(int child, int axis) { return (child >> axis & 1) ? 1 : -1; }

  /// Coefficient of the set of axes e (a bit mask) for a cell of side s.
  static double coefficient(const Inner& cell, int e, double s) {
    double sum = 0;
    int axes = 0;
    for (int a = 0; a < 3; ++a) {
      if (!(e >> a & 1)) continue;
      ++axes;
      for (int i = 0; i < 8; ++i) {
        if (!cell.child[i].any) continue;
        double sign = 1;
        for (int b = 0; b < 3; ++b) {
          if (b != a && (e >> b & 1)) sign *= sigma(i, b);
        }
        // The antiderivative is -u in the lower half and u' - s/2 in the upper one, u' from the middle.
        const double moment = cell.child[i].nx[a];
        sum += sign * ((i >> a & 1) ? moment - 0.5 * s * cell.child[i].n[a] : -moment);
      }
    }
    return sum / (axes * s * s * s);
  }

  void spread(OctreeKey cell, double average, std::size_t inner, std::size_t begin, RawVector<double>& fraction) const {
    const Inner& in = inner_[inner];
    std::array<double, 8> c{};
    for (int e = 1; e < 8; ++e) c[e] = coefficient(in, e, 1.0 / (1u << cell.level()));
    for (int i = 0; i < 8; ++i) {
      double v = average;
      for (int e = 1; e < 8; ++e) {
        double sign = 1;
        for (int a = 0; a < 3; ++a) sign *= (e >> a & 1) ? sigma(i, a) : 1;
        v += sign * c[e];
      }
      const std::size_t end = in.leaves_end[i];
      if (!in.child[i].any)
        std::fill(fraction.begin() + static_cast<std::ptrdiff_t>(begin),
                  fraction.begin() + static_cast<std::ptrdiff_t>(end), v > 0.5 ? 1.0 : 0.0);
      else if (in.inner[i] == kLeaf)
        fraction[begin] = std::clamp(v, 0.0, 1.0);
      else if (in.inner[i] < kLeaf)
        branches_[static_cast<std::size_t>(kLeaf - 1 - in.inner[i])].average = v;
      else
        spread(cell.child(i), v, static_cast<std::size_t>(in.inner[i]), begin, fraction);
      begin = end;
    }
  }

  const Octree& tree_;
  const RawVector<Moments>& of_leaf_;
  OctreeKey cell_;
  std::size_t first_;
  std::span<Branch> branches_;
  std::vector<Inner> inner_;
  Moments sum_;
};

/// In each leaf its pieces are added up in their order.
RawVector<Moments> moments_of_leaves(const RootCube& root, const Octree& tree, std::span<const SurfacePiece> pieces) {
  RawVector<Moments> of_leaf = parallel_filled(tree.size(), Moments{});
  const auto add = [&](const SurfacePiece& piece) {
    of_leaf[piece.leaf].add(piece.n / (root.side * root.side),
                            (piece.p - root.corner_of(tree.leaf(piece.leaf))) / root.side);
  };
  if (thread_count() == 1) {
    for (const SurfacePiece& piece : pieces) add(piece);
    return of_leaf;
  }
  const RangeBuckets ranges(tree.size());
  const Buckets<> of_range(pieces.size(), ranges.count(), [&](std::size_t i, const auto& put) {
    put(ranges.of(pieces[i].leaf), static_cast<std::uint32_t>(i));
  });
  parallel_for(ranges.count(), [&](std::size_t r) {
    for (const std::uint32_t i : of_range[r]) add(pieces[i]);
  });
  return of_leaf;
}

void split(const RootCube& root, const Octree& tree, Vec3 a, Vec3 b, Vec3 c, std::vector<SurfacePiece>& pieces) {
  const Vec3 p = (a + b + c) / 3;
  const std::size_t leaf = tree.find(root.cell(p));
  const double limit = root.side_of(tree.leaf(leaf));
  const double ab = squared_length(b - a), bc = squared_length(c - b), ca = squared_length(a - c);
  const double longest = std::max({ab, bc, ca});
  if (longest <= limit * limit) {
    pieces.push_back({p, 0.5 * cross(b - a, c - a), static_cast<std::uint32_t>(leaf)});
  } else if (longest == ab) {
    split(root, tree, a, 0.5 * (a + b), c, pieces);
    split(root, tree, 0.5 * (a + b), b, c, pieces);
  } else if (longest == bc) {
    split(root, tree, a, b, 0.5 * (b + c), pieces);
    split(root, tree, a, 0.5 * (b + c), c, pieces);
  } else {
    split(root, tree, a, b, 0.5 * (c + a), pieces);
    split(root, tree, 0.5 * (c + a), b, c, pieces);
  }
}

}  // namespace

RawVector<SurfacePiece> surface_pieces(const RootCube& root, const Octree& tree, const SurfaceMesh& surface) {
  constexpr std::size_t kRange = 512;
  return parallel_collect<SurfacePiece, RawVector<SurfacePiece>>(
      surface.triangles.size(), kRange, [&](std::size_t begin, std::size_t end, std::vector<SurfacePiece>& pieces) {
        for (std::size_t f = begin; f < end; ++f) {
          const Triangle& t = surface.triangles[f];
          split(root, tree, surface.points[t[0]], surface.points[t[1]], surface.points[t[2]], pieces);
        }
      });
}

RawVector<double> inside_fractions(const RootCube& root, const Octree& tree, std::span<const SurfacePiece> pieces) {
  const RawVector<Moments> of_leaf = moments_of_leaves(root, tree, pieces);
  RawVector<double> fraction(tree.size());
  std::vector<Branch> branches = branches_of(tree);
  std::vector<std::optional<Haar>> below(branches.size());
  parallel_for(
      branches.size(),
      [&](std::size_t b) {
        below[b].emplace(tree, of_leaf, branches[b].cell, branches[b].first, std::span<Branch>{});
        branches[b].sum = below[b]->sum();
      },
      Split::kSingly);
  const Haar above(tree, of_leaf, OctreeKey::root(), 0, branches);
  above.spread((above.sum().nx.x + above.sum().nx.y + above.sum().nx.z) / 3, fraction);
  parallel_for(
      branches.size(),
      [&](std::size_t b) {
        if (branches[b].sum.any) below[b]->spread(branches[b].average, fraction);
      },
      Split::kSingly);
  return fraction;
}

}  // namespace octafront
