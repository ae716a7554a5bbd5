#include "base/geometry/triangle_tree.h"

#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"

#include <algorithm>

namespace octafront {

// Median splits along the longest side of the box of centroids. Equal centroids are ordered by index, so the tree does
// not depend on how the library selects. Both children of a node lie side by side, then what is below the left one,
// then what is below the right one: places follow from numbers of triangles alone, so halves are built in parallel.
struct TriangleTree::Builder {
  struct Entry {
    Vec3 middle;
    std::uint32_t triangle;
  };

  TriangleTree& tree;
  std::span<const Vec3> points;
  std::span<const Triangle> triangles;
  RawVector<Entry> entries;

  // Subtrees with more triangles than this are worth a task of their own.
  static constexpr std::uint32_t kTask = 4096;

  TriangleCorners corners(std::uint32_t t) const {
    return {points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]};
  }

  // The number of nodes above `count` triangles. On one level of the tree only two such counts occur.
  static std::uint32_t node_count(std::uint32_t count) {
    if (count <= kLeafSize) return 1;
    std::uint64_t smaller = count, of_smaller = 1, of_larger = 0, nodes = 1;  // larger = smaller + 1
    for (;;) {
      // Halves of the two counts on the next level: again two that differ by one.
      const std::uint64_t half = smaller / 2;
      const bool is_odd = smaller % 2 == 1;
      const std::uint64_t next_smaller = is_odd ? of_smaller : 2 * of_smaller + of_larger;
      const std::uint64_t next_larger = is_odd ? of_smaller + 2 * of_larger : of_larger;
      smaller = half;
      of_smaller = next_smaller;
      of_larger = next_larger;
      nodes += of_smaller + of_larger;
      if (smaller + 1 <= kLeafSize) break;
      if (smaller <= kLeafSize) {  // only the larger ones have children
        nodes += 2 * of_larger;
        break;
      }
    }
    return static_cast<std::uint32_t>(nodes);
  }

  void make_leaf(std::uint32_t n, std::uint32_t begin, std::uint32_t end) {
    std::sort(entries.begin() + begin, entries.begin() + end,
              [](const Entry& a, const Entry& b) { return a.triangle < b.triangle; });
    Box3 box;
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t t = entries[i].triangle;
      tree.items_[i] = {corners(t), t};
      tree.item_of_triangle_[t] = i;
      box.add(box_of(tree.items_[i].corners));
    }
    tree.nodes_[n] = {box, begin, end - begin};
  }

  // Fills node n and all below it; the nodes below it begin at `child`.
  void split(std::uint32_t n, std::uint32_t child, std::uint32_t begin, std::uint32_t end) {
    if (end - begin <= kLeafSize) {
      make_leaf(n, begin, end);
      return;
    }
    Box3 middles;
    for (std::uint32_t i = begin; i < end; ++i) middles.add(entries[i].middle);
    const Vec3 e = middles.extent();
    const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(entries.begin() + begin, entries.begin() + middle, entries.begin() + end,
                     [axis](const Entry& a, const Entry& b) {
                       const double x = a.middle[axis], y = b.middle[axis];
                       return x != y ? x < y : a.triangle < b.triangle;
                     });
    const std::uint32_t below_left = child + 2, below_right = below_left + node_count(middle - begin) - 1;
    const auto left = [&] { split(child, below_left, begin, middle); };
    const auto right = [&] { split(child + 1, below_right, middle, end); };
    if (end - begin > kTask) {
      parallel_invoke(left, right);
    } else {
      left();
      right();
    }
    Box3 box = tree.nodes_[child].box;
    box.add(tree.nodes_[child + 1].box);
    tree.nodes_[n] = {box, child, 0};
  }
};

TriangleTree::TriangleTree(const SurfaceMesh& surface) : TriangleTree(surface.points, surface.triangles) {}

TriangleTree::TriangleTree(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  if (triangles.empty()) return;
  const auto count = static_cast<std::uint32_t>(triangles.size());
  Builder builder{*this, points, triangles, RawVector<Builder::Entry>(count)};
  parallel_for(count, [&](std::size_t t) {
    const auto triangle = static_cast<std::uint32_t>(t);
    builder.entries[t] = {box_of(builder.corners(triangle)).center(), triangle};
  });
  nodes_.resize(Builder::node_count(count));
  items_.resize(count);
  item_of_triangle_.resize(count);
  builder.split(0, 1, 0, count);
  validate(*this);
}

