#include "adapt/schedule/nearness.h"

#include "base/core/flat_map.h"
#include "base/core/parallel.h"
#include "base/geometry/hausdorff.h"
#include "base/geometry/measures.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <cmath>

namespace octafront::adapt {
namespace {

/// The triangles that stand for the smooth surface are this much nearer to it than what is asked for, and distances
/// are known as well.
constexpr double kPartOfTolerance = 0.1;
/// Each side of a triangle is divided into so many where strays are looked for.
constexpr int kDivisions = 4;

/// Numbers for the vertices that a list of triangles has.
class PointsInUse {
 public:
  explicit PointsInUse(std::size_t vertices) : number_(vertices, kNone) {}
  template <class Place>
  VertexIndex add(VertexIndex v, SurfaceMesh& surface, std::vector<VertexIndex>& vertex, const Place& place) {
    if (number_[v] == kNone) {
      number_[v] = static_cast<VertexIndex>(vertex.size());
      vertex.push_back(v);
      surface.points.push_back(place(v));
    }
    return number_[v];
  }

 private:
  std::vector<VertexIndex> number_;
};

bool all_frozen(const Triangle& t, std::span<const std::uint8_t> frozen) {
  return !frozen.empty() && frozen[t[0]] && frozen[t[1]] && frozen[t[2]];
}

/// visit(point) for places all over a triangle, corners too.
template <class Visit>
void visit_places(const TriangleCorners& t, const Visit& visit) {
  for (int i = 0; i <= kDivisions; ++i)
    for (int j = 0; i + j <= kDivisions; ++j) {
      const double u = static_cast<double>(i) / kDivisions, v = static_cast<double>(j) / kDivisions;
      visit(t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]));
    }
}

void add_triangles(const std::vector<TriangleCorners>& list, SurfaceMesh& surface) {
  for (const TriangleCorners& t : list) {
    const auto first = static_cast<VertexIndex>(surface.points.size());
    surface.points.insert(surface.points.end(), t.begin(), t.end());
    surface.triangles.push_back({first, first + 1, first + 2});
  }
}

TriangleCorners corners_on(const SurfaceMesh& surface, const Triangle& t) {
  return {surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]};
}

}  // namespace

SmoothWalls::SmoothWalls(const Ground& ground, std::span<const std::uint8_t> frozen, double tolerance)
    : tolerance_(kPartOfTolerance * tolerance), tree_(SurfaceMesh{}) {
  const SurfaceMesh& walls = ground.walls().surface;
  std::vector<std::uint32_t> free;
  PointsInUse used(walls.points.size());
  std::vector<VertexIndex> vertex;
  for (std::uint32_t t = 0; t < walls.triangles.size(); ++t) {
    Triangle corners = walls.triangles[t];
    if (all_frozen(corners, frozen)) continue;
    if (!ground.is_covered(t)) free.push_back(t);
    for (VertexIndex& v : corners) v = used.add(v, old_, vertex, [&](VertexIndex u) { return walls.points[u]; });
    old_.triangles.push_back(corners);
  }
  std::vector<std::vector<TriangleCorners>> made(free.size());
  parallel_for(free.size(), [&](std::size_t k) { made[k] = ground.divided(free[k], tolerance_); });
  for (const auto& list : made) add_triangles(list, smooth_);
  SurfaceMesh all;
  if (ground.given()) add_given(ground, frozen, all);
  tree_ = TriangleTree(ground.given() ? all : smooth_);
}

/// Of what was given, that is looked for among the new walls whose nearest old ones are covered and may change.
void SmoothWalls::add_given(const Ground& ground, std::span<const std::uint8_t> frozen, SurfaceMesh& all) {
  const SurfaceMesh& walls = ground.walls().surface;
  const auto stands = [&](Vec3 p) {
    const std::uint32_t t = ground.wall_at(p);
    return t != kNone && ground.is_covered(t) && !all_frozen(walls.triangles[t], frozen);
  };
  std::vector<Ground::GivenPieces> made(ground.given()->size());
  parallel_for(made.size(), [&](std::size_t t) {
    made[t] = ground.divided_given(static_cast<std::uint32_t>(t), tolerance_, stands);
  });
  for (const Ground::GivenPieces& pieces : made) add_triangles(pieces.standing, smooth_);
  all = smooth_;
  for (const Ground::GivenPieces& pieces : made) add_triangles(pieces.others, all);
}

SmoothWalls::WallsOfParts SmoothWalls::walls_of(const Parts& mesh) {
  WallsOfParts walls;
  PointsInUse used(mesh.vertices.size());
  FlatSet<Triangle> seen;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (int i = 0; i < 4; ++i) {
      const Wall w = mesh.wall[t][static_cast<std::size_t>(i)];
      if (w == 0) continue;
      Triangle f = face_of(mesh.tets[t], i);
      if (std::all_of(f.begin(), f.end(), [&](VertexIndex v) { return mesh.vertices[v].frozen; })) continue;
      if ((w & kOuter) == 0 && !seen.insert(face_key(f))) continue;
      for (VertexIndex& v : f)
        v = used.add(v, walls.surface, walls.vertex, [&](VertexIndex u) { return mesh.vertices[u].at; });
      walls.surface.triangles.push_back(f);
    }
  return walls;
}

Deviation SmoothWalls::of(const SurfaceMesh& walls, double bound) const {
  const Deviation known = distance_of(walls, kResolution);
  return known.lower <= bound && bound < known.upper ? distance_of(walls, kFineResolution) : known;
}

Deviation SmoothWalls::distance_of(const SurfaceMesh& walls, double resolution) const {
  if (walls.triangles.empty() && smooth_.triangles.empty()) return {};
  const HausdorffBounds there = one_sided_hausdorff(walls, tree_, resolution * tolerance_);
  const HausdorffBounds back = one_sided_hausdorff(smooth_, TriangleTree(walls), resolution * tolerance_);
  const HausdorffBounds& farther = there.lower >= back.lower ? there : back;
  return {farther.lower, std::max(there.upper, back.upper), farther.place};
}

std::vector<Triangle> SmoothWalls::strays(const Parts& mesh, double bound) const {
  const WallsOfParts walls = walls_of(mesh);
  std::vector<Triangle> found = strays(walls.surface, bound);
  for (Triangle& t : found)
    for (VertexIndex& v : t) v = walls.vertex[v];
  return found;
}

std::vector<Triangle> SmoothWalls::strays(const SurfaceMesh& surface, double bound) const {
  const TriangleTree tree(surface);
  std::vector<std::uint8_t> far(surface.triangles.size(), 0);
  parallel_for(far.size(), [&](std::size_t t) {
    visit_places(corners_on(surface, surface.triangles[t]), [&](Vec3 p) {
      if (!far[t]) far[t] = !tree_.is_within(p, bound);
    });
  });
  std::vector<std::uint32_t> nearest(smooth_.triangles.size(), kNone);
  parallel_for(nearest.size(), [&](std::size_t t) {
    visit_places(corners_on(smooth_, smooth_.triangles[t]), [&](Vec3 p) {
      if (nearest[t] == kNone && !tree.is_within(p, bound)) nearest[t] = tree.nearest(p).triangle;
    });
  });
  for (const std::uint32_t t : nearest)
    if (t != kNone) far[t] = 1;
  std::vector<Triangle> found;
  for (std::size_t t = 0; t < far.size(); ++t)
    if (far[t]) found.push_back(surface.triangles[t]);
  return found;
}

}  // namespace octafront::adapt
