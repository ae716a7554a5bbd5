#include "fill/lattice/graded_bcc.h"

#include <utility>

namespace octafront {

namespace {

using Cell = std::array<std::uint32_t, 3>;

LatticeSite site_of(const Cell& c) {
  return pack_site(c[0], c[1], c[2]);
}

LatticeSite center_site(OctreeKey leaf) {
  Cell c = leaf.corner();
  for (std::uint32_t& x : c) x += leaf.side() / 2;
  return site_of(c);
}

OctreeKey step(OctreeKey key, int axis, int by, int axis2 = 0, int by2 = 0) {
  std::array<int, 3> d{};
  d[axis] += by;
  d[axis2] += by2;
  return key.neighbour(d[0], d[1], d[2]);
}

// One leaf and one of its six faces, seen from the leaf. The other two axes are u and v, so that (axis, u, v) is a
// right-handed frame; corners of the face are numbered counter-clockwise seen from +axis.
class LeafFace {
 public:
  /// The leaves across its faces: the lower one and the upper one of each axis; keys that are not valid at the root's.
  using Across = std::array<std::array<OctreeKey, 2>, 3>;

  LeafFace(const Octree& tree, OctreeKey leaf, const Across& neighbours, int axis, bool high)
      : tree_(tree),
        leaf_(leaf),
        low_(leaf.corner()),
        neighbours_(neighbours),
        axis_(axis),
        u_((axis + 1) % 3),
        v_((axis + 2) % 3),
        high_(high) {}

  // The two centres and each edge of the face between leaves of one size; called for the upper faces only.
  template <class Visit>
  void visit_equal(OctreeKey across, const Visit& visit) const {
    const LatticeSite below = center_site(leaf_), above = center_site(across);
    for (int i = 0; i < 4; ++i) {
      const Cell from = corner(i), to = corner((i + 1) % 4);
      if (edge_is_divided(across, i)) {
        const Cell middle{(from[0] + to[0]) / 2, (from[1] + to[1]) / 2, (from[2] + to[2]) / 2};
        visit({site_of(from), site_of(middle), below, above});
        visit({site_of(middle), site_of(to), below, above});
      } else {
        visit({site_of(from), site_of(to), below, above});
      }
    }
  }

  // This leaf's quarter of the face of a leaf twice as large: two half-pyramids here, two quartered tets there.
  template <class Visit>
  void visit_larger(OctreeKey large, const Visit& visit) const {
    const int child = leaf_.child_number();
    // Corner of this face that lies in the middle of the parent's face: on the inner side along u and along v.
    const bool middle_high_u = !(child >> u_ & 1), middle_high_v = !(child >> v_ & 1);
    const int f = corner_number(middle_high_u, middle_high_v);
    const LatticeSite middle = site_of(corner(f)), m1 = site_of(corner((f + 1) % 4)),
                      outer = site_of(corner((f + 2) % 4)), m2 = site_of(corner((f + 3) % 4));
    LatticeSite above = center_site(large), below = center_site(leaf_);
    if (!high_) std::swap(above, below);
    // The corners run counter-clockwise seen from +axis, where `above` lies.
    for (const auto& [a, b, c] : {std::array{middle, m1, outer}, std::array{middle, outer, m2}}) {
      visit({a, b, c, above});
      visit({a, c, b, below});
    }
  }

 private:
  static int corner_number(bool high_u, bool high_v) { return high_v ? (high_u ? 2 : 3) : (high_u ? 1 : 0); }

  Cell corner(int i) const {
    constexpr std::array<std::array<int, 2>, 4> kTurn{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    Cell c = low_;
    const std::uint32_t side = leaf_.side();
    if (high_) c[axis_] += side;
    if (kTurn[i][0]) c[u_] += side;
    if (kTurn[i][1]) c[v_] += side;
    return c;
  }

  // Has a leaf around edge i (from corner i to the next) a corner in its middle? Only the two leaves that are neither
  // this one nor the one across the face can be finer.
  bool edge_is_divided(OctreeKey across, int i) const {
    constexpr std::array<int, 4> kSide{-1, 1, 1, -1};  // edge 0 lies at low v, 1 at high u, 2 at high v, 3 at low u
    const int away = i % 2 == 0 ? v_ : u_;
    const OctreeKey beside = neighbours_[away][kSide[i] > 0];
    if (!beside.is_valid()) return false;
    if (beside.level() > leaf_.level()) return true;
    return tree_.leaf(tree_.find(step(across, away, kSide[i]))).level() > leaf_.level();
  }

  const Octree& tree_;
  OctreeKey leaf_;
  Cell low_;  ///< its corner
  const Across& neighbours_;
  int axis_, u_, v_;
  bool high_;
};

}  // namespace

Vec3 position(const RootCube& root, LatticeSite site) {
  return root.position(unpack_site(site));
}

void for_each_lattice_tet_of(const Octree& tree, std::size_t i,
                             const std::function<void(const std::array<LatticeSite, 4>&)>& visit) {
  const OctreeKey leaf = tree.leaf(i);
  LeafFace::Across neighbours;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      const OctreeKey beyond = step(leaf, axis, high ? 1 : -1);
      neighbours[axis][high] = beyond.is_valid() ? tree.leaf(tree.find(beyond)) : beyond;
    }
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      const OctreeKey across = neighbours[axis][high];
      if (!across.is_valid()) continue;
      const LeafFace face(tree, leaf, neighbours, axis, high);
      if (across.level() == leaf.level() && high) face.visit_equal(across, visit);
      if (across.level() < leaf.level()) face.visit_larger(across, visit);
    }
}

void for_each_lattice_tet(const Octree& tree, const std::function<void(const std::array<LatticeSite, 4>&)>& visit) {
  for (std::size_t i = 0; i < tree.size(); ++i) for_each_lattice_tet_of(tree, i, visit);
}

}  // namespace octafront
