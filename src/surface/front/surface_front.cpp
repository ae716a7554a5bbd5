#include "surface/front/surface_front.h"

#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "surface/lines/point_grid.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>

namespace octafront::surface {

namespace {

/// No two points of a sheet are nearer than this, in element sizes.
constexpr double kSpacing = 0.7;
/// Points within this reach, in element sizes, fill the angle around a point.
constexpr double kReachOfFront = 1.5;
/// Points of a part are on one sheet if their normals agree by this cosine, for elements may be coarse for the
/// curvature ...
constexpr double kSheetCosine = 0.2;
/// ... and their offset along the normal stays below this part of their distance.
constexpr double kSheetOffset = 0.75;
/// Points are placed again if their number differs by this part from the one wanted; edges differ by half of it.
constexpr double kSurplus = 0.045;
constexpr int kMostPlacings = 3;
/// Sizes are changed by no more than this for it: small models at coarse sizes have no room to make up.
constexpr double kLeastFactorOfCurve = 0.9;
/// A triangle is sampled in this many rows at most.
constexpr int kMostParts = 64;
/// Points of a wave, and those of it that one thread takes at a time.
constexpr std::size_t kMostOfWave = 8192, kPointsAtOnce = 16;
constexpr double kSixtyDegrees = std::numbers::pi / 3;

/// What the grid knows of a point: on which sheet it lies.
struct OnSheet {
  Vec3 normal;
  std::uint32_t part = 0;
  bool on_feature = false;
};
using Grid = PointGrid<OnSheet>;

/// Grows with the angle of (x, y), from -2 to 2, and costs a division.
double turn_of(double x, double y) {
  const double sum = std::abs(x) + std::abs(y), s = sum > 0 ? y / sum : 0;
  if (x >= 0) return s;
  return y >= 0 ? 2 - s : -2 - s;
}

class Front {
 public:
  /// Places by `factor` times the sizes inside patches.
  Front(const InputSurface& input, const SizeField& sizes, double factor)
      : input_(input),
        sizes_(sizes),
        factor_(factor),
        part_(component_of_triangle(input.mesh, parts_)),
        grid_(bounding_box(input.mesh.points).center()) {}

  FrontPoints run(const std::vector<Curve>& curves, const RunContext& context) {
    for (const Curve& c : curves) add_curve(c);
    for (std::size_t c = 0; c < curves.size(); ++c) {
      Places places;
      place_apexes(curves[c], c, places);
      for (const FrontPoint& p : places.points) take(p);
    }
    std::vector<std::uint8_t> reached(parts_, 0);
    for (const FrontPoint& p : result_.points) reached[part_[p.face]] = 1;
    advance(context);
    for (std::uint32_t face = 0; face < part_.size(); ++face) {
      if (reached[part_[face]]) continue;
      reached[part_[face]] = 1;
      place_seed(face);
      advance(context);
    }
    for (FrontPoint& p : result_.points) {
      if (!p.on_feature) p.h /= factor_;
    }
    return std::move(result_);
  }

 private:
  /// By its direction in the plane of a point.
  struct Neighbour {
    double turn, x, y;
    std::uint32_t id;

    double angle() const { return elementary::atan2(y, x); }
  };
  /// What one thread works with, and the places that it finds, in their order.
  struct Places {
    std::vector<FrontPoint> points;
    std::vector<Neighbour> neighbours;
    std::vector<HalfEdge> fan;
  };
  /// Whether less than 90 degrees lie between a and b, which follows it or is the first after the last.
  static bool is_acute(const Neighbour& a, const Neighbour& b) {
    const double turn = b.turn - a.turn;
    return (turn > 0 || turn < -2) && a.x * b.x + a.y * b.y > 0 && a.x * b.y - a.y * b.x > 0;
  }

  double size_at(Vec3 p) const { return factor_ * sizes_.at(p); }

  void add(const FrontPoint& point) {
    result_.points.push_back(point);
    grid_.add(point.p, point.h, {point.normal, part_[point.face], point.on_feature});
  }

  void add_curve(const Curve& curve) {
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 0; i < curve.samples.size(); ++i) {
      const CurvePoint& c = curve.samples[i];
      if (c.vertex != kNone) {
        const auto [it, is_new] = of_vertex_.try_emplace(c.vertex, static_cast<std::uint32_t>(result_.points.size()));
        ids.push_back(it->second);
        if (!is_new) continue;
      } else {
        ids.push_back(static_cast<std::uint32_t>(result_.points.size()));
      }
      add({c.p, input_.face_normal[c.half_edge / 3], c.h, c.half_edge / 3, c.vertex, c.half_edge, kNone, true});
    }
    result_.curve_points.push_back(std::move(ids));
  }

