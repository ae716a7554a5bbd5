#include "formats/parts/polygon.h"

#include <cmath>
#include <deque>
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

// Ear clipping: G. H. Meisters, "Polygons have ears", 1975; the treatment of doubled vertices follows M. Held, "FIST:
// fast industrial-strength triangulation of polygons", 2001.

namespace {

/// Twice the vector area (Newell's sum), measured from the first corner so that distant models lose no digits.
Vec3 vector_area(std::span<const Vec3> corners) {
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  return sum;
}

/// Along the axis that the polygon faces most, such that it turns counter-clockwise.
std::vector<Point2> flattened(std::span<const Vec3> corners) {
  const Vec3 n = vector_area(corners);
  int axis = 2;
  if (std::abs(n.x) > std::abs(n.y) && std::abs(n.x) > std::abs(n.z)) {
    axis = 0;
  } else if (std::abs(n.y) > std::abs(n.z)) {
    axis = 1;
  }
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (n[axis] < 0) std::swap(u, v);
  std::vector<Point2> flat;
  flat.reserve(corners.size());
  for (const Vec3& p : corners) flat.push_back({p[u], p[v]});
  return flat;
}

/// True if, seen from corner 0, the others follow each other counter-clockwise within less than half a turn.
bool fan_is_strict(const std::vector<Point2>& p) {
  for (std::size_t i = 1; i + 1 < p.size(); ++i)
    if (turn(p[0], p[i], p[i + 1]) <= 0 || turn(p[0], p[1], p[i + 1]) <= 0) return false;
  return true;
}

class EarClipper {
 public:
  explicit EarClipper(const std::vector<Point2>& points)
      : p_(points),
        next_(neighbours(points.size(), 1)),
        prev_(neighbours(points.size(), points.size() - 1)),
        alive_(points.size(), true),
        doubled_(doubled_corners()),
        blockers_(points, first_blockers()) {}

  bool run(std::vector<std::array<std::uint32_t, 3>>& out, const RunContext& context) {
    auto left = static_cast<std::uint32_t>(p_.size());
    std::uint32_t at = 0;
    bool saw_all = false;
    for (std::uint32_t i = 0; i < left; ++i) waiting_.push_back(i);
    for (std::uint64_t looks = 0; left > 3; ++looks) {
      if (looks % kLooksPerCheck == 0) context.check();
      if (waiting_.empty()) {
        // In a simple polygon only the neighbours of a clipped ear can become ears. This second look is a safeguard.
        if (saw_all) break;
        saw_all = true;
        waiting_ = remaining(at);
      }
      const std::uint32_t i = waiting_.front();
      waiting_.pop_front();
      if (!alive_[i] || !is_ear(i)) continue;
      out.push_back({prev_[i], i, next_[i]});
      at = next_[i];
      clip(i);
      --left;
      saw_all = false;
    }
    const bool simple = left == 3;
    for (; left >= 3; --left) {
      out.push_back({prev_[at], at, next_[at]});
      clip(at);
      at = next_[at];
    }
    return simple;
  }

 private:
  static constexpr std::uint64_t kLooksPerCheck = 256;

  int turn_at(std::uint32_t i) const { return turn(p_[prev_[i]], p_[i], p_[next_[i]]); }

  static std::vector<std::uint32_t> neighbours(std::size_t corners, std::size_t step) {
    std::vector<std::uint32_t> all(corners);
    for (std::size_t i = 0; i < corners; ++i) all[i] = static_cast<std::uint32_t>((i + step) % corners);
    return all;
  }

  /// Corners at one place, which only polygons with holes cut open have.
  std::vector<bool> doubled_corners() const {
    std::vector<std::uint32_t> order(p_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return p_[a].x != p_[b].x ? p_[a].x < p_[b].x : p_[a].y < p_[b].y;
    });
    std::vector<bool> doubled(p_.size(), false);
    for (std::size_t k = 1; k < order.size(); ++k)
      if (p_[order[k - 1]] == p_[order[k]]) doubled[order[k - 1]] = doubled[order[k]] = true;
    return doubled;
  }

