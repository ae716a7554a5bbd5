#include "base/geometry/self_intersection.h"
#include "improve/passes/mesh_editor.h"
#include "improve/passes/passes.h"
#include "improve/passes/star_edit.h"

#include <algorithm>

namespace octafront::improve {
namespace {

/// Parts of the way back that a vertex is tried at.
constexpr double kPartsOfWayBack[] = {1, 0.5, 0.25};
/// What did not go back in so many rounds, each of which looks farther around, is left.
constexpr int kTakeBackRounds = 4;

/// Vertices of triangles of the boundary that cross, and of those `around` triangles away.
std::vector<std::uint8_t> beside_crossings(const EditMesh& mesh, int around) {
  std::vector<std::uint8_t> near(mesh.vertices(), 0);
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (!mesh.is_removed(t)) triangles.push_back(mesh.triangle(t));
  std::vector<Vec3> points(mesh.vertices());
  for (VertexIndex v = 0; v < points.size(); ++v) points[v] = mesh.point(v);
  for (const auto& pair : self_intersections(points, triangles))
    for (const std::uint32_t t : pair)
      for (const VertexIndex v : triangles[t]) near[v] = 1;
  for (int k = 0; k < around; ++k) {
    std::vector<std::uint8_t> wider = near;
    for (const Triangle& t : triangles)
      if (near[t[0]] || near[t[1]] || near[t[2]])
        for (const VertexIndex v : t) wider[v] = 1;
    near = std::move(wider);
  }
  return near;
}

/// Takes a vertex back as far as the elements around it allow.
bool take_back(MeshEditor& editor, StarEdit& star, VertexIndex v, Vec3 home, const Floor& floor) {
  std::vector<HalfFace> walked;
  editor.star(v, walked);
  if (!star.load(v, walked)) return false;
  const Vec3 p = editor.mesh().point(v);
  for (const double step : kPartsOfWayBack) {
    const Vec3 to = step == 1 ? home : p + (home - p) * step;
    star.evaluate(to);
    if (!star.acceptable(to, floor)) continue;
    star.commit();
    return true;
  }
  return false;
}

}  // namespace

TakenBack take_back_crossings(EditMesh& mesh, std::span<const Vec3> home, const BoundaryGuide& guide,
                              const RunContext& context) {
  TakenBack result;
  for (int round = 0; round <= kTakeBackRounds; ++round) {
    std::vector<std::uint8_t> near = beside_crossings(mesh, round);
    if (std::find(near.begin(), near.end(), 1) == near.end()) return result;
    if (round == kTakeBackRounds) break;
    context.check();
    const Floor floor = mesh.floor();
    MeshEditor editor(mesh);
    StarEdit star(mesh);
    for (VertexIndex v = 0; v < near.size(); ++v) {
      if (!near[v] || !guide.may_slide(v) || mesh.point(v) == home[v]) continue;
      ++result.pass.tried;
      result.pass.done += take_back(editor, star, v, home[v], floor);
    }
  }
  const std::vector<std::uint8_t> near = beside_crossings(mesh, 1);
  for (VertexIndex v = 0; v < near.size(); ++v)
    if (near[v]) result.crossing.push_back(v);
  return result;
}

}  // namespace octafront::improve
