#include "sizing/inside_fraction.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>

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

/// With sigma_a = -1 in the lower and +1 in the upper half of a cell along axis a, the average of the indicator
/// function over child i is its average over the cell plus the sum, over the seven non-empty sets e of axes, of c_e
/// prod_{a in e} sigma_a(i); and c_e = 1/V * integral of it times prod sigma. The latter is the divergence of
/// (antiderivative of sigma_a) prod_{b in e, b != a} sigma_b along any axis a of e, which vanishes on the cell's faces:
/// what is left by Gauss is an integral over the surface in the cell, linear in the moments of the children.
class Haar {
 public:
  Haar(const Octree& tree, const std::vector<Moments>& of_leaf) : tree_(tree), of_leaf_(of_leaf) {
    fraction_.resize(tree.size());
  }

  std::vector<double> run() {
    std::size_t next = 0;
    const Moments root = gather(OctreeKey::root(), next);
    spread(OctreeKey::root(), (root.nx.x + root.nx.y + root.nx.z) / 3, 0);
    return std::move(fraction_);
  }

 private:
  struct Inner {
    std::array<Moments, 8> child;
    std::array<std::uint32_t, 8> leaves_end;  ///< leaf behind the child
    std::array<std::int32_t, 8> inner;        ///< number of the child if it is divided and has surface, else -1
  };

  Moments gather(OctreeKey cell, std::size_t& next_leaf) {
    if (tree_.leaf(next_leaf) == cell) return of_leaf_[next_leaf++];
    const std::size_t me = inner_.size();
    inner_.emplace_back();
    Moments sum;
    const double half = 0.5 / (1u << cell.level());
    for (int i = 0; i < 8; ++i) {
      const bool divided = tree_.leaf(next_leaf) != cell.child(i);
      const auto number = static_cast<std::int32_t>(inner_.size());
      const Moments m = gather(cell.child(i), next_leaf);
      inner_[me].child[i] = m;
      inner_[me].inner[i] = divided ? number : -1;
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

  void spread(OctreeKey cell, double average, std::size_t inner) {
    if (inner_.empty()) {
      fraction_[0] = std::clamp(average, 0.0, 1.0);
      return;
    }
    const Inner& in = inner_[inner];
    std::array<double, 8> c{};
    for (int e = 1; e < 8; ++e) c[e] = coefficient(in, e, 1.0 / (1u << cell.level()));
    std::uint32_t begin = inner == 0 ? 0 : begin_;
    for (int i = 0; i < 8; ++i) {
      double v = average;
      for (int e = 1; e < 8; ++e) {
        double sign = 1;
        for (int a = 0; a < 3; ++a) sign *= (e >> a & 1) ? sigma(i, a) : 1;
        v += sign * c[e];
      }
      if (!in.child[i].any) {
        std::fill(fraction_.begin() + begin, fraction_.begin() + in.leaves_end[i], v > 0.5 ? 1.0 : 0.0);
      } else if (in.inner[i] < 0) {
        fraction_[begin] = std::clamp(v, 0.0, 1.0);
      } else {
        begin_ = begin;
        spread(cell.child(i), v, static_cast<std::size_t>(in.inner[i]));
      }
      begin = in.leaves_end[i];
    }
  }

  const Octree& tree_;
  const std::vector<Moments>& of_leaf_;
  std::vector<Inner> inner_;
  std::vector<double> fraction_;
  std::uint32_t begin_ = 0;
};

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

std::vector<SurfacePiece> surface_pieces(const RootCube& root, const Octree& tree, const SurfaceMesh& surface) {
  constexpr std::size_t kRange = 1024;
  return parallel_collect<SurfacePiece>(
      surface.triangles.size(), kRange, [&](std::size_t begin, std::size_t end, std::vector<SurfacePiece>& pieces) {
        for (std::size_t f = begin; f < end; ++f) {
          const Triangle& t = surface.triangles[f];
          split(root, tree, surface.points[t[0]], surface.points[t[1]], surface.points[t[2]], pieces);
        }
      });
}

std::vector<double> inside_fractions(const RootCube& root, const Octree& tree,
                                     const std::vector<SurfacePiece>& pieces) {
  std::vector<Moments> of_leaf(tree.size());
  for (const SurfacePiece& piece : pieces)
    of_leaf[piece.leaf].add(piece.n / (root.side * root.side),
                            (piece.p - root.corner_of(tree.leaf(piece.leaf))) / root.side);
  return Haar(tree, of_leaf).run();
}

}  // namespace octafront
