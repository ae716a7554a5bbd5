#include "fill/lattice/clear_sites.h"

#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace octafront {

namespace {

/// Distances are measured up to this multiple of a cell's side: the sum of two such covers any edge between cells.
constexpr double kFarthest = 0.75;
/// From the centre of a cell to its corners, in its sides; rounded up.
constexpr double kHalfDiagonal = 0.8661;
/// Distances are rounded to float, and down by more than the rounding of what they are computed from.
constexpr double kRoundingDown = 1 - 1e-6;
/// Balls about the corners of a simplex cover it if their radius is this share of its longest edge or more: no set is
/// farther from the centre of its smallest ball (H. W. E. Jung, 1901: sqrt(3 / 8) in space).
constexpr double kCoveringShare = 0.6124;
constexpr std::size_t kLeavesBetweenChecks = 4096;

/// All of `points` lie strictly on one side of the plane through a, b and c.
template <std::size_t n>
bool on_one_side(Vec3 a, Vec3 b, Vec3 c, const std::array<Vec3, n>& points, int side = 0) {
  for (const Vec3 p : points) {
    const int sign = orient3d(a, b, c, p);
    if (sign == 0 || sign == -side) return false;
    side = sign;
  }
  return true;
}

/// The plane of the triangle or one of the tetrahedron has them strictly apart.
bool plane_separates(const std::array<Vec3, 4>& tet, const TriangleCorners& triangle) {
  const auto& [a, b, c] = triangle;
  if (on_one_side(a, b, c, tet)) return true;
  return std::any_of(kTetFaces.begin(), kTetFaces.end(), [&](const auto& face) {
    const auto& [i, j, k] = face;
    const int inner = orient3d(tet[i], tet[j], tet[k], tet[6 - i - j - k]);
    return on_one_side(tet[i], tet[j], tet[k], triangle, -inner);
  });
}

}  // namespace

ClearSites::ClearSites(const LatticeOctree& lattice, const TriangleTree& triangles, const TriangleTree& hull,
                       const RunContext& context)
    : lattice_(lattice), triangles_(triangles), hull_(hull), space_(lattice.tree.size()) {
  distance_.resize(2 * space_.size());
  for_each_leaf(context, [&](std::size_t leaf, std::uint32_t& near_by) { measure_center(leaf, near_by); });
  find_inside();
  for_each_leaf(context, [&](std::size_t leaf, std::uint32_t& near_by) { measure_corner(leaf, near_by); });
}

template <class Measure>
void ClearSites::for_each_leaf(const RunContext& context, const Measure& measure) {
  const Comm comm(context.ranks);
  const std::size_t leaves = space_.size();
  const std::vector<std::uint64_t> work((leaves + kLeavesBetweenChecks - 1) / kLeavesBetweenChecks, 1);
  const Shares shares(work, comm.size());
  do_share(comm, shares, "sites of the lattice", [&](std::size_t stretch) {
    context.check();
    std::uint32_t near_by = kNone;
    const std::size_t first = stretch * kLeavesBetweenChecks;
    for (std::size_t i = first; i < std::min(first + kLeavesBetweenChecks, leaves); ++i) measure(i, near_by);
  });
  gather_leaves(comm, shares);
}

/// Every rank gets what the others have measured.
void ClearSites::gather_leaves(const Comm& comm, const Shares& shares) {
  if (comm.alone()) return;
  const auto leaf = [&](std::size_t stretch) { return std::min(stretch * kLeavesBetweenChecks, space_.size()); };
  const auto stretch_of = [&](int rank, const auto& visit) {
    const std::size_t first = leaf(shares.begin(rank)), count = leaf(shares.end(rank)) - first;
    visit(std::as_writable_bytes(std::span(space_).subspan(first, count)));
    visit(std::as_writable_bytes(std::span(distance_).subspan(2 * first, 2 * count)));
  };
  Bytes mine;
  stretch_of(comm.rank(), [&](std::span<const std::byte> part) { mine.insert(mine.end(), part.begin(), part.end()); });
  comm.gather(mine, "sites of the lattice").for_each([&](int rank, std::span<const std::byte> bytes) {
    stretch_of(rank, [&](std::span<std::byte> part) {
      std::copy_n(bytes.begin(), part.size(), part.begin());
      bytes = bytes.subspan(part.size());
    });
  });
}

void ClearSites::measure_center(std::size_t i, std::uint32_t& near_by) {
  const double side = lattice_.root.side_of(lattice_.tree.leaf(i)), all_far = (kFarthest + kHalfDiagonal) * side;
  const auto center = static_cast<SiteNumber>(2 * i);
  const double distance = distance_within(all_far, position_of(center), kCoreClearance * side, near_by);
  space_[i] = distance >= all_far ? Space::kFar : distance >= kHalfDiagonal * side ? Space::kClear : Space::kNear;
  distance_[center] = kept(distance, side);
}

