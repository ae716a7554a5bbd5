#include "base/core/elementary.h"
#include "soup/mend/caps.h"
#include "soup/mend/flat_rim.h"

#include <algorithm>
#include <cmath>

namespace octafront::mend {
namespace {

/// Of the rim's diameter: what stands higher over it is not a hill but something else.
constexpr double kMostHill = 0.5;
/// Outlines of more corners have no best triangulation (caps.h), and are simplified more.
constexpr std::size_t kMostCorners = 256;
/// How often the reach of the simplification is doubled.
constexpr int kSimplifications = 3;

/// Of the reach, what a long edge is, and how straight the rim is along one.
constexpr double kSpacing = 4, kStraight = 2e-3;

double distance(Flat a, Flat b) {
  return elementary::hypot(a.x - b.x, a.y - b.y);
}

double distance_to_chord(Flat p, Flat a, Flat b) {
  const double ux = b.x - a.x, uy = b.y - a.y, square = ux * ux + uy * uy;
  const double along = square > 0 ? std::clamp(((p.x - a.x) * ux + (p.y - a.y) * uy) / square, 0.0, 1.0) : 0;
  return elementary::hypot(p.x - a.x - along * ux, p.y - a.y - along * uy);
}

/// A rim seen along a direction.
class FlatRim {
 public:
  FlatRim(std::span<const Vec3> rim, Vec3 away) : frame_(frame_at({}, away)) {
    for (const Vec3 p : rim) points_.push_back(seen_along(frame_, p));
  }

  /// Corners of the rim such that it lies within the reach of the polygon through them (D. Douglas and T. Peucker,
  /// 1973), ascending. Edges that are long against the reach stay where the rim is straight only: walls between them
  /// and a rim with teeth would be fans of triangles that fold on each other.
  std::vector<std::uint32_t> outline(double reach) const {
    const auto n = static_cast<std::uint32_t>(points_.size());
    const std::uint32_t from = farthest_from(points_[farthest_from(points_[0])]);
    const std::uint32_t to = farthest_from(points_[from]);
    std::vector<char> kept(n, 0);
    kept[from] = kept[to] = 1;
    std::vector<std::array<std::uint32_t, 2>> open{{std::min(from, to), std::max(from, to)},
                                                   {std::max(from, to), n + std::min(from, to)}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      const double room = distance(points_[i % n], points_[j % n]) > kSpacing * reach ? kStraight * reach : reach;
      double most = room;
      std::uint32_t far = i;
      for (std::uint32_t k = i + 1; k < j; ++k) {
        const double d = distance_to_chord(points_[k % n], points_[i % n], points_[j % n]);
        if (d > most) most = d, far = k;
      }
      if (far == i) continue;
      kept[far % n] = 1;
      open.push_back({i, far});
      open.push_back({far, j});
    }
    std::vector<std::uint32_t> corners;
    for (std::uint32_t i = 0; i < n; ++i)
      if (kept[i]) corners.push_back(i);
    return corners;
  }

  bool is_simple(const std::vector<std::uint32_t>& corners) const {
    const std::size_t n = corners.size();
    if (n < 3) return false;
    const auto at = [&](std::size_t i) { return points_[corners[i % n]]; };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        if (at(i) == at(j)) return false;
        const bool are_next = j == i + 1 || (i == 0 && j == n - 1);
        if (!are_next && meet(at(i), at(i + 1), at(j), at(j + 1))) return false;
      }
    return true;
  }

  bool is_over(Vec3 p, const std::vector<std::uint32_t>& corners) const {
    return is_inside(
        corners.size(), [&](std::size_t i) { return points_[corners[i]]; }, seen_along(frame_, p));
  }

 private:
  static bool meet(Flat a, Flat b, Flat c, Flat d) {
    return turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0;
  }

  std::uint32_t farthest_from(Flat p) const {
    return static_cast<std::uint32_t>(
        std::ranges::max_element(points_, [&](Flat a, Flat b) { return distance(a, p) < distance(b, p); }) -
        points_.begin());
  }

  Frame frame_;
  std::vector<Flat> points_;
};

double height_over(const FlatRim& flat, const std::vector<std::uint32_t>& outline, std::span<const Vec3> around,
                   Vec3 away, double least) {
  double height = least;
  for (const Vec3 p : around)
    if (dot(p, away) > height && flat.is_over(p, outline)) height = dot(p, away);
  return height;
}

/// Between two corners of the outline, rim[i] and rim[j] (j > i, and beyond the end from the start again): each edge of
/// the rim gets a triangle to the base's corner that is nearer along it.
void add_wall(std::span<const Vec3> rim, std::array<std::uint32_t, 2> ends, std::array<std::uint32_t, 2> base,
              Cap& cap) {
  const auto n = static_cast<std::uint32_t>(rim.size());
  std::vector<double> along{0};
  for (std::uint32_t k = ends[0]; k < ends[1]; ++k)
    along.push_back(along.back() + distance(rim[k % n], rim[(k + 1) % n]));
  std::uint32_t k = ends[0];
  for (; k < ends[1] && 2 * along[k + 1 - ends[0]] <= along.back(); ++k) cap.push_back({k % n, (k + 1) % n, base[0]});
  cap.push_back({base[0], k % n, base[1]});
  for (; k < ends[1]; ++k) cap.push_back({k % n, (k + 1) % n, base[1]});
}

}  // namespace

FairCap cap_with_base(std::span<const Vec3> rim, Vec3 away, std::span<const Vec3> around) {
  Box3 box;
  double top = -HUGE_VAL;
  for (const Vec3 p : rim) {
    box.add(p);
    top = std::max(top, dot(p, away));
  }
  const FlatRim flat(rim, away);
  const double thickness = kBaseThickness * box.diagonal();
  double reach = 0.5 * thickness;
  std::vector<std::uint32_t> outline = flat.outline(reach);
  for (int i = 0; i < kSimplifications && (outline.size() > kMostCorners || !flat.is_simple(outline)); ++i)
    outline = flat.outline(reach *= 2);
  if (outline.size() > kMostCorners || !flat.is_simple(outline)) return {};
  const double highest = height_over(flat, outline, around, away, top);
  if (highest - top > kMostHill * box.diagonal()) return {};
  FairCap made;
  for (const std::uint32_t i : outline) made.inner.push_back(rim[i] + (highest + thickness - dot(rim[i], away)) * away);
  const auto n = static_cast<std::uint32_t>(rim.size()), corners = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t c = 0; c < corners; ++c) {
    const std::uint32_t next = (c + 1) % corners;
    add_wall(rim, {outline[c], outline[next] + (next == 0 ? n : 0)}, {n + c, n + next}, made.triangles);
  }
  const auto is_free = [](std::uint32_t, std::uint32_t) { return false; };
  for (const auto& [a, b, c] : triangulate_polygon(made.inner, std::vector<Vec3>(corners), is_free, Least::kArea))
    made.triangles.push_back({n + a, n + b, n + c});
  return made;
}

}  // namespace octafront::mend
