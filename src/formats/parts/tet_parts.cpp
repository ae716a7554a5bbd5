#include "formats/parts/tet_parts.h"

#include "base/mesh/tet_edges.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octafront::io {
namespace {

/// From the numbers of those in the order of their vertices.
template <std::size_t kEach>
NumberedParts numbered(const std::vector<std::array<std::uint32_t, kEach>>& of_tet, std::size_t count,
                       PartOrder order) {
  NumberedParts parts{{}, std::vector<std::uint32_t>(count, kNone)};
  for (const auto& of : of_tet) parts.of.insert(parts.of.end(), of.begin(), of.end());
  for (std::uint32_t i = 0; i < parts.of.size(); ++i)
    if (parts.first[parts.of[i]] == kNone) parts.first[parts.of[i]] = i;
  if (order == PartOrder::kSorted) return parts;
  std::vector<std::uint32_t> named = parts.first, number(parts.of.size());
  std::ranges::sort(named);
  for (std::uint32_t n = 0; n < named.size(); ++n) number[named[n]] = n;
  for (std::uint32_t& part : parts.of) part = number[parts.first[part]];
  parts.first = std::move(named);
  return parts;
}

}  // namespace

NumberedParts numbered_edges(std::span<const Tet> tets, std::size_t vertices, PartOrder order) {
  std::vector<std::array<std::uint32_t, 6>> of_tet;
  const std::size_t count = edges_of_tets(tets, vertices, of_tet).size();
  return numbered(of_tet, count, order);
}

NumberedParts numbered_faces(std::span<const Tet> tets, std::size_t vertices, PartOrder order) {
  const TetFaces faces = faces_of_tets(tets, vertices);
  return numbered(faces.of_tet, faces.corners.size(), order);
}

SquareMatrix inverse_of(SquareMatrix a) {
  const std::size_t n = a.size();
  for (std::size_t i = 0; i < n; ++i) a[i].resize(2 * n), a[i][n + i] = 1;
  for (std::size_t k = 0; k < n; ++k) {
    const auto pivot = std::max_element(a.begin() + static_cast<std::ptrdiff_t>(k), a.end(),
                                        [&](const auto& x, const auto& y) { return std::abs(x[k]) < std::abs(y[k]); });
    std::swap(*pivot, a[k]);
    const double by = a[k][k];
    for (double& x : a[k]) x /= by;
    for (std::size_t i = 0; i < n; ++i) {
      const double times = a[i][k];
      if (i == k || times == 0) continue;
      for (std::size_t j = k; j < 2 * n; ++j) a[i][j] -= times * a[k][j];
    }
  }
  for (auto& row : a) row.erase(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(n));
  return a;
}

}  // namespace octafront::io
