#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"
#include "soup/cells/cell_steps.h"

namespace octafront::cells {

namespace {

/// Directions across an edge into its triangles.
std::vector<Vec3> ways_across(const SurfaceMesh& surface, const EdgeTable& table, std::size_t e) {
  const Vec3 p = surface.points[table.edges[e][0]], along = normalized(surface.points[table.edges[e][1]] - p);
  std::vector<Vec3> ways;
  for (const HalfEdge h : table.uses(e)) {
    const Vec3 way = surface.points[surface.triangles[h / 3][(h % 3 + 2) % 3]] - p;
    ways.push_back(normalized(way - dot(way, along) * along));
  }
  return ways;
}

/// The walls of a complex that have nothing before them, by the body behind.
class OpenWalls {
 public:
  OpenWalls(const SurfaceMesh& complex, const Misfits& misfits)
      : complex_(complex), least_(misfits.floor()), open_(misfits.bodies()) {
    for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
      const Sides sides = complex.sides_of(t);
      if (sides[0] != kNone && sides[1] != kNone) continue;
      for (const std::uint32_t region : sides)
        if (region < open_.size()) open_[region].push_back(complex.triangles[t]);
    }
  }

  bool leave_a_gap(std::uint32_t a, std::uint32_t b, double most) const {
    return has_before(open_[a], open_[b], most) || has_before(open_[b], open_[a], most);
  }

 private:
  /// Whether corners of the ones have one of the others before them, not farther away.
  bool has_before(const std::vector<Triangle>& from, const std::vector<Triangle>& to, double most) const {
    const TriangleTree tree(complex_.points, to);
    const Vec3 reach{most, most, most};
    return std::ranges::any_of(from, [&](const Triangle& t) {
      const Vec3 n = normal(t);
      return std::ranges::any_of(t, [&](VertexIndex v) {
        const Vec3 p = complex_.points[v];
        return !tree.for_each_box_near({p - reach, p + reach}, [&](std::uint32_t u, const TriangleCorners& c) {
          const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
          return distance(p, q) <= least_ || distance(p, q) > most || !face_each_other(n, normal(to[u]), p - q);
        });
      });
    });
  }
  Vec3 normal(const Triangle& t) const {
    return unit_normal(complex_.points[t[0]], complex_.points[t[1]], complex_.points[t[2]]);
  }

  const SurfaceMesh& complex_;
  double least_;
  std::vector<std::vector<Triangle>> open_;
};

}  // namespace

namespace {

double least_height(const SurfaceMesh& surface) {
  double least = HUGE_VAL;
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 p = surface.points[a], q = surface.points[b], r = surface.points[c];
    const double longest = std::max({distance(p, q), distance(q, r), distance(r, p)});
    least = std::min(least, length(double_area_normal(p, q, r)) / longest);
  }
  return least;
}

}  // namespace

WallShape shape_of_walls(const SurfaceMesh& complex) {
  WallShape shape;
  shape.thinnest = least_height(complex);
  const EdgeTable table = make_edge_table(complex.points.size(), complex.triangles);
  for (std::size_t e = 0; e < table.size(); ++e) {
    const Edge& edge = table.edges[e];
    const double long_by = distance(complex.points[edge[0]], complex.points[edge[1]]);
    if (long_by < shape.shortest) {
      shape.shortest = long_by;
      if (shape.has_no_wedge()) shape.at = edge;
    }
    const std::vector<Vec3> ways = ways_across(complex, table, e);
    for (std::size_t i = 0; i < ways.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double sine = length(cross(ways[i], ways[j]));
        if (dot(ways[i], ways[j]) <= 0 || sine >= shape.narrowest) continue;
        shape.narrowest = sine;
        shape.at = edge;
      }
  }
  return shape;
}

bool leave_gaps(const SurfaceMesh& complex, const Misfits& misfits) {
  const OpenWalls walls(complex, misfits);
  return std::ranges::any_of(misfits.all(), [&](const auto& pair) {
    return walls.leave_a_gap(pair.first.first, pair.first.second, pair.second);
  });
}

}  // namespace octafront::cells
