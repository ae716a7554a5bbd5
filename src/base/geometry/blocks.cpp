#include "base/geometry/blocks.h"

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
    nodes_.emplace_back();
    divide(Parts(codes_.size(), kPartsAtOnce,
                 [this](std::size_t i, const auto& add) { add(part(codes_[i], 0), static_cast<std::uint32_t>(i)); }),
           0, 0, 0, kPartsAtOnce);
    parallel_for(codes_.size(), [this](std::size_t i) { cells_.of[i] = cell_of(codes_[i]); });
    return std::move(cells_);
  }

 private:
  using Parts = Buckets<>;
  /// For each part of a cell the cell that it belongs to, or kDivided and the
  /// node that divides it further.
  using Node = std::array<std::uint32_t, kPartsAtOnce>;
  static constexpr std::uint32_t kDivided = 1u << 31;

  static std::size_t part(std::uint64_t code, int depth) {
    return code >> (kBitsOfCode - kBitsAtOnce - depth) & (kPartsAtOnce - 1);
  }

  /// Parts begin ... end - 1 of a cell of this depth, which lie side by side, are a cell or are halved.
  void divide(const Parts& parts, std::size_t node, int depth, std::size_t begin, std::size_t end) {
    const std::size_t first = parts.first(begin), last = end == parts.size() ? parts.items() : parts.first(end);
    const bool at_bottom = end - begin == 1 && depth + kBitsAtOnce == kBitsOfCode;
    if (first == last) return;
    if (last - first <= most_ || at_bottom) {
      for (std::size_t p = begin; p < end; ++p) nodes_[node][p] = cells_.count;
      ++cells_.count;
    } else if (end - begin > 1) {
      const std::size_t middle = begin + (end - begin) / 2;
      divide(parts, node, depth, begin, middle);
      divide(parts, node, depth, middle, end);
    } else {
      const std::span<const std::uint32_t> items = parts[begin];
      const int below = depth + kBitsAtOnce;
      nodes_[node][begin] = kDivided | static_cast<std::uint32_t>(nodes_.size());
      nodes_.emplace_back();
      divide(Parts(items.size(), kPartsAtOnce,
                   [&](std::size_t k, const auto& add) { add(part(codes_[items[k]], below), items[k]); }),
             nodes_.size() - 1, below, 0, kPartsAtOnce);
    }
  }

  std::uint32_t cell_of(std::uint64_t code) const {
    std::uint32_t found = kDivided;
    for (int depth = 0; (found & kDivided) != 0; depth += kBitsAtOnce)
      found = nodes_[found & ~kDivided][part(code, depth)];
    return found;
  }

  std::vector<std::uint64_t> codes_;
  std::size_t most_;
  std::vector<Node> nodes_;  ///< the first one divides the cube
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
