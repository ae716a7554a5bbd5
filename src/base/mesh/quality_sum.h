#pragma once

#include <octafront/quality.h>

#include <cstdint>
#include <vector>

namespace octafront {

/// A QualitySummary that can be added up in any order.
struct QualitySum {
  QualitySummary summary;  ///< beta_mean is not set
  std::int64_t beta = 0;   ///< the sum, in units of kBetaUnit
  static constexpr double kBetaUnit = 0x1p-32;

  void add(const QualitySum& more);
  QualitySummary finished() const;
};

/// Of the tetrahedra, whose first one has the number `first_tet` in the whole. By region as well: of as many as given,
/// more than any of `region` says.
QualitySum sum_of_quality(const TetMesh& mesh, std::uint64_t first_tet);
std::vector<QualitySum> sums_of_regions(const TetMesh& mesh, std::uint64_t first_tet, std::uint32_t regions);

}  // namespace octafront