  /// A corner that turns left stays one until it is clipped, and cannot lie in an ear: only the others are looked at.
  bool is_blocker(std::uint32_t k) const { return doubled_[k] || turn_at(k) <= 0; }

  std::vector<std::uint32_t> first_blockers() const {
    std::vector<std::uint32_t> blockers;
    for (std::uint32_t i = 0; i < p_.size(); ++i)
      if (is_blocker(i)) blockers.push_back(i);
    return blockers;
  }

  bool is_ear(std::uint32_t i) const {
    const std::uint32_t a = prev_[i], c = next_[i];
    const Point2 pa = p_[a], pb = p_[i], pc = p_[c];
    if (turn(pa, pb, pc) <= 0) return false;
    const auto is_in_the_way = [&](std::uint32_t k) { return k != a && k != i && k != c && blocks(k, pa, pb, pc); };
    return !blockers_.any_in({pa, pb, pc}, is_in_the_way) && !enters(a, pa, pb, pc) && !enters(c, pc, pa, pb);
  }

  /// Whether corner k lies in the closed triangle, or, if it lies at one of its corners, leads into it.
  bool blocks(std::uint32_t k, Point2 a, Point2 b, Point2 c) const {
    const Point2 q = p_[k];
    if (q.x < std::min({a.x, b.x, c.x}) || q.x > std::max({a.x, b.x, c.x}) || q.y < std::min({a.y, b.y, c.y}) ||
        q.y > std::max({a.y, b.y, c.y}))
      return false;
    if (q == a) return enters(k, a, b, c);
    if (q == b) return enters(k, b, c, a);
    if (q == c) return enters(k, c, a, b);
    return turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0;
  }

  /// Whether a side of the polygon at corner k, which lies at `apex`, runs into the wedge (apex; from, to).
  bool enters(std::uint32_t k, Point2 apex, Point2 from, Point2 to) const {
    for (const std::uint32_t m : {prev_[k], next_[k]})
      if (turn(apex, from, p_[m]) > 0 && turn(apex, p_[m], to) > 0) return true;
    return false;
  }

  void clip(std::uint32_t i) {
    alive_[i] = false;
    next_[prev_[i]] = next_[i];
    prev_[next_[i]] = prev_[i];
    blockers_.remove(i);
    for (const std::uint32_t k : {prev_[i], next_[i]}) {
      waiting_.push_back(k);
      if (!is_blocker(k)) blockers_.remove(k);
    }
  }

  std::deque<std::uint32_t> remaining(std::uint32_t from) const {
    std::deque<std::uint32_t> all{from};
    for (std::uint32_t i = next_[from]; i != from; i = next_[i]) all.push_back(i);
    return all;
  }

  const std::vector<Point2>& p_;
  std::vector<std::uint32_t> next_, prev_;
  std::vector<bool> alive_, doubled_;
  PlanePoints blockers_;
  std::deque<std::uint32_t> waiting_;  ///< corners to look at, in this order: clipping spreads over the polygon
};

}  // namespace

bool fans_out(std::span<const Vec3> corners) {
  return fan_is_strict(flattened(corners));
}

bool triangulate_polygon(std::span<const Vec3> corners, std::vector<std::array<std::uint32_t, 3>>& out,
                         const RunContext& context) {
  std::vector<std::uint32_t> kept;
  std::vector<Vec3> points;
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    if (corners[i] == corners[i == 0 ? corners.size() - 1 : i - 1]) continue;
    kept.push_back(i);
    points.push_back(corners[i]);
  }
  if (kept.size() < 3) return true;
  const std::vector<Point2> flat = flattened(points);
  const std::size_t first = out.size();
  bool simple = true;
  if (kept.size() == 3 || fan_is_strict(flat)) {
    for (std::uint32_t i = 1; i + 1 < kept.size(); ++i) out.push_back({0, i, i + 1});
  } else {
    simple = EarClipper(flat).run(out, context);
  }
  for (std::size_t t = first; t < out.size(); ++t)
    for (std::uint32_t& corner : out[t]) corner = kept[corner];
  return simple;
}

}  // namespace octafront::io
