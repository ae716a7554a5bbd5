#include "base/blocks/blocks.h"

#include <array>

namespace octafront {

namespace {

constexpr int kBitsOfCode = 63;
constexpr int kBitsAtOnce = 9;  ///< of the code: halvings by one sweep over the points of a cell
constexpr std::size_t kPartsAtOnce = std::size_t{1} << kBitsAtOnce;

class CellDivider {
 public:
  CellDivider(std::span<const Vec3> points, const Cube& cube, std::size_t most) : codes_(points.size()), most_(most) {
    cells_.of.resize(points.size());
    parallel_for(points.size(), [&](std::size_t i) { codes_[i] = curve_code(points[i], cube); });
  }

  Cells divide() {
    if (codes_.size() <= most_) {
      cells_.count = codes_.empty() ? 0 : 1;
      return std::move(cells_);
    }
    divide(Parts(codes_.size(), kPartsAtOnce,
                 [this](std::size_t i, const auto& add) { add(part(i, 0), static_cast<std::uint32_t>(i)); }),
           0, 0, kPartsAtOnce);
    return std::move(cells_);
  }

 private:
  using Parts = Buckets<>;

  std::size_t part(std::size_t point, int depth) const {
    return codes_[point] >> (kBitsOfCode - kBitsAtOnce - depth) & (kPartsAtOnce - 1);
  }

  /// Parts begin ... end - 1 of a cell of this depth, which lie side by side, are a cell or are halved.
  void divide(const Parts& parts, int depth, std::size_t begin, std::size_t end) {
    const std::size_t first = parts.first(begin), last = end == parts.size() ? parts.items() : parts.first(end);
    const bool at_bottom = end - begin == 1 && depth + kBitsAtOnce == kBitsOfCode;
    if (first == last) return;
    if (last - first <= most_ || at_bottom) {
      for (std::size_t p = begin; p < end; ++p)
        for (const std::uint32_t i : parts[p]) cells_.of[i] = cells_.count;
      ++cells_.count;
    } else if (end - begin > 1) {
      const std::size_t middle = begin + (end - begin) / 2;
      divide(parts, depth, begin, middle);
      divide(parts, depth, middle, end);
    } else {
      const std::span<const std::uint32_t> items = parts[begin];
      const int below = depth + kBitsAtOnce;
      divide(Parts(items.size(), kPartsAtOnce,
                   [&](std::size_t k, const auto& add) { add(part(items[k], below), items[k]); }),
             below, 0, kPartsAtOnce);
    }
  }

  std::vector<std::uint64_t> codes_;
  std::size_t most_;
  Cells cells_;
};

}  // namespace

Cube cube_of_stage(const Box3& box, int stage) {
  constexpr std::array<double, kCellStages> kLower{0, 0.4, 0.8, 0.2};
  if (box.empty()) return {{}, 0};
  const Vec3 extent = box.extent();
  const double side = std::max({extent.x, extent.y, extent.z}), lower = kLower[stage] * side;
  return {box.lo - Vec3{lower, lower, lower}, stage == 0 ? side : 2 * side};
}

Cells cells_of(std::span<const Vec3> points, const Cube& cube, std::size_t most) {
  return CellDivider(points, cube, most).divide();
}

}  // namespace octafront