std::optional<std::string> TriangleTree::first_inconsistency() const {
  const auto name_of = [](std::uint32_t node) { return "node " + std::to_string(node) + " of the tree of triangles"; };
  std::vector<std::uint8_t> reached(nodes_.size(), 0);
  if (!empty()) reached[0] = 1;
  std::vector<std::uint8_t> in_leaf(items_.size(), 0);
  // Children come behind their parents, so each node is judged before those below it.
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    const auto& [box, first, count] = nodes_[n];
    if (reached[n] != 1) return name_of(n) + " is reached " + std::to_string(reached[n]) + " times";
    if (count == 0 && (first <= n || first + 1 >= nodes_.size())) return name_of(n) + " has no children behind it";
    if (count != 0 && first + count > items_.size()) return name_of(n) + " has triangles that there are not";
    Box3 inside;
    for (std::uint32_t child = first; count == 0 && child < first + 2; ++child) {
      inside.add(nodes_[child].box);
      ++reached[child];
    }
    for (std::uint32_t i = first; i < first + count; ++i) {
      for (const Vec3 p : items_[i].corners)
        if (!box.contains(p)) return "triangle " + std::to_string(items_[i].triangle) + " leaves the box of its leaf";
      inside.add(box_of(items_[i].corners));
      ++in_leaf[i];
    }
    if (inside.lo != box.lo || inside.hi != box.hi) return name_of(n) + " has not the box of what is below it";
  }
  for (std::uint32_t i = 0; i < items_.size(); ++i) {
    const std::uint32_t triangle = items_[i].triangle;
    if (in_leaf[i] != 1 || triangle >= items_.size() || item_of_triangle_[triangle] != i)
      return "triangle " + std::to_string(triangle) + " is not where the tree looks for it";
  }
  return std::nullopt;
}

// Goes down from the root by keys of boxes (0 at the nearest), always into the nearer child first; calls visit(leaf),
// which may lower the limit, for all leaves whose key is below it by then.
template <class Key, class Visit>
void TriangleTree::descend(const double& limit, Key&& key, Visit&& visit) const {
  if (empty() || key(nodes_[0].box) >= limit) return;
  std::array<std::uint32_t, kMaxDepth> waiting;
  std::array<double, kMaxDepth> waiting_key;
  int depth = 0;
  const Node* node = nodes_.data();
  for (;;) {
    if (node->count == 0) {
      const double left = key(nodes_[node->first].box), right = key(nodes_[node->first + 1].box);
      const std::uint32_t nearer = left <= right ? node->first : node->first + 1;
      const double far_key = left <= right ? right : left;
      if (far_key < limit) {
        waiting[depth] = 2 * node->first + 1 - nearer;
        waiting_key[depth++] = far_key;
      }
      if (std::min(left, right) < limit) {
        node = &nodes_[nearer];
        continue;
      }
    } else {
      visit(*node);
    }
    do {
      if (depth == 0) return;
      --depth;
    } while (waiting_key[depth] >= limit);
    node = &nodes_[waiting[depth]];
  }
}

TriangleTree::Nearest TriangleTree::nearest(Vec3 p, double limit_squared) const {
  Nearest best;
  best.squared_distance = limit_squared;
  descend(
      best.squared_distance, [p](const Box3& box) { return squared_distance(p, box); },
      [&](const Node& leaf) {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
          // Boxes cost a third of what triangles do.
          constexpr double kRounding = 1 - 1e-12;
          if (kRounding * squared_distance(p, box_of(items_[i].corners)) > best.squared_distance) continue;
          const auto& [a, b, c] = items_[i].corners;
          const Vec3 q = closest_point_on_triangle(p, a, b, c);
          const double d = squared_distance(p, q);
          if (d < best.squared_distance) best = {q, items_[i].triangle, d};
        }
      });
  return best;
}

bool TriangleTree::is_within(Vec3 p, double distance) const {
  const double squared = distance * distance;
  double limit = distance > 0 ? squared : 0;
  descend(
      limit, [p](const Box3& box) { return squared_distance(p, box); },
      [&](const Node& leaf) {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
          const auto& [a, b, c] = items_[i].corners;
          if (squared_distance(p, closest_point_on_triangle(p, a, b, c)) < squared) limit = 0;
        }
      });
  return distance > 0 && limit == 0;
}

namespace {

// Volumes of the ray with the edges have one sign where it passes through. Each edge gives its two triangles the same
// number up to sign, so that no ray slips between them (S. Woop, C. Benthin, I. Wald 2013, without their shear).
double ray_parameter(Vec3 origin, Vec3 direction, const TriangleCorners& t) {
  const Vec3 a = t[0] - origin, b = t[1] - origin, c = t[2] - origin;
  const double u = dot(direction, cross(b, c)), v = dot(direction, cross(c, a)), w = dot(direction, cross(a, b));
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return -1;
  const double sum = u + v + w;
  if (sum == 0) return -1;
  return dot(direction, (a * u + b * v + c * w) / sum) / squared_length(direction);
}

struct Slabs {
  Vec3 origin, inverse;

