#include "base/geometry/plane_mesh.h"

#include <octafront/error.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/core.h>

namespace octafront::arrangement {
namespace {

constexpr int after(int i) {
  return i == 2 ? 0 : i + 1;
}
constexpr int before(int i) {
  return i == 0 ? 2 : i - 1;
}

/// A border that runs to and fro is none.
void toggle(PlaneMesh::Border& border, std::uint32_t face) {
  const auto at = std::lower_bound(border.begin(), border.end(), face);
  if (at != border.end() && *at == face) {
    border.erase(at);
  } else {
    border.insert(at, face);
  }
}

/// Cotangent of the angle at `apex`.
double cotangent(Vec3 apex, Vec3 p, Vec3 q) {
  const Vec3 u = p - apex, v = q - apex;
  return dot(u, v) / length(cross(u, v));
}

}  // namespace

void CrossingBudget::take() {
  if (taken_++ < most_) return;
  throw InputError(
      fmt::format("more than {} points lie on three faces or more at once: where all faces cross all others there is "
                  "no surface to keep",
                  most_));
}

PlaneMesh::PlaneMesh(const Homogeneous& plane, int axis, const Box3& box, CrossingBudget* budget)
    : plane_(plane), axis_(axis), budget_(budget) {
  const int u = after(axis), v = after(u);
  const Vec3 center = box.center(), extent = box.extent();
  // Far enough that every point lies well inside, also where extents vanish.
  const double far = 8 * std::max({extent[u], extent[v], std::abs(center[u]), std::abs(center[v]), 1e-30});
  const auto corner = [&](double du, double dv) {
    Vec3 p = center;
    p[u] += du * far;
    p[v] += dv * far;
    return new_node({p});
  };
  corner(-1, -1);
  corner(1, -1);
  corner(0, 1);
  triangles_.push_back({{0, 1, 2}, {kNone, kNone, kNone}, {kNone, kNone, kNone}});
}

PlaneMesh::Node PlaneMesh::new_node(const Place& p) {
  place_.push_back(p);
  triangle_at_.push_back(0);
  return static_cast<Node>(place_.size() - 1);
}

int PlaneMesh::corner_of(std::uint32_t t, Node n) const {
  const auto& v = triangles_[t].v;
  return v[0] == n ? 0 : v[1] == n ? 1 : 2;
}

int PlaneMesh::corner_facing(std::uint32_t t, std::uint32_t neighbour) const {
  const auto& n = triangles_[t].next;
  return n[0] == neighbour ? 0 : n[1] == neighbour ? 1 : 2;
}

void PlaneMesh::relink(std::uint32_t t, std::uint32_t from, std::uint32_t to) {
  if (t != kNone) triangles_[t].next[corner_facing(t, from)] = to;
}

PlaneMesh::Side PlaneMesh::locate(const Place& p, int& zeros) {
  std::uint32_t t = last_;
  for (;;) {
    const Triangle3& at = triangles_[t];
    // A random first edge keeps the walk from going in circles.
    const int start = static_cast<int>(random_.below(3));
    std::uint32_t further = kNone;
    std::array<int, 3> side{};
    for (int k = 0; k < 3 && further == kNone; ++k) {
      const int i = (start + k) % 3;
      side[i] = orient_along(axis_, place_[at.v[after(i)]], place_[at.v[before(i)]], p);
      if (side[i] < 0) further = at.next[i];
    }
    if (further != kNone) {
      t = further;
      continue;
    }
    last_ = t;
    zeros = (side[0] == 0) + (side[1] == 0) + (side[2] == 0);
    // On one edge: that edge. On two: the corner between them, opposite the third.
    for (int i = 0; i < 3; ++i)
      if ((side[i] == 0) == (zeros == 1)) return {t, i};
    return {t, 0};
  }
}

PlaneMesh::Node PlaneMesh::add_point(const Place& p) {
  int zeros = 0;
  const Side at = locate(p, zeros);
  if (zeros == 2) return triangles_[at.triangle].v[at.corner];
  const Node x = new_node(p);
  if (zeros == 1) {
    split_edge(at, x);
  } else {
    split_triangle(at.triangle, x);
  }
  legalize(x);
  return x;
}

void PlaneMesh::split_triangle(std::uint32_t t, Node x) {
  const Triangle3 old = triangles_[t];
  const auto second = static_cast<std::uint32_t>(triangles_.size()), third = second + 1;
  const auto [a, b, c] = old.v;
  triangles_[t] = {{a, b, x}, {second, third, old.next[2]}, {kNone, kNone, old.mark[2]}};
  triangles_.push_back({{b, c, x}, {third, t, old.next[0]}, {kNone, kNone, old.mark[0]}});
  triangles_.push_back({{c, a, x}, {t, second, old.next[1]}, {kNone, kNone, old.mark[1]}});
  relink(old.next[0], t, second);
  relink(old.next[1], t, third);
  triangle_at_[a] = triangle_at_[b] = triangle_at_[x] = t;
  triangle_at_[c] = second;
}

void PlaneMesh::split_edge(Side side, Node x) {
  const std::uint32_t t = side.triangle, u = triangles_[t].next[side.corner];
  const int i = side.corner, j = corner_facing(u, t);
  const Triangle3 one = triangles_[t], two = triangles_[u];
  const Node a = one.v[i], b = one.v[after(i)], c = one.v[before(i)], d = two.v[j];
  const std::uint32_t m = one.mark[i];
  const auto t1 = static_cast<std::uint32_t>(triangles_.size()), u1 = t1 + 1;
  triangles_[t] = {{a, b, x}, {u1, t1, one.next[before(i)]}, {m, kNone, one.mark[before(i)]}};
  triangles_.push_back({{a, x, c}, {u, one.next[after(i)], t}, {m, one.mark[after(i)], kNone}});
  triangles_[u] = {{d, c, x}, {t1, u1, two.next[before(j)]}, {m, kNone, two.mark[before(j)]}};
  triangles_.push_back({{d, x, b}, {t, two.next[after(j)], u}, {m, two.mark[after(j)], kNone}});
  relink(one.next[after(i)], t, t1);
  relink(two.next[after(j)], u, u1);
  triangle_at_[a] = triangle_at_[b] = triangle_at_[x] = t;
  triangle_at_[c] = triangle_at_[d] = u;
}

void PlaneMesh::flip(Side side) {
  const std::uint32_t t = side.triangle, u = triangles_[t].next[side.corner];
  const int i = side.corner, j = corner_facing(u, t);
  const Triangle3 one = triangles_[t], two = triangles_[u];
  const Node a = one.v[i], b = one.v[after(i)], c = one.v[before(i)], d = two.v[j];
  triangles_[t] = {
      {a, b, d}, {two.next[after(j)], u, one.next[before(i)]}, {two.mark[after(j)], kNone, one.mark[before(i)]}};
  triangles_[u] = {
      {a, d, c}, {two.next[before(j)], one.next[after(i)], t}, {two.mark[before(j)], one.mark[after(i)], kNone}};
  relink(two.next[after(j)], u, t);
  relink(one.next[after(i)], t, u);
  triangle_at_[a] = triangle_at_[b] = triangle_at_[d] = t;
  triangle_at_[c] = u;
}

bool PlaneMesh::is_convex(Side side) const {
  const Triangle3& t = triangles_[side.triangle];
  const std::uint32_t u = t.next[side.corner];
  const Node d = triangles_[u].v[corner_facing(u, side.triangle)];
  const Node a = t.v[side.corner];
  return orient(a, t.v[after(side.corner)], d) > 0 && orient(a, d, t.v[before(side.corner)]) > 0;
}

bool PlaneMesh::is_bad(Side side) const {
  const Triangle3& t = triangles_[side.triangle];
  const std::uint32_t u = t.next[side.corner];
  if (u == kNone || t.mark[side.corner] != kNone) return false;
  const auto at = [&](Node n) { return place_[n].at; };
  const Vec3 a = at(t.v[side.corner]), b = at(t.v[after(side.corner)]), c = at(t.v[before(side.corner)]);
  const Vec3 d = at(triangles_[u].v[corner_facing(u, side.triangle)]);
  // Opposite angles together above a half turn; by more than rounding makes of equal ones, so that flips end.
  constexpr double kMargin = 1e-9;
  return cotangent(a, b, c) + cotangent(d, b, c) < -kMargin && is_convex(side);
}

void PlaneMesh::legalize(Node x) {
  std::vector<std::uint32_t> stack;
  const std::uint32_t first = triangle_at_[x];
  std::uint32_t t = first;
  do {
    stack.push_back(t);
    t = triangles_[t].next[after(corner_of(t, x))];
  } while (t != first);
  // A bound against circles that rounding might draw.
  for (std::size_t flips = 0; !stack.empty() && flips < 64 + triangles_.size();) {
    t = stack.back();
    stack.pop_back();
    const int i = corner_of(t, x);
    if (triangles_[t].v[i] != x || !is_bad({t, i})) continue;
    const std::uint32_t u = triangles_[t].next[i];
    flip({t, i});
    ++flips;
    stack.push_back(t);
    stack.push_back(u);
  }
}

void PlaneMesh::improve() {
  std::vector<Side> stack;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (int i = 0; i < 3; ++i) stack.push_back({t, i});
  for (std::size_t flips = 0; !stack.empty() && flips < 16 * triangles_.size();) {
    const Side side = stack.back();
    stack.pop_back();
    if (!is_bad(side)) continue;
    const std::uint32_t u = triangles_[side.triangle].next[side.corner];
    flip(side);
    ++flips;
    for (const std::uint32_t t : {side.triangle, u})
      for (int i = 0; i < 3; ++i) stack.push_back({t, i});
  }
}

/// The triangle at a through which, or along whose edge to the next corner, the way to b begins.
PlaneMesh::Side PlaneMesh::toward(Node a, Node b) const {
  std::uint32_t t = triangle_at_[a];
  for (;;) {
    const int i = corner_of(t, a);
    const Node r = triangles_[t].v[after(i)], s = triangles_[t].v[before(i)];
    if (r == b || (orient(a, r, b) >= 0 && orient(a, s, b) < 0)) return {t, i};
    t = triangles_[t].next[after(i)];
  }
}

/// The edge between two neighbours, one of which is no corner of the rim.
PlaneMesh::Side PlaneMesh::find_edge(Node a, Node b) const {
  constexpr Node kRim = 3;
  if (a < kRim) std::swap(a, b);
  std::uint32_t t = triangle_at_[a];
  while (triangles_[t].v[after(corner_of(t, a))] != b) t = triangles_[t].next[after(corner_of(t, a))];
  return {t, before(corner_of(t, a))};
}

void PlaneMesh::mark(Side side, std::uint32_t cut, std::uint32_t face) {
  Triangle3& t = triangles_[side.triangle];
  std::uint32_t& known = t.mark[side.corner];
  if (known != kNone && face == kNone) return;
  // The other parts of the segment that is known keep its mark as it is.
  Mark fresh = known != kNone ? marks_[known] : Mark{cut, {}};
  if (face != kNone) toggle(fresh.border, face);
  known = static_cast<std::uint32_t>(marks_.size());
  const std::uint32_t u = t.next[side.corner];
  triangles_[u].mark[corner_facing(u, side.triangle)] = known;
  marks_.push_back(std::move(fresh));
}

void PlaneMesh::add_segment(Node a, Node b, const Homogeneous& cut, std::uint32_t face) {
  const auto number = static_cast<std::uint32_t>(cuts_.size());
  cuts_.push_back(cut);
  while (a != b) {
    const Node reached = clear_way(a, b, number);
    mark(find_edge(a, reached), number, face);
    a = reached;
  }
}

/// Makes an edge from a along the way to b; returns its other end, which is b, a vertex between, or a crossing.
PlaneMesh::Node PlaneMesh::clear_way(Node a, Node b, std::uint32_t cut) {
  const Side first = toward(a, b);
  Node right = triangles_[first.triangle].v[after(first.corner)],
       left = triangles_[first.triangle].v[before(first.corner)];
  if (right == b || orient(a, right, b) == 0) return right;
  std::vector<std::array<Node, 2>> crossed;
  Side across = first;
  for (;;) {
    const Triangle3& t = triangles_[across.triangle];
    if (const std::uint32_t m = t.mark[across.corner]; m != kNone) {
      if (budget_) budget_->take();
      crossings_.push_back(planes_meet(plane_, cuts_[cut], cuts_[marks_[m].cut]));
      const ExactPoint& x = crossings_.back();
      const Node n = new_node({x.at, &x.place});
      crossing_nodes_.push_back(n);
      split_edge(across, n);
      flip_in(a, n, std::move(crossed));
      return n;
    }
    crossed.push_back({right, left});
    const std::uint32_t u = t.next[across.corner];
    const int j = corner_facing(u, across.triangle);
    const Node d = triangles_[u].v[j];
    const int side = d == b ? 0 : orient(a, b, d);
    if (side == 0) {
      flip_in(a, d, std::move(crossed));
      return d;
    }
    // u is (d, left, right): the edge opposite `right` joins d and left.
    across = {u, side > 0 ? after(j) : before(j)};
    (side > 0 ? left : right) = d;
  }
}

/// Flips until a and b are neighbours; `crossed` are the edges between (S. W. Sloan, "A fast algorithm for generating
/// constrained Delaunay triangulations", 1993).
void PlaneMesh::flip_in(Node a, Node b, std::vector<std::array<Node, 2>> crossed) {
  std::deque<std::array<Node, 2>> queue(crossed.begin(), crossed.end());
  while (!queue.empty()) {
    const auto [p, q] = queue.front();
    queue.pop_front();
    const Side side = find_edge(p, q);
    if (!is_convex(side)) {
      queue.push_back({p, q});
      continue;
    }
    const std::uint32_t u = triangles_[side.triangle].next[side.corner];
    const Node c = triangles_[side.triangle].v[side.corner], d = triangles_[u].v[corner_facing(u, side.triangle)];
    flip(side);
    const bool at_end = c == a || c == b || d == a || d == b;
    if (!at_end && orient(a, b, c) * orient(a, b, d) < 0) queue.push_back({c, d});
  }
}

std::vector<PlaneMesh::Piece> PlaneMesh::pieces() const {
  std::vector<char> seen(triangles_.size(), 0);
  std::vector<Border> faces(triangles_.size());
  // The triangle at a corner of the rim is covered by nothing.
  std::vector<std::uint32_t> stack{triangle_at_[0]};
  seen[stack.back()] = 1;
  while (!stack.empty()) {
    const std::uint32_t t = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t u = triangles_[t].next[i], m = triangles_[t].mark[i];
      if (u == kNone || seen[u]) continue;
      seen[u] = 1;
      if (m == kNone) {
        faces[u] = faces[t];
      } else {
        const Border& border = marks_[m].border;
        std::set_symmetric_difference(faces[t].begin(), faces[t].end(), border.begin(), border.end(),
                                      std::back_inserter(faces[u]));
      }
      stack.push_back(u);
    }
  }
  std::vector<Piece> all;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (!faces[t].empty()) all.push_back({triangles_[t].v, std::move(faces[t])});
  return all;
}

}  // namespace octafront::arrangement
