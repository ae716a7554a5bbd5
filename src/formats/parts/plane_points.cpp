
#include "formats/parts/polygon.h"

#include <utility>

namespace octafront::io {

PlanePoints::PlanePoints(const std::vector<Point2>& points, std::vector<std::uint32_t> members)
    : points_(points), members_(std::move(members)), place_of_(points.size(), kGone) {
  build(root(), true);
  for (std::uint32_t place = 0; place < members_.size(); ++place) place_of_[members_[place]] = place;
}

void PlanePoints::build(Node node, bool by_x) {
  if (node.index >= left_.size()) {
    left_.resize(node.index + 1);
    boxes_.resize(node.index + 1);
  }
  left_[node.index] = node.end - node.begin;
  if (node.begin == node.end) return;
  const auto first = members_.begin() + node.begin, last = members_.begin() + node.end;
  Box box{points_[*first], points_[*first]};
  for (auto at = first; at != last; ++at) {
    const Point2 p = points_[*at];
    box = {{std::min(box.lo.x, p.x), std::min(box.lo.y, p.y)}, {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y)}};
  }
  boxes_[node.index] = box;
  if (node.is_leaf()) return;
  std::nth_element(first, members_.begin() + node.middle(), last, [&](std::uint32_t a, std::uint32_t b) {
    return by_x ? points_[a].x < points_[b].x : points_[a].y < points_[b].y;
  });
  build(node.low(), !by_x);
  build(node.high(), !by_x);
}

void PlanePoints::remove(std::uint32_t point) {
  if (!has(point)) return;
  const std::uint32_t place = std::exchange(place_of_[point], kGone);
  Node node = root();
  for (; !node.is_leaf(); node = place < node.middle() ? node.low() : node.high()) --left_[node.index];
  --left_[node.index];
}

}  // namespace octafront::io
