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
  TetIndex beta_min_tet = kNone;
  double dihedral_min = 0, dihedral_max = 0;           ///< degrees, over all elements
  std::array<std::uint64_t, 18> dihedral_histogram{};  ///< all six angles of all elements, classes of 10 degrees
};

QualitySummary summarize_quality(const TetMesh& mesh);

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
