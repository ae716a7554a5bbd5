#include "surface/edits/working_mesh.h"

#include <octafront/surface_mesh.h>

#include "base/core/validate.h"

#include <array>
#include <numeric>

namespace octafront::surface {

WorkingMesh::WorkingMesh(const InputSurface& input)
    : HalfEdgeMesh(input.mesh),
      kind(points.size()),
      normal(points.size()),
      size(points.size(), 0),
      face(points.size()),
      patch(input.patch),
      origin(triangle_count()),
      place(points.size()),
      changed(points.size(), kForAll),
      first_back(input.first_back) {
  std::iota(origin.begin(), origin.end(), 0u);
  for (VertexIndex v = 0; v < points.size(); ++v) {
    kind[v] = input.on_feature[v] ? VertexKind::kRemovableCurve : VertexKind::kRemovable;
    normal[v] = input.on_feature[v] ? Vec3{} : input.vertex_normal[v];
    face[v] = outgoing[v] == kNone ? kNone : outgoing[v] / 3;
  }
}

std::vector<std::uint32_t> WorkingMesh::alive_triangles() const {
  std::vector<std::uint32_t> alive;
  for (std::uint32_t t = 0; t < triangle_count(); ++t) {
    if (!is_removed(t)) alive.push_back(t);
  }
  return alive;
}

void WorkingMesh::clear_marks(std::uint8_t mark) {
  for (std::uint8_t& c : changed) c &= static_cast<std::uint8_t>(~mark);
}

namespace {

/// The values with these numbers, in their order.
template <class T>
std::vector<T> taken(const std::vector<T>& values, const std::vector<std::uint32_t>& numbers) {
  std::vector<T> some;
  some.reserve(numbers.size());
  for (const std::uint32_t i : numbers) some.push_back(values[i]);
  return some;
}

std::vector<std::uint32_t> inverse(const std::vector<std::uint32_t>& numbers, std::size_t count) {
  std::vector<std::uint32_t> to(count, kNone);
  for (std::uint32_t i = 0; i < numbers.size(); ++i) to[numbers[i]] = i;
  return to;
}

}  // namespace

std::vector<VertexIndex> WorkingMesh::compact() {
  const std::vector<std::uint32_t> triangles = alive_triangles();
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles) half_edges.insert(half_edges.end(), {3 * t, 3 * t + 1, 3 * t + 2});
  std::vector<VertexIndex> vertices;
  for (VertexIndex v = 0; v < points.size(); ++v)
    if (outgoing[v] != kNone) vertices.push_back(v);
  const std::vector<HalfEdge> half_edge = inverse(half_edges, start.size());
  const std::vector<VertexIndex> vertex = inverse(vertices, points.size());
  gone += triangle_count() - triangles.size();
  points = taken(points, vertices), kind = taken(kind, vertices), normal = taken(normal, vertices);
  size = taken(size, vertices), face = taken(face, vertices), place = taken(place, vertices);
  changed = taken(changed, vertices), outgoing = taken(outgoing, vertices);
  start = taken(start, half_edges), twin = taken(twin, half_edges), is_feature = taken(is_feature, half_edges);
  patch = taken(patch, triangles), origin = taken(origin, triangles);
  for (HalfEdge& h : outgoing) h = half_edge[h];
  for (HalfEdge& h : twin) h = half_edge[h];
  for (VertexIndex& v : start) v = vertex[v];
  validate(*this);
  return vertices;
}

void WorkingMesh::reserve(std::size_t vertices, std::size_t triangles) {
  points.reserve(vertices);
  kind.reserve(vertices);
  normal.reserve(vertices);
  size.reserve(vertices);
  face.reserve(vertices);
  place.reserve(vertices);
  changed.reserve(vertices);
  outgoing.reserve(vertices);
  start.reserve(3 * triangles);
  twin.reserve(3 * triangles);
  is_feature.reserve(3 * triangles);
  patch.reserve(triangles);
  origin.reserve(triangles);
}

VertexIndex WorkingMesh::add_vertex(Vec3 p, VertexKind k, Vec3 n, double h, std::uint32_t in_face) {
  points.push_back(p);
  kind.push_back(k);
  normal.push_back(n);
  size.push_back(h);
  face.push_back(in_face);
  place.emplace_back();
  changed.push_back(kForAll);
  outgoing.push_back(kNone);
  return static_cast<VertexIndex>(points.size() - 1);
}

