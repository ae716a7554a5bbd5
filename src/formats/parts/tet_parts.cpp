#include "formats/parts/tet_parts.h"

#include "base/core/groups.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octafront::io {
namespace {

struct EdgeUse {
  VertexIndex high;
  std::uint32_t edge;
  auto operator<=>(const EdgeUse&) const = default;
};

/// `of` says of each the first that is the same, `sorted` these in the order of their vertices.
NumberedParts count_through(std::vector<std::uint32_t> of, std::vector<std::uint32_t> sorted, PartOrder order) {
  if (order == PartOrder::kAsNamed) std::ranges::sort(sorted);
  std::vector<std::uint32_t> number(of.size());
  for (std::uint32_t n = 0; n < sorted.size(); ++n) number[sorted[n]] = n;
  for (std::uint32_t& part : of) part = number[part];
  return {std::move(of), std::move(sorted)};
}

}  // namespace

NumberedParts edges_of_tets(std::span<const Tet> tets, std::size_t vertices, PartOrder order) {
  Groups<EdgeUse, std::uint64_t> at_low(vertices, [&](const auto& add) {
    for (TetIndex t = 0; t < tets.size(); ++t)
      for (std::uint32_t e = 0; e < 6; ++e) {
        const auto [low, high] = std::minmax(tets[t][static_cast<std::size_t>(kTetEdges[e][0])],
                                             tets[t][static_cast<std::size_t>(kTetEdges[e][1])]);
        add(low, EdgeUse{high, 6 * t + e});
      }
  });
  std::vector<std::uint32_t> of(6 * tets.size()), sorted;
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::span<EdgeUse> uses = at_low[v];
    std::ranges::sort(uses);
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (i == 0 || uses[i].high != uses[i - 1].high) sorted.push_back(uses[i].edge);
      of[uses[i].edge] = sorted.back();
    }
  }
  return count_through(std::move(of), std::move(sorted), order);
}

NumberedParts faces_of_tets(std::span<const Tet> tets, std::size_t vertices, PartOrder order) {
  const FaceTable table(vertices, [&](const auto& add) {
    for (TetIndex t = 0; t < tets.size(); ++t)
      for (std::uint32_t f = 0; f < 4; ++f) add(face_of(tets[t], static_cast<int>(f)), 4 * t + f);
  });
  std::vector<std::uint32_t> of(4 * tets.size()), sorted;
  table.for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> same) {
    sorted.push_back(same.front().face);
    for (const FaceTable::Entry& entry : same) of[entry.face] = sorted.back();
  });
  return count_through(std::move(of), std::move(sorted), order);
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
