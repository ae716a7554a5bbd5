#include "surface/lines/line_sizes.h"
#include "surface/lines/point_grid.h"

#include <algorithm>
#include <tuple>

namespace octafront::surface {

std::vector<Vec3> thinned(const SizeField& sizes, const std::vector<Vec3>& places) {
  if (places.empty()) return {};
  std::vector<Vec3> kept;
  PointGrid<NoData> grid(places.front());
  for (const Vec3 p : places) {
    const double h = sizes.at(p);
    bool is_new = true;
    grid.for_each_near(p, h, 0.5, [&](const auto&) { is_new = false; });
    if (!is_new) continue;
    kept.push_back(p);
    grid.add(p, h);
  }
  return kept;
}

std::vector<PointSize> smaller_at(const std::vector<Vec3>& places, double part, const SizeField& sizes) {
  std::vector<PointSize> wanted;
  for (const Vec3 p : thinned(sizes, places)) wanted.push_back({p, part * sizes.at(p)});
  return wanted;
}

std::vector<PointSize> smallest_ones(std::vector<PointSize> places) {
  if (places.empty()) return places;
  std::sort(places.begin(), places.end(), [](const PointSize& a, const PointSize& b) {
    return std::tie(a.size, a.p.x, a.p.y, a.p.z) < std::tie(b.size, b.p.x, b.p.y, b.p.z);
  });
  PointGrid<NoData> grid(places.front().p);
  std::erase_if(places, [&](const PointSize& s) {
    bool is_new = true;
    grid.for_each_near(s.p, s.size, 1, [&](const auto&) { is_new = false; });
    if (is_new) grid.add(s.p, s.size);
    return !is_new;
  });
  return places;
}

}  // namespace octafront::surface