  void place_apexes(const Curve& curve, std::size_t index, Places& places) const {
    const HalfEdgeMesh& mesh = input_.mesh;
    for (std::size_t i = 0; i < curve.middles.size(); ++i) {
      const CurvePoint& middle = curve.middles[i];
      const Vec3 chord = curve.samples[i + 1].p - curve.samples[i].p;
      const double half = 0.5 * length(chord), h = middle.h;
      const double height = std::sqrt(std::max(0.25 * h * h, h * h - half * half));
      for (const HalfEdge side : {middle.half_edge, mesh.twin[middle.half_edge]}) {
        if (input_.is_back(side / 3)) continue;
        const Vec3 n = input_.face_normal[side / 3];
        Vec3 inward = cross(n, chord);
        if (side != middle.half_edge) inward = -inward;
        const std::uint32_t parent = result_.curve_points[index][i];
        SurfacePoint x;
        if (walk(input_, {middle.p, side / 3}, normalized(inward), n, height, x) == WalkEnd::kArrived) {
          leave_at(x, parent, places);
        }
      }
    }
  }

  void leave_at(SurfacePoint x, std::uint32_t parent, Places& places) const {
    FrontPoint point;
    point.p = x.p;
    point.face = x.face;
    point.normal = input_.normal_at(x.face, x.p);
    point.h = size_at(x.p);
    point.parent = parent;
    places.points.push_back(point);
  }

  /// Takes the place if it is free.
  void take(const FrontPoint& point) {
    ++result_.candidates;
    bool is_free = true;
    grid_.for_each_near(point.p, point.h, kSpacing, [&](const Grid::Entry& other) {
      if (!is_free) return;
      const double near = kSpacing * 0.5 * (point.h + other.size);
      if (squared_length(other.p - point.p) < near * near && same_sheet(point, other)) is_free = false;
    });
    if (is_free) add(point);
  }

  bool same_sheet(const FrontPoint& a, const Grid::Entry& b) const {
    if (part_[a.face] != b.data.part) return false;  // however near: shells lie within shells
    if (!b.data.on_feature && dot(a.normal, b.data.normal) < kSheetCosine) return false;
    const Vec3 d = b.p - a.p;
    return std::abs(dot(d, a.normal)) <= kSheetOffset * length(d);
  }

  void place_seed(std::uint32_t face) {
    const Vec3 c = (input_.mesh.corner(face, 0) + input_.mesh.corner(face, 1) + input_.mesh.corner(face, 2)) / 3;
    FrontPoint point;
    point.p = c;
    point.face = face;
    point.normal = input_.normal_at(face, c);
    point.h = size_at(c);
    add(point);
  }

  /// In waves: all points that are new look for places around them, seeing none of each other's, and these are taken in
  /// the order of the points.
  void advance(const RunContext& context) {
    while (next_ < result_.points.size()) {
      context.check();
      const std::uint32_t begin = next_;
      next_ = static_cast<std::uint32_t>(std::min(result_.points.size(), begin + kMostOfWave));
      const std::vector<FrontPoint> found = parallel_collect<FrontPoint>(
          next_ - begin, kPointsAtOnce, [&](std::size_t first, std::size_t last, std::vector<FrontPoint>& out) {
            Places places;
            for (auto id = static_cast<std::uint32_t>(begin + first); id < begin + last; ++id) look_around(id, places);
            out = std::move(places.points);
          });
      for (const FrontPoint& point : found) take(point);
    }
  }

  void look_around(std::uint32_t id, Places& places) const {
    if (result_.points[id].on_feature)
      fill_sectors(id, places);
    else
      fill_gaps(id, places);
  }

  /// The wanted length of an edge from `point` in a direction.
  double reach_towards(const FrontPoint& point, Vec3 direction) const {
    const double there = size_at(point.p + direction * point.h);
    return 0.5 * (point.h + there);
  }

