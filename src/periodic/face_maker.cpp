#include "periodic/face_maker.h"

#include "base/core/renumber.h"
#include "periodic/face_names.h"

#include <algorithm>
#include <array>
#include <utility>

namespace octafront::periods {

namespace {

/// A triangle with vertices on its edges: on[i] from corner i to the next one.
struct Divided {
  Triangle t;
  std::array<std::vector<VertexIndex>, 3> on;
};

/// Two triangles on either side of the middle vertex of an edge, and so on.
void halve(const Divided& d, const FaceKind& kind, Rebuilt& to) {
  int i = 0;
  while (i < 3 && d.on[i].empty()) ++i;
  if (i == 3) return to.add(d.t, kind);
  const std::vector<VertexIndex>& on = d.on[i];
  const auto middle = on.begin() + static_cast<std::ptrdiff_t>(on.size() / 2);
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  halve({{d.t[i], *middle, d.t[k]}, {std::vector(on.begin(), middle), {}, d.on[k]}}, kind, to);
  halve({{*middle, d.t[j], d.t[k]}, {std::vector(middle + 1, on.end()), d.on[j], {}}}, kind, to);
}

}  // namespace

void add_divided(const Triangle& t, const FaceKind& kind, const std::map<Edge, std::vector<VertexIndex>>& between,
                 Rebuilt& to) {
  Divided divided{t, {}};
  for (int i = 0; i < 3; ++i) {
    const VertexIndex a = t[i], b = t[(i + 1) % 3];
    const auto at = between.find(sorted_edge(a, b));
    if (at == between.end()) continue;
    divided.on[i] = at->second;
    if (a > b) std::reverse(divided.on[i].begin(), divided.on[i].end());
  }
  halve(divided, kind, to);
}

FaceParts parts_of_face(const SurfaceMesh& surface, FunctionRef<bool(std::uint32_t)> has,
                        FunctionRef<bool(VertexIndex)> is_on) {
  FaceParts parts;
  std::map<std::pair<std::uint32_t, Sides>, std::uint32_t> number;
  std::map<std::pair<Edge, std::uint32_t>, int> uses;
  std::vector<Edge> walls;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.triangles[t];
    const std::array edges{sorted_edge(a, b), sorted_edge(b, c), sorted_edge(c, a)};
    if (!has(t)) {
      for (const Edge& e : edges)
        if (is_on(e[0]) && is_on(e[1])) walls.push_back(e);
      for (const VertexIndex v : {a, b, c})
        if (is_on(v)) parts.touched.push_back(v);
      continue;
    }
    const auto [at, is_new] =
        number.try_emplace({surface.patch_of(t), surface.sides_of(t)}, static_cast<std::uint32_t>(parts.first.size()));
    if (is_new) parts.first.push_back(t);
    parts.triangles.push_back(t), parts.part.push_back(at->second);
    for (const Edge& e : edges) ++uses[{e, at->second}];
  }
  std::ranges::sort(walls);
  for (const auto& [line, count] : uses) {
    if (count == 1) parts.lines.push_back(line);
    if (count > 1 && std::ranges::binary_search(walls, line.first)) parts.lines.emplace_back(line.first, kNone);
  }
  std::ranges::sort(parts.touched);
  parts.touched.erase(std::unique(parts.touched.begin(), parts.touched.end()), parts.touched.end());
  return parts;
}

VerticesAlong::VerticesAlong(const std::vector<Vec3>& points, std::vector<VertexIndex> vertices, int axis)
    : points_(points), vertices_(std::move(vertices)), axis_(axis) {
  std::ranges::sort(vertices_, {}, [&](VertexIndex v) { return points_[v][axis_]; });
}

VertexIndex VerticesAlong::nearest(Vec3 p, double reach) const {
  VertexIndex found = kNone;
  double best = reach;
  auto at = std::ranges::lower_bound(vertices_, p[axis_] - reach, {}, [&](VertexIndex v) { return points_[v][axis_]; });
  for (; at != vertices_.end() && points_[*at][axis_] <= p[axis_] + reach; ++at)
    if (const double d = distance(p, points_[*at]); d <= best) best = d, found = *at;
  return found;
}

FaceMaker::FaceMaker(SurfaceMesh& surface, const RunContext& context)
    : surface_(surface),
      context_(context),
      diagonal_(bounding_box(surface.points).diagonal()),
      tolerance_(kSamePlace * diagonal_),
      face_(surface.triangles.size(), kNone),
      is_plain_(surface.sides.empty()) {
  for (std::uint32_t t = 0; t < face_.size(); ++t) {
    made_.origin.push_back(t);
    source_.push_back(surface.source_of(t));
  }
  if (surface.patch.empty()) surface.patch.assign(surface.triangles.size(), 0);
  if (surface.sides.empty()) surface.sides.assign(surface.triangles.size(), {kNone, 0});
}

void FaceMaker::move(Vec3& p, Vec3 to) {
  if (p == to) return;
  const double by = distance(p, to);
  if (by > cell().grid) ++made_.moved, made_.largest_move = std::max(made_.largest_move, by);
  p = to;
}

bool FaceMaker::are_same(int period, const std::vector<std::uint32_t>& low,
                         const std::vector<std::uint32_t>& high) const {
  std::array<std::vector<std::array<PlaceKey, 3>>, 2> seen;
  for (std::size_t end = 0; end < 2; ++end) {
    for (const std::uint32_t t : end == 0 ? low : high) {
      std::array<Vec3, 3> corners{};
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = surface_.points[surface_.triangles[t][i]];
        if (end == 0) corners[i] = cell().to_high(corners[i], period);
      }
      seen[end].push_back(keys_of(corners));
    }
    std::ranges::sort(seen[end]);
  }
  return seen[0] == seen[1];
}

void FaceMaker::take(Rebuilt rebuilt) {
  surface_.triangles = std::move(rebuilt.triangles);
  surface_.patch.clear(), surface_.sides.clear(), face_.clear(), made_.origin.clear();
  for (const FaceKind& kind : rebuilt.kinds) {
    surface_.patch.push_back(kind.patch), surface_.sides.push_back(kind.sides);
    face_.push_back(kind.face), made_.origin.push_back(kind.origin);
  }
  drop_unused_points(surface_.points, surface_.triangles);
}

MadePeriodic FaceMaker::made() {
  name_faces(surface_, cell());
  if (is_plain_) surface_.sides.clear();
  surface_.source.clear();
  for (const std::uint32_t t : made_.origin) surface_.source.push_back(source_[t]);
  return std::move(made_);
}

}  // namespace octafront::periods
