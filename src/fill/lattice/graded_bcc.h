#pragma once

// The graded body-centred cubic lattice on a 2:1 balanced octree, after F. Labelle and J. R. Shewchuk, "Isosurface
// Stuffing: Fast Tetrahedral Meshes with Good Dihedral Angles", 2007, section 3.
//
// Its points are the corners and the centres of the leaves. Two leaves of equal size that share a face give, for each
// edge of that face, the tetrahedron of the two centres and the edge; where a smaller leaf has a corner in the middle
// of the edge, that one is bisected. Where a leaf meets four smaller ones, each of them gives two half-pyramids on its
// own side and two quartered tetrahedra on the large leaf's side; both share the diagonal of the small face that ends
// in the middle of the large one:
//
//      C ------- M2 ------- +        C   corner of the large face        F   its middle
//      |  .      |          |        M1, M2   middles of its edges
//      |    .    |          |        the small leaf's face is C M1 F M2,
//      |      .  |          |        its two triangles are (F, C, M1) and (F, M2, C)
//      M1 ------ F ---------|
//      |         |          |
//      + ------- + -------- +

#include "sizing/field/octree.h"

#include <array>
#include <cstdint>
#include <functional>

namespace octafront {

/// A point of the lattice: its coordinates in units of the octree, packed as 3 x 21 bits.
using LatticeSite = std::uint64_t;

constexpr LatticeSite pack_site(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return static_cast<LatticeSite>(x) | static_cast<LatticeSite>(y) << 21 | static_cast<LatticeSite>(z) << 42;
}
constexpr std::array<std::uint32_t, 3> unpack_site(LatticeSite s) {
  return {static_cast<std::uint32_t>(s & 0x1fffff), static_cast<std::uint32_t>(s >> 21 & 0x1fffff),
          static_cast<std::uint32_t>(s >> 42 & 0x1fffff)};
}

/// How far apart two sites are if they differ along one axis only, in units of the octree; else 0.
constexpr std::uint64_t axis_distance(LatticeSite a, LatticeSite b) {
  const LatticeSite d = a < b ? b - a : a - b;
  for (const int shift : {0, 21, 42})
    if (d >> shift << shift == d && d >> shift < 1u << 21) return d >> shift;
  return 0;
}

/// A tetrahedron of the lattice, as it is visited below, belongs to two leaves of one size whose common edge is not
/// divided: it has the shape of the uniform lattice, with beta .949. All others have .62 to .80.
constexpr bool is_regular(const std::array<LatticeSite, 4>& tet) {
  const std::uint64_t edge = axis_distance(tet[0], tet[1]);
  return edge != 0 && edge == axis_distance(tet[2], tet[3]);
}

/// The leaves of a lattice may not be finer than this, so that their centres fall on whole units.
inline constexpr int kFinestLatticeLevel = OctreeKey::kMaxLevel - 1;

/// Where a site lies.
Vec3 position(const RootCube& root, LatticeSite site);

/// Calls `visit` for every tetrahedron of the lattice inside the root cube, each once, positive (see tet_mesh.h), in
/// the order of the leaves. REQUIRES: the tree is balanced, and no leaf is finer than kFinestLatticeLevel.
void for_each_lattice_tet(const Octree& tree, const std::function<void(const std::array<LatticeSite, 4>&)>& visit);

/// The same for the tetrahedra that leaf `i` has with leaves as large, on its upper sides, and with larger ones.
void for_each_lattice_tet_of(const Octree& tree, std::size_t i,
                             const std::function<void(const std::array<LatticeSite, 4>&)>& visit);

}  // namespace octafront