  /// Around a point inside a patch: new points in every gap between the directions to its neighbours.
  void fill_gaps(std::uint32_t id, Places& places) const {
    const FrontPoint point = result_.points[id];
    const Vec3 n = point.normal;
    const Vec3 axis = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 u = normalized(cross(axis, n)), v = cross(n, u);
    std::vector<Neighbour>& neighbours = places.neighbours;
    find_neighbours(id, point, u, v, neighbours);
    if (neighbours.empty()) neighbours.push_back({0, 1, 0, kNone}), leave(id, point, u, v, 0, places);
    const std::size_t count = neighbours.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Neighbour &a = neighbours[i], &b = neighbours[(i + 1) % count];
      if (is_acute(a, b)) continue;  // nearly always: no need of angles
      const double from = a.angle(), gap = b.angle() + (i + 1 < count ? 0 : 2 * std::numbers::pi) - from;
      const int parts = static_cast<int>(std::lround(gap / kSixtyDegrees));
      for (int k = 1; k < parts; ++k) leave(id, point, u, v, from + gap * k / parts, places);
    }
  }

  /// Of the same sheet, by angle.
  void find_neighbours(std::uint32_t id, const FrontPoint& point, Vec3 u, Vec3 v, std::vector<Neighbour>& found) const {
    found.clear();
    grid_.for_each_near(point.p, point.h, kReachOfFront, [&](const Grid::Entry& other) {
      if (other.id == id) return;
      const double reach = kReachOfFront * 0.5 * (point.h + other.size);
      const Vec3 d = other.p - point.p;
      if (squared_length(d) > reach * reach || !same_sheet(point, other)) return;
      const double x = dot(d, u), y = dot(d, v);
      found.push_back({turn_of(x, y), x, y, other.id});
    });
    std::sort(found.begin(), found.end(),
              [](const Neighbour& a, const Neighbour& b) { return a.turn != b.turn ? a.turn < b.turn : a.id < b.id; });
  }

  void leave(std::uint32_t id, const FrontPoint& point, Vec3 u, Vec3 v, double angle, Places& places) const {
    const Vec3 d = u * elementary::cos(angle) + v * elementary::sin(angle);
    SurfacePoint x;
    if (walk(input_, {point.p, point.face}, d, point.normal, reach_towards(point, d), x) == WalkEnd::kArrived) {
      leave_at(x, id, places);
    }
  }

  /// Around a point on a curve: each sector between feature edges by itself, divided evenly near 60 degrees.
  void fill_sectors(std::uint32_t id, Places& places) const {
    const FrontPoint point = result_.points[id];
    if (point.vertex != kNone) {
      fill_vertex_sectors(id, point, places);
      return;
    }
    const HalfEdgeMesh& mesh = input_.mesh;
    for (const HalfEdge side : {point.half_edge, mesh.twin[point.half_edge]}) {
      if (input_.is_back(side / 3)) continue;
      const Vec3 n = input_.face_normal[side / 3];
      const Vec3 u = normalized(mesh.points[mesh.end(side)] - mesh.points[mesh.start[side]]), v = cross(n, u);
      for (int k = 1; k < 3; ++k) {
        const Vec3 d = u * elementary::cos(k * kSixtyDegrees) + v * elementary::sin(k * kSixtyDegrees);
        SurfacePoint x;
        if (walk(input_, {point.p, side / 3}, d, n, reach_towards(point, d), x) == WalkEnd::kArrived)
          leave_at(x, id, places);
      }
    }
  }

  double angle_at(HalfEdge corner) const {
    const HalfEdgeMesh& mesh = input_.mesh;
    const Vec3 a = mesh.points[mesh.start[corner]];
    const Vec3 u = mesh.points[mesh.end(corner)] - a, v = mesh.points[mesh.apex(corner)] - a;
    return elementary::atan2(length(cross(u, v)), dot(u, v));
  }

  void fill_vertex_sectors(std::uint32_t id, const FrontPoint& point, Places& places) const {
    const HalfEdgeMesh& mesh = input_.mesh;
    mesh.for_each_outgoing(point.vertex, [&](HalfEdge first) {
      if (!mesh.is_feature[first] || input_.is_back(first / 3)) return;
      places.fan.clear();
      double total = 0;
      HalfEdge h = first;
      do {
        places.fan.push_back(h);
        total += angle_at(h);
        h = mesh.rotated(h);
      } while (!mesh.is_feature[h]);
      const int parts = static_cast<int>(std::lround(total / kSixtyDegrees));
      for (int k = 1; k < parts; ++k) leave_vertex(id, point, total * k / parts, places);
    });
  }