/// No tetrahedron of the core has a corner in a leaf that lies outside with all of its cell.
void ClearSites::measure_corner(std::size_t i, std::uint32_t& near_by) {
  const auto center = static_cast<SiteNumber>(2 * i), corner = center + 1;
  if (space_[i] == Space::kFar)
    distance_[corner] = distance_[center];
  else if (space_[i] == Space::kNear || inside_[i])
    distance_[corner] = measured(position_of(corner), lattice_.root.side_of(lattice_.tree.leaf(i)), near_by);
}

/// To the surface from p, if that is less than `farthest`; of what is less than `enough`, any. `near_by`: a triangle
/// that may be near, for a search with a good limit is short; it becomes one that is.
double ClearSites::distance_within(double farthest, Vec3 p, double enough, std::uint32_t& near_by) const {
  double least = farthest * farthest;
  bool found = false;
  if (near_by != kNone) {
    const auto& [a, b, c] = triangles_.corners(near_by);
    const double squared = squared_distance(p, closest_point_on_triangle(p, a, b, c)), distance = std::sqrt(squared);
    if (distance < enough) return distance;
    found = squared < least;
    least = std::min(least, squared);
  }
  const auto nearest = triangles_.nearest(p, least);
  if (nearest.triangle == kNone) return found ? std::sqrt(least) : farthest;
  near_by = nearest.triangle;
  return std::sqrt(nearest.squared_distance);
}

float ClearSites::kept(double distance, double side) {
  if (distance < kCoreClearance * side) return 0;
  return static_cast<float>(kRoundingDown * std::min(distance, kFarthest * side));
}

float ClearSites::measured(Vec3 p, double side, std::uint32_t& near_by) const {
  return kept(distance_within(kFarthest * side, p, kCoreClearance * side, near_by), side);
}

float ClearSites::distance_of(LatticeSite site) const {
  const auto [x, y, z] = unpack_site(site);
  // The side of the smallest leaves of which the site can be a corner: whoever asks, the answer is the same.
  const std::uint32_t units = 1u << std::countr_zero(x | y | z | OctreeKey::kSide);
  std::uint32_t near_by = kNone;
  return measured(position(lattice_.root, site), lattice_.root.side / OctreeKey::kSide * units, near_by);
}

/// Where the balls about two sites cover the edge between them, the sites lie on one side of the surface: one inside
/// test a component is enough. The centres of leaves of one size that share a face are connected.
void ClearSites::find_inside() {
  const Octree& tree = lattice_.tree;
  std::vector<std::array<std::uint32_t, 3>> upper(tree.size());
  parallel_for(tree.size(), [&](std::size_t i) {
    const double side = lattice_.root.side_of(tree.leaf(i));
    for (int axis = 0; axis < 3; ++axis) {
      upper[i][axis] = kNone;
      if (distance_[2 * i] == 0) continue;
      const OctreeKey beyond = tree.leaf(i).neighbour(axis == 0, axis == 1, axis == 2);
      if (!beyond.is_valid()) continue;
      const std::size_t j = tree.find(beyond);
      if (tree.leaf(j) == beyond && distance_[2 * j] != 0 && distance_[2 * i] + distance_[2 * j] > side)
        upper[i][axis] = static_cast<std::uint32_t>(j);
    }
  });
  DisjointSets components(tree.size());
  parallel_for(tree.size(), [&](std::size_t i) {
    for (const std::uint32_t j : upper[i])
      if (j != kNone) components.join_shared(static_cast<std::uint32_t>(i), j);
  });
  inside_.resize(tree.size());
  const auto root_of = [&](std::size_t i) { return components.find_shared(static_cast<std::uint32_t>(i)); };
  parallel_for(tree.size(), [&](std::size_t i) {
    if (root_of(i) == i) inside_[i] = distance_[2 * i] != 0 && contains(position_of(static_cast<SiteNumber>(2 * i)));
  });
  parallel_for(tree.size(), [&](std::size_t i) {
    if (const std::uint32_t root = root_of(i); root != i) inside_[i] = inside_[root];
  });
}

bool ClearSites::is_clear(const std::array<Vec3, 4>& corners, float least_distance) const {
  double longest = 0;
  for (const auto& [i, j] : kTetEdges) longest = std::max(longest, squared_length(corners[j] - corners[i]));
  if (least_distance > kCoveringShare * std::sqrt(longest)) return true;
  Box3 box;
  for (const Vec3 p : corners) box.add(p);
  bool clear = true;
  triangles_.for_each_overlapping(
      box, [&](std::uint32_t t) { clear = clear && plane_separates(corners, triangles_.corners(t)); });
  return clear;
}

}  // namespace octafront