  // Where the ray enters the box; beyond t_max if it does not meet it before.
  double entry(const Box3& box, double t_max) const {
    // Rounding may move the ends of the interval by a few units in the last place.
    constexpr double kGrow = 1 + 4 * std::numeric_limits<double>::epsilon();
    double from = 0, to = t_max;
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(inverse[axis])) {
        if (origin[axis] < box.lo[axis] || origin[axis] > box.hi[axis]) return TriangleTree::kFar;
        continue;
      }
      const double lo = (box.lo[axis] - origin[axis]) * inverse[axis];
      const double hi = (box.hi[axis] - origin[axis]) * inverse[axis];
      from = std::max(from, std::min(lo, hi));
      to = std::min(to, std::max(lo, hi) * kGrow);
    }
    return from <= to ? from : TriangleTree::kFar;
  }
};

}  // namespace

TriangleTree::RayHit TriangleTree::first_hit(Vec3 origin, Vec3 direction, double t_max) const {
  RayHit best{t_max, kNone};
  const Slabs slabs{origin, {1 / direction.x, 1 / direction.y, 1 / direction.z}};
  // Beyond the best hit by a rounding, so that ties are seen and go to the smaller index.
  double limit = std::nextafter(t_max, kFar);
  descend(
      limit, [&](const Box3& box) { return slabs.entry(box, limit); },
      [&](const Node& leaf) {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
          const double t = ray_parameter(origin, direction, items_[i].corners);
          if (t < 0 || t > best.t || (t == best.t && items_[i].triangle > best.triangle)) continue;
          best = {t, items_[i].triangle};
          limit = std::nextafter(t, kFar);
        }
      });
  return best;
}

namespace {

// Orientation of (a, b, p) seen along z, where p is moved by (e, e^2) for an infinitely small e: never 0 unless a and b
// coincide in this view. (Simulation of simplicity; H. Edelsbrunner, E. P. Muecke 1990.)
int moved_orientation(Vec3 a, Vec3 b, Vec3 p) {
  const int s = orient2d(a.x, a.y, b.x, b.y, p.x, p.y);
  if (s != 0) return s;
  if (a.y != b.y) return a.y > b.y ? 1 : -1;
  return detail::sign(b.x - a.x);
}

// Orientation, seen from above, of the triangle if the line through p along z, moved as above, passes through it; else
// 0. A triangle parallel to z is never met.
int crossing(const TriangleCorners& t, Vec3 p) {
  const int first = moved_orientation(t[0], t[1], p);
  return first == moved_orientation(t[1], t[2], p) && first == moved_orientation(t[2], t[0], p) ? first : 0;
}

}  // namespace

TriangleTree::Crossings TriangleTree::crossings(Vec3 p) const {
  Crossings found;
  if (empty() || !box().contains(p)) return found;
  // Toward the nearer end of the box.
  const bool up = p.z > box().center().z;
  const auto on_ray = [&](const Box3& b) {
    return b.lo.x <= p.x && p.x <= b.hi.x && b.lo.y <= p.y && p.y <= b.hi.y && (up ? b.hi.z >= p.z : b.lo.z <= p.z);
  };
  for_each_leaf(on_ray, [&](const Item& item) {
    const TriangleCorners& t = item.corners;
    const Box3 b = box_of(t);
    if (found.on_surface || !on_ray(b)) return;
    if (b.contains(p) && segment_triangle_hit(p, p, t)) found.on_surface = true;
    const int turn = crossing(t, p);
    if (turn == 0) return;
    const int side = orient3d(t[0], t[1], t[2], p);
    if (turn * side != (up ? -1 : 1)) return;
    ++found.count;
    found.winding += up ? turn : -turn;
  });
  return found;
}

TriangleTree::Location TriangleTree::locate(Vec3 p) const {
  const Crossings c = crossings(p);
  if (c.on_surface) return Location::kOnSurface;
  return c.count % 2 == 1 ? Location::kInside : Location::kOutside;
}

int TriangleTree::winding_number(Vec3 p) const {
  return crossings(p).winding;
}

TriangleTree tree_of_points(std::span<const Vec3> points, std::span<const VertexIndex> list) {
  std::vector<Triangle> flat;
  for (const VertexIndex v : list) flat.push_back({v, v, v});
  return {points, flat};
}

TriangleTree tree_of_segments(std::span<const Vec3> points, std::span<const Edge> segments) {
  std::vector<Triangle> flat;
  for (const auto& [a, b] : segments) flat.push_back({a, b, b});
  return {points, flat};
}

}  // namespace octafront
