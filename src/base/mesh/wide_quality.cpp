#include <octafront/quality.h>
#include <octafront/validity.h>

#include "base/geometry/predicates.h"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/core.h>

namespace octafront {

namespace {

using Corner = std::array<std::size_t, 4>;

/// A corner and its three neighbours, so that the tetrahedron of a sound cell is positive.
constexpr std::array<Corner, 6> kWedgeCorners{
    {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
constexpr std::array<Corner, 4> kPyramidCorners{{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
/// What the determinant is where a wedge or pyramid is regular: the sines of 60 and 45 degrees.
constexpr double kRegularWedge = 0.86602540378443865, kRegularPyramid = 0.70710678118654752;

std::span<const Corner> wide_corners(const WideCell& cell) {
  return cell.tet_count == 3 ? std::span<const Corner>(kWedgeCorners) : std::span<const Corner>(kPyramidCorners);
}

class WideQuality {
 public:
  WideQuality(const TetMesh& mesh, const WideCell& cell) : mesh_(mesh), cell_(cell) {}

  double least_scaled_jacobian() const {
    double least = 2;
    for (const auto& [a, b, c, d] : wide_corners(cell_)) {
      const Vec3 u = at(b) - at(a), v = at(c) - at(a), w = at(d) - at(a);
      const double lengths = length(u) * length(v) * length(w);
      const double regular = cell_.tet_count == 3 ? kRegularWedge : kRegularPyramid;
      least = std::min(least, lengths > 0 ? dot(cross(u, v), w) / (lengths * regular) : 0);
    }
    return least;
  }

  std::size_t positive_corners() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        wide_corners(cell_), [&](const Corner& k) { return orient3d(at(k[0]), at(k[1]), at(k[2]), at(k[3])) > 0; }));
  }

  Vec3 middle() const {
    Vec3 sum{};
    for (std::size_t k = 0; k < cell_.tet_count + 3; ++k) sum = sum + at(k);
    return sum / static_cast<double>(cell_.tet_count + 3);
  }

 private:
  Vec3 at(std::size_t k) const { return mesh_.points[cell_.nodes[k]]; }

  const TetMesh& mesh_;
  const WideCell& cell_;
};

WideSummary summary_of(const TetMesh& mesh, std::uint32_t tet_count) {
  WideSummary summary;
  for (std::uint32_t w = 0; w < mesh.wide_cells.size(); ++w) {
    const WideCell& cell = mesh.wide_cells[w];
    if (cell.tet_count != tet_count) continue;
    const WideQuality quality(mesh, cell);
    const double value = quality.least_scaled_jacobian();
    const std::size_t positive = quality.positive_corners(), corners = wide_corners(cell).size();
    if (summary.least == kNone || value < summary.least_scaled_jacobian) {
      summary.least = w;
      summary.least_scaled_jacobian = value;
      summary.at = quality.middle();
    }
    if (positive < corners && summary.first_bad == kNone) summary.first_bad = w;
    summary.turned += positive == 0;
    summary.torn += positive > 0 && positive < corners;
    ++summary.count;
    summary.mean_scaled_jacobian += (value - summary.mean_scaled_jacobian) / static_cast<double>(summary.count);
  }
  return summary;
}

}  // namespace

WideSummary summarize_wedges(const TetMesh& mesh) {
  return summary_of(mesh, 3);
}

WideSummary summarize_pyramids(const TetMesh& mesh) {
  return summary_of(mesh, 2);
}

std::optional<std::string> first_wide_defect(const TetMesh& mesh) {
  for (const WideCell& cell : mesh.wide_cells) {
    const WideQuality quality(mesh, cell);
    const std::size_t positive = quality.positive_corners(), corners = wide_corners(cell).size();
    if (positive == corners) continue;
    const Vec3 p = quality.middle();
    return fmt::format(
        "the {} of tetrahedra {} to {} at ({:.6g}, {:.6g}, {:.6g}) is {}", cell.tet_count == 3 ? "wedge" : "pyramid",
        cell.first, cell.first + cell.tet_count - 1, p.x, p.y, p.z,
        positive == 0
            ? "turned inside out"
            : fmt::format("torn: the Jacobian is not positive at {} of its {} corners", corners - positive, corners));
  }
  return std::nullopt;
}

}  // namespace octafront
