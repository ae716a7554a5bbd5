#include "layers/columns.h"

#include <algorithm>
#include <utility>

namespace octafront::layers {

double total_height(double growth, std::uint32_t levels) {
  double sum = 0, h = 1;
  for (std::uint32_t k = 0; k < levels; ++k, h *= growth) sum += h;
  return sum;
}

Vec3 Columns::place(const SurfaceMesh& wall, Node node) const {
  const Vec3 p = wall.points[node.column];
  if (node.level == 0) return p;
  return p + step[node.column] * (first[node.column] * part[node.column] * height_of(node.level));
}

TetsOfLayer tets_of_layer(const Columns& columns, const Triangle& triangle, std::uint32_t layer) {
  Triangle t = triangle;
  bool is_odd = false;  // an odd permutation turns a triangle over
  for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 1}})
    if (t[i] > t[j]) std::swap(t[i], t[j]), is_odd = !is_odd;
  std::array<Node, 3> low, high;
  std::array<bool, 3> grows;
  for (int i = 0; i < 3; ++i) {
    grows[i] = columns.count[t[i]] > layer;
    low[i] = {t[i], std::min(columns.count[t[i]], layer)};
    high[i] = {t[i], low[i].level + grows[i]};
  }
  TetsOfLayer made;
  const auto add = [&](Node a, Node b, Node c, Node d) {
    // The wall's normals point away from its layers.
    made.tets[made.count++] = is_odd ? std::array{a, b, c, d} : std::array{b, a, c, d};
  };
  if (grows[2]) add(low[0], low[1], low[2], high[2]);
  if (grows[1]) add(low[0], low[1], high[2], high[1]);
  if (grows[0]) add(low[0], high[1], high[2], high[0]);
  return made;
}

}  // namespace octafront::layers
