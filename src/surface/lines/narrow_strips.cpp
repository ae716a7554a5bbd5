#include "base/core/parallel.h"
#include "sizing/field/change_size_field.h"
#include "surface/lines/line_sizes.h"
#include "surface/lines/point_grid.h"

#include <algorithm>

namespace octafront::surface {

namespace {

/// Strips in which the size would stay above this part are left alone.
constexpr double kWorthwhileStrip = 0.85;
/// Places to look from, in sizes, along a line.
constexpr double kStep = 0.5;
/// A place this near to one already kept, in the sizes wanted there, adds nothing.
constexpr double kSamePlace = 0.75;
/// A place beside another one is of use only if its size is smaller than that of the other by more than this factor.
constexpr double kSameSize = 1.1;

/// The feature edge of a face that p, a point of its border, lies on.
HalfEdge feature_at(const HalfEdgeMesh& mesh, std::uint32_t face, Vec3 p) {
  HalfEdge nearest = kNone;
  double least = HUGE_VAL;
  for (HalfEdge h = 3 * face; h < 3 * face + 3; ++h) {
    if (!mesh.is_feature[h]) continue;
    const Vec3 a = mesh.points[mesh.start[h]], along = normalized(mesh.points[mesh.end(h)] - a);
    const double off = length(cross(p - a, along));
    if (off < least) {
      least = off;
      nearest = h;
    }
  }
  return nearest;
}

Vec3 direction_of(const HalfEdgeMesh& mesh, HalfEdge h) {
  return normalized(mesh.points[mesh.end(h)] - mesh.points[mesh.start[h]]);
}

/// Width of the strip beside half-edge h at p; HUGE_VAL if there is none within reach.
double width_at(const InputSurface& input, HalfEdge h, Vec3 p, double reach, double parallel) {
  const Vec3 n = input.face_normal[h / 3], along = direction_of(input.mesh, h);
  SurfacePoint x;
  if (walk(input, {p, h / 3}, cross(n, along), n, reach, x) != WalkEnd::kFeature) return HUGE_VAL;
  const HalfEdge other = feature_at(input.mesh, x.face, x.p);
  if (other == kNone || other == h || dot(direction_of(input.mesh, other), along) > -parallel) return HUGE_VAL;
  return distance(p, x.p);
}

/// A place beside a line where the strip asks for a smaller size.
struct Narrow {
  Vec3 p;
  double size;
};

/// The size that the strip beside h asks for at p; `old` if there is none.
double size_beside(const InputSurface& input, HalfEdge h, Vec3 p, double old, const StripRules& rules) {
  const double width = width_at(input, h, p, kWorthwhileStrip / rules.size_per_width * old, rules.parallel);
  const double wanted = rules.size_per_width * width;
  if (!(wanted < kWorthwhileStrip * old) || width < std::max(rules.hopeless * old, rules.narrowest)) return old;
  return std::min(old, std::max({rules.floor * old, rules.least, wanted}));
}

/// Looks in the middle between two points of h and, where sizes rise so fast that it matters, nearer to them.
void look_between(const InputSurface& input, const SizeField& sizes, HalfEdge h, Vec3 from, Vec3 to,
                  const StripRules& rules, std::vector<Narrow>& places) {
  const Vec3 p = (from + to) * 0.5;
  const double old = sizes.at(p), size = size_beside(input, h, p, old, rules);
  if (!(size < old)) return;
  places.push_back({p, size});
  if (rules.gradation == 0 || distance(from, to) < size) return;
  look_between(input, sizes, h, from, p, rules, places);
  look_between(input, sizes, h, p, to, rules, places);
}

/// Those along one side of a feature half-edge.
std::vector<Narrow> narrow_places(const InputSurface& input, const SizeField& sizes, HalfEdge h,
                                  const StripRules& rules) {
  const HalfEdgeMesh& mesh = input.mesh;
  const Vec3 a = mesh.points[mesh.start[h]], b = mesh.points[mesh.end(h)];
  const double step = kStep * sizes.at((a + b) * 0.5);
  const int parts = std::max(1, static_cast<int>(std::min(1e6, std::ceil(distance(a, b) / step))));
  std::vector<Narrow> places;
  for (int i = 0; i < parts; ++i)
    look_between(input, sizes, h, a + (b - a) * (static_cast<double>(i) / parts), a + (b - a) * ((i + 1.0) / parts),
                 rules, places);
  return places;
}

}  // namespace

std::optional<SizeField> fitted_to_strips(const InputSurface& input, const SizeField& sizes, const StripRules& rules,
                                          const RunContext& context) {
  const HalfEdgeMesh& mesh = input.mesh;
  std::vector<HalfEdge> sides;
  for (HalfEdge h = 0; h < mesh.start.size(); ++h) {
    if (mesh.is_feature[h] && !input.is_back(h / 3)) sides.push_back(h);
  }
  std::vector<std::vector<Narrow>> found(sides.size());
  parallel_for(sides.size(), [&](std::size_t i) {
    context.check();
    found[i] = narrow_places(input, sizes, sides[i], rules);
  });
  std::vector<PointSize> places;
  PointGrid<NoData> kept(mesh.points.empty() ? Vec3{} : mesh.points.front());
  for (const std::vector<Narrow>& along : found) {
    for (const auto& [p, size] : along) {
      bool is_new = true;
      kept.for_each_near(p, size, kSamePlace, [&, s = size](const auto& e) { is_new &= e.size > kSameSize * s; });
      if (!is_new) continue;
      places.push_back({p, size});
      kept.add(p, size);
    }
  }
  if (places.empty()) return {};
  return capped_at(sizes, places, context, {.gradation = rules.gradation});
}

}  // namespace octafront::surface