namespace {

/// Room for one more triangle like `like`; returns its first half-edge.
HalfEdge add_triangle(WorkingMesh& m, std::uint32_t like, VertexIndex a, VertexIndex b, VertexIndex c) {
  const auto first = static_cast<HalfEdge>(m.start.size());
  m.start.insert(m.start.end(), {a, b, c});
  m.twin.insert(m.twin.end(), 3, kNone);
  m.is_feature.insert(m.is_feature.end(), 3, 0);
  m.patch.push_back(m.patch[like]);
  m.origin.push_back(m.origin[like]);
  return first;
}

void link(WorkingMesh& m, HalfEdge a, HalfEdge b, std::uint8_t feature) {
  m.twin[a] = b;
  m.twin[b] = a;
  m.is_feature[a] = m.is_feature[b] = feature;
}

}  // namespace

//         c
//        /|\          t keeps (a, b, x); the others follow it.
//       / x \.
//      a-----b
void WorkingMesh::split_triangle(std::uint32_t t, VertexIndex x) {
  const HalfEdge ab = 3 * t, bc = ab + 1, ca = ab + 2;
  const VertexIndex a = start[ab], b = start[bc], c = start[ca];
  const HalfEdge beyond_bc = twin[bc], beyond_ca = twin[ca];
  const std::uint8_t feature_bc = is_feature[bc], feature_ca = is_feature[ca];
  const HalfEdge k = add_triangle(*this, t, b, c, x), l = add_triangle(*this, t, c, a, x);
  start[ca] = x;
  link(*this, k, beyond_bc, feature_bc);
  link(*this, l, beyond_ca, feature_ca);
  link(*this, bc, k + 2, 0);     // b-x
  link(*this, k + 1, l + 2, 0);  // c-x
  link(*this, l + 1, ca, 0);     // a-x
  outgoing[c] = l;
  outgoing[x] = ca;
  validate(*this, std::array{a, b, c, x});
}

//        c
//       /|\           the triangles (a, x, c) and (b, x, d) keep their numbers.
//      a-x-b
//       \|/
//        d
void WorkingMesh::split_edge(HalfEdge h, VertexIndex x) {
  const HalfEdge g = twin[h], bc = next_of(h), ad = next_of(g);
  const VertexIndex a = start[h], b = start[g], c = apex(h), d = apex(g);
  const std::uint8_t feature = is_feature[h], feature_bc = is_feature[bc], feature_ad = is_feature[ad];
  const HalfEdge beyond_bc = twin[bc], beyond_ad = twin[ad];
  const HalfEdge k = add_triangle(*this, h / 3, x, b, c), l = add_triangle(*this, g / 3, x, a, d);
  start[bc] = x;
  start[ad] = x;
  link(*this, h, l, feature);
  link(*this, k, g, feature);
  link(*this, bc, k + 2, 0);  // x-c
  link(*this, ad, l + 2, 0);  // x-d
  link(*this, k + 1, beyond_bc, feature_bc);
  link(*this, l + 1, beyond_ad, feature_ad);
  outgoing[a] = h;
  outgoing[b] = k + 1;
  outgoing[x] = bc;
  for (const VertexIndex v : {a, b, c, d}) mark_changed(v);
  validate(*this, std::array{a, b, c, d, x});
}

bool WorkingMesh::can_turn(HalfEdge h) const {
  const VertexIndex c = apex(h), d = apex(twin[h]);
  return c != d && has_more_than_three(start[h]) && has_more_than_three(end(h)) && !are_joined(c, d);
}

// Looks around both at once: one of them may be the hub of thousands of triangles.
bool WorkingMesh::are_joined(VertexIndex a, VertexIndex b) const {
  const HalfEdge first = outgoing[a], other = outgoing[b];
  HalfEdge h = first, g = other;
  do {
    if (end(h) == b || end(g) == a) return true;
    h = rotated(h), g = rotated(g);
  } while (h != first && g != other);
  return false;
}

//        c               c
//       / \             /|\           h is a->b before; afterwards the triangle of h is (a, d, c), that of its former
//      a-h-b    ->     a | b          twin (b, c, d).
//       \ /             \|/
//        d               d
HalfEdge WorkingMesh::flip(HalfEdge h) {
  const HalfEdge g = twin[h], bc = next_of(h), ad = next_of(g);
  const VertexIndex a = start[h], b = start[g], c = apex(h), d = apex(g);
  const HalfEdge beyond_bc = twin[bc], beyond_ad = twin[ad];
  const std::uint8_t feature_bc = is_feature[bc], feature_ad = is_feature[ad];
  start[bc] = d;
  start[ad] = c;
  link(*this, h, beyond_ad, feature_ad);
  link(*this, g, beyond_bc, feature_bc);
  link(*this, bc, ad, 0);
  outgoing[a] = h;
  outgoing[b] = g;
  for (const VertexIndex v : {a, b, c, d}) mark_changed(v);
  validate(*this, std::array{a, b, c, d});
  return bc;
}

