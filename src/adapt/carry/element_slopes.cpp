#include "adapt/carry/element_slopes.h"

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/symmetric_matrix.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <limits>

namespace octafront::adapt {
namespace {

/// Middles that lie in a plane, or nearly, say nothing across it: their spread across, squared, against that along.
constexpr double kLeastSpread = 1e-3;

/// Whether three axes of the spread are of about the same length: by the determinant, which is that of an even one or
/// less.
bool spreads_in_space(const SymmetricMatrix& m) {
  const double third = m.trace() / 3;
  const double determinant =
      m.xx * (m.yy * m.zz - m.yz * m.yz) - m.xy * (m.xy * m.zz - m.yz * m.xz) + m.xz * (m.xy * m.yz - m.yy * m.xz);
  return determinant > kLeastSpread * third * third * third;
}

}  // namespace

ElementSlopes::ElementSlopes(const TetMesh& mesh, const MatchedRegions& regions, std::span<const double> values,
                             std::size_t components)
    : mesh_(mesh), components_(components) {
  number_corners(regions);
  find_slopes_at_corners(values);
  find_slopes(values);
}

ElementSlopes ElementSlopes::of_corners(const TetMesh& mesh, std::span<const double> values, std::size_t components) {
  ElementSlopes made(mesh, components);
  made.slopes_.resize(mesh.tets.size() * components);
  parallel_for(mesh.tets.size(), [&](std::size_t t) {
    const Tet& tet = mesh.tets[t];
    const double six = six_volumes(mesh.points[tet[0]], mesh.points[tet[1]], mesh.points[tet[2]], mesh.points[tet[3]]);
    for (int i = 0; i < 4; ++i) {
      const Triangle face = face_of(tet, i);
      // Inward: what the corner's share of the place grows by.
      const Vec3 grows = double_area_normal(mesh.points[face[0]], mesh.points[face[1]], mesh.points[face[2]]) / -six;
      for (std::size_t k = 0; k < components; ++k)
        made.slopes_[t * components + k] += values[(4 * t + static_cast<std::size_t>(i)) * components + k] * grows;
    }
  });
  return made;
}

Vec3 ElementSlopes::centre(TetIndex t) const {
  const auto& [a, b, c, d] = mesh_.tets[t];
  return centroid(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]);
}

void ElementSlopes::number_corners(const MatchedRegions& regions) {
  corner_count_ = mesh_.points.size();
  if (regions.count() == 1) return;
  std::vector<std::uint64_t> keys(4 * mesh_.tets.size());
  parallel_for(keys.size(), [&](std::size_t i) {
    const auto t = static_cast<TetIndex>(i / 4);
    keys[i] = std::uint64_t{mesh_.tets[t][i % 4]} * regions.count() + regions.of_old(t);
  });
  std::vector<std::uint64_t> sorted = keys;
  parallel_sort(sorted);
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  corner_count_ = sorted.size();
  corners_.resize(keys.size());
  parallel_for(keys.size(), [&](std::size_t i) {
    corners_[i] = static_cast<Corner>(std::lower_bound(sorted.begin(), sorted.end(), keys[i]) - sorted.begin());
  });
}

void ElementSlopes::find_slopes_at_corners(std::span<const double> values) {
  const Groups<> around(corner_count_, [&](const auto& add) {
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
      for (std::size_t i = 0; i < 4; ++i) add(corner(t, i), t);
  });
  at_corners_.resize(corner_count_ * components_), is_known_.assign(corner_count_, 0);
  least_.resize(corner_count_ * components_), greatest_.resize(corner_count_ * components_);
  parallel_for(corner_count_, [&](std::size_t c) {
    const auto tets = around[c];
    if (tets.empty()) return;
    Vec3 middle;
    for (const TetIndex t : tets) middle += centre(t);
    middle = middle / static_cast<double>(tets.size());
    SymmetricMatrix spread;
    for (const TetIndex t : tets) spread.add(centre(t) - middle, 1);
    is_known_[c] = spreads_in_space(spread);
    for (std::size_t k = 0; k < components_; ++k) {
      double least = std::numeric_limits<double>::infinity(), greatest = -least;
      Vec3 moment;
      for (const TetIndex t : tets) {
        const double value = values[t * components_ + k];
        least = std::min(least, value), greatest = std::max(greatest, value);
        moment += value * (centre(t) - middle);
      }
      least_[c * components_ + k] = least, greatest_[c * components_ + k] = greatest;
      if (is_known_[c]) at_corners_[c * components_ + k] = spread.damped_solve(moment, 0);
    }
  });
}

void ElementSlopes::find_slopes(std::span<const double> values) {
  slopes_.resize(mesh_.tets.size() * components_);
  parallel_for(mesh_.tets.size(), [&](std::size_t number) {
    const auto t = static_cast<TetIndex>(number);
    const Vec3 middle = centre(t);
    for (std::size_t k = 0; k < components_; ++k) {
      Vec3 slope;
      int known = 0;
      for (std::size_t i = 0; i < 4; ++i)
        if (const Corner c = corner(t, i); is_known_[c]) slope += at_corners_[c * components_ + k], ++known;
      if (known == 0) continue;
      slope = slope / static_cast<double>(known);
      const double value = values[number * components_ + k];
      double share = 1;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t c = corner(t, i) * components_ + k;
        const double change = dot(slope, mesh_.points[mesh_.tets[t][i]] - middle);
        const double room = change > 0 ? greatest_[c] - value : least_[c] - value;
        if (change != 0) share = std::min(share, room / change);
      }
      slopes_[number * components_ + k] = share * slope;
    }
  });
}

}  // namespace octafront::adapt
