#pragma once

#include <octafront/ids.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace octafront {

/// beta = 3 r / R, inradius over circumradius: 1 for the regular tetrahedron, 0 for a flat one, negative if inverted.
double radius_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

/// 2 r / R of a triangle: 1 if equilateral, 0 if degenerate.
double radius_ratio(Vec3 a, Vec3 b, Vec3 c);

/// The six dihedral angles in degrees, in the order of kTetEdges.
std::array<double, 6> dihedral_angles(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

/// Distribution of element quality over a mesh.
struct QualitySummary {
  std::uint64_t elements = 0;
  /// Elements with beta in the paper's classes [0, .2) [.2, .4) [.4, .6) [.6, .8) [.8, 1].
  std::array<std::uint64_t, 5> beta_classes{};
  double beta_mean = 0, beta_min = 0;
  TetIndex beta_min_tet = kNone, dihedral_min_tet = kNone;  ///< of equal ones the first
  Vec3 beta_min_at, dihedral_min_at;                        ///< the means of their corners
  double dihedral_min = 0, dihedral_max = 0;                ///< degrees, over all elements
  std::array<std::uint64_t, 18> dihedral_histogram{};       ///< all six angles of all elements, classes of 10 degrees
};

QualitySummary summarize_quality(const TetMesh& mesh);

/// What the wedges or the pyramids of a mesh (TetMesh::wide_cells) are as elements of their own, by their corners: the
/// four of a pyramid's base. The scaled Jacobian of a corner is the determinant of its three edges over their lengths,
/// in parts of what it is in a right-angled wedge on an equilateral triangle, in a pyramid of equilateral triangles.
struct WideSummary {
  std::uint64_t count = 0;
  double least_scaled_jacobian = 0, mean_scaled_jacobian = 0;  ///< of the least corner of each
  std::uint32_t least = kNone;                                 ///< of these the least one: its place in wide_cells
  Vec3 at;                                                     ///< the mean of its corners
  std::uint64_t turned = 0;                                    ///< no corner is positive, by exact sign
  std::uint64_t torn = 0;                                      ///< some are, some are not
  std::uint32_t first_bad = kNone;                             ///< place of the first turned or torn one
};

WideSummary summarize_wedges(const TetMesh& mesh);
WideSummary summarize_pyramids(const TetMesh& mesh);

/// A poor element, and where to look for it.
struct PoorElement {
  TetIndex tet = kNone;
  Vec3 at;                                    ///< the mean of its corners
  double beta = 0;                            ///< negative if inverted
  double dihedral_min = 0, dihedral_max = 0;  ///< degrees
};

/// The `count` elements of the least beta, or all if there are fewer, the worst first; of equal ones the first.
std::vector<PoorElement> worst_elements(const TetMesh& mesh, std::size_t count);

/// The same of each region, by number; of one without elements `elements` is 0.
std::vector<QualitySummary> quality_of_regions(const TetMesh& mesh);

}  // namespace octafront