bool WorkingMesh::has_more_than_three(VertexIndex v) const {
  const HalfEdge h = outgoing[v];
  return rotated(rotated(rotated(h))) != h && rotated(rotated(h)) != h;
}

bool WorkingMesh::keeps_manifold(HalfEdge h) const {
  const VertexIndex u = start[h], w = end(h), a = apex(h), b = apex(twin[h]);
  if (!has_more_than_three(a) || !has_more_than_three(b)) return false;
  // Beside a slit, where two edges run between the same vertices, w would be left with two triangles back to back.
  if (!has_more_than_three(u) && !has_more_than_three(w)) return false;
  // u and w have just a and b as common neighbours.
  int common = 0;
  for_each_outgoing(u, [&](HalfEdge o) {
    const VertexIndex p = end(o);
    if (p != w && p != a && p != b && common == 0 && find(p, w) != kNone) ++common;
  });
  return common == 0;
}

bool WorkingMesh::may_collapse(HalfEdge h, bool corners_too) const {
  const HalfEdge g = twin[h];
  const VertexIndex u = start[h], w = start[g];
  if (kind[u] == VertexKind::kCorner && !corners_too) return false;
  const bool may_leave_curve = kind[u] == VertexKind::kCorner && on_curve(w);
  if (on_curve(u) && !is_feature[h] && !may_leave_curve) return false;
  // The edges to a and to b merge in pairs: two features may not.
  if (is_feature[next_of(h)] && is_feature[previous_of(h)]) return false;
  if (is_feature[next_of(g)] && is_feature[previous_of(g)]) return false;
  return keeps_manifold(h);
}

void WorkingMesh::collapse(HalfEdge h) {
  const HalfEdge g = twin[h];
  const VertexIndex u = start[h], w = start[g], a = apex(h), b = apex(g);
  const HalfEdge aw = twin[next_of(h)], ua = twin[previous_of(h)];
  const HalfEdge bu = twin[next_of(g)], wb = twin[previous_of(g)];
  const std::uint8_t feature_a = is_feature[aw] | is_feature[ua], feature_b = is_feature[bu] | is_feature[wb];
  for (HalfEdge o = h;;) {
    const HalfEdge following = rotated(o);
    start[o] = w;
    if (following == h) break;
    o = following;
  }
  for (const HalfEdge removed : {h, g}) {
    for (HalfEdge i = removed - removed % 3, k = 0; k < 3; ++k) start[i + k] = kNone;
  }
  link(*this, aw, ua, feature_a);
  link(*this, bu, wb, feature_b);
  outgoing[u] = kNone;
  outgoing[w] = ua;
  outgoing[a] = aw;
  outgoing[b] = bu;
  mark_star_changed(w);
  validate(*this, std::array{w, a, b});
}

std::optional<std::string> WorkingMesh::first_inconsistency() const {
  for (const std::size_t per_vertex :
       {kind.size(), normal.size(), size.size(), face.size(), place.size(), changed.size()})
    if (per_vertex != points.size()) return "the arrays of vertices differ in length";
  if (patch.size() != triangle_count() || origin.size() != triangle_count())
    return "the arrays of triangles differ in length";
  if (auto wrong = HalfEdgeMesh::first_inconsistency()) return wrong;
  std::vector<VertexIndex> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  return first_inconsistency(all);
}

std::optional<std::string> WorkingMesh::first_inconsistency(std::span<const VertexIndex> touched) const {
  for (const VertexIndex v : touched) {
    if (auto wrong = HalfEdgeMesh::first_inconsistency(v)) return wrong;
    if (outgoing[v] == kNone) continue;
    bool has_feature = false, has_seam = false;
    for_each_outgoing(v, [&](HalfEdge h) {
      has_feature = has_feature || is_feature[h];
      has_seam = has_seam || (!is_feature[h] && patch[h / 3] != patch[twin[h] / 3]);
    });
    if (has_feature && !on_curve(v)) return "vertex " + std::to_string(v) + " ends a feature, and is on no curve";
    if (has_seam) return "patches meet at vertex " + std::to_string(v) + " without a feature between them";
  }
  return std::nullopt;
}

}  // namespace octafront::surface