  /// At `angle` from the start of the flattened fan.
  void leave_vertex(std::uint32_t id, const FrontPoint& point, double angle, Places& places) const {
    const HalfEdgeMesh& mesh = input_.mesh;
    for (const HalfEdge corner : places.fan) {
      const double here = angle_at(corner);
      if (angle > here && corner != places.fan.back()) {
        angle -= here;
        continue;
      }
      const Vec3 u = normalized(mesh.points[mesh.end(corner)] - point.p), v = cross(input_.face_normal[corner / 3], u);
      const Vec3 d = u * elementary::cos(angle) + v * elementary::sin(angle);
      SurfacePoint x;
      if (walk_from_vertex(input_, corner, d, reach_towards(point, d), x) == WalkEnd::kArrived) leave_at(x, id, places);
      return;
    }
  }

  const InputSurface& input_;
  const SizeField& sizes_;
  double factor_;
  std::uint32_t parts_ = 0;
  std::vector<std::uint32_t> part_;  ///< per triangle of the input: which connected part it belongs to
  Grid grid_;
  FrontPoints result_;
  std::map<VertexIndex, std::uint32_t> of_vertex_;
  std::uint32_t next_ = 0;
};

/// The integral of 1 / h^2 over a triangle, by its parts no longer than about two sizes.
double demand_of(Vec3 a, Vec3 b, Vec3 c, const SizeField& sizes) {
  const auto size_at = [&](double u, double v) { return sizes.at(a * (1 - u - v) + b * u + c * v); };
  const double in_middle = size_at(1.0 / 3, 1.0 / 3);
  const double longest = std::sqrt(std::max({squared_length(a - b), squared_length(b - c), squared_length(c - a)}));
  const int n = std::clamp(static_cast<int>(longest / (2 * in_middle)) + 1, 1, kMostParts);
  if (n == 1) return 1 / (in_middle * in_middle) * 0.5 * length(cross(b - a, c - a));
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < 2 * (n - i) - 1; ++j) {
      // Parts come in pairs along a row: upright ones, and between them such as stand on their tip.
      const double third = j % 2 == 0 ? 1.0 / 3 : 2.0 / 3, u = (i + third) / n, v = (j / 2 + third) / n;
      const double h = size_at(u, v);
      sum += 1 / (h * h);
    }
  }
  return sum / (n * n) * 0.5 * length(cross(b - a, c - a));
}

/// The number of points that the sizes ask for: equilateral triangles, two for each point.
double points_wanted(const InputSurface& input, const SizeField& sizes) {
  std::vector<double> demand(input.mesh.triangle_count());
  parallel_for(demand.size(), [&](std::size_t t) {
    if (input.is_back(t)) return;
    demand[t] = demand_of(input.mesh.corner(t, 0), input.mesh.corner(t, 1), input.mesh.corner(t, 2), sizes);
  });
  return std::accumulate(demand.begin(), demand.end(), 0.0) * 2 / std::numbers::sqrt3;
}

/// The same of what was made. Of a closed surface, that is; at an end of it points count half.
double points_made(const InputSurface& input, const std::vector<FrontPoint>& points) {
  const auto is_at_end = [&](const FrontPoint& p) {
    if (!p.on_feature || input.first_back == kNone) return false;
    return p.vertex != kNone ? input.on_seam(p.vertex) : input.is_seam(p.half_edge);
  };
  const auto at_end = static_cast<double>(std::count_if(points.begin(), points.end(), is_at_end));
  return static_cast<double>(points.size()) - 0.5 * at_end;
}

}  // namespace

FrontPoints place_points(const InputSurface& input, const std::vector<Curve>& curves, const SizeField& sizes,
                         const RunContext& context) {
  double wanted = 0, factor = 1, least = HUGE_VAL;
  FrontPoints made, best;
  const auto place = [&] { made = Front(input, sizes, factor).run(curves, context); };
  // The first time nothing depends on the number wanted.
  parallel_invoke(place, [&] { wanted = points_wanted(input, sizes); });
  for (int attempt = 0; attempt < kMostPlacings; ++attempt) {
    if (attempt > 0) place();
    const double surplus = points_made(input, made.points) / wanted;
    if (std::abs(surplus - 1) < least) {
      least = std::abs(surplus - 1);
      best = std::move(made);
    }
    if (least < kSurplus) break;
    factor = std::clamp(factor * std::sqrt(surplus), kLeastFactorOfCurve, 1 / kLeastFactorOfCurve);
  }
  return best;
}

}  // namespace octafront::surface
