#include "surface/remeshing/outcome.h"

#include "base/mesh/complex_patches.h"
#include "surface/edits/working_mesh.h"
#include "surface/lines/line_sizes.h"
#include "surface/lines/seams.h"

#include <algorithm>
#include <cmath>

namespace octafront::surface {
namespace {

/// Sizes are made smaller to come to this part of the bound, to no less than this part of themselves at once.
constexpr double kAim = 0.75, kLeastPart = 0.4;

}  // namespace

std::vector<FarPlace> far_places(const FrontWork& work, const WorkingMesh& mesh, DeviationWatch& watch) {
  if (!work.limits_deviation()) return {};
  const std::vector<std::uint32_t> number = front_triangles(mesh);
  return watch.look(sewn_triangles(mesh, number), number);
}

std::vector<Vec3> positions_beyond(double limit, const std::vector<FarPlace>& places, double end) {
  std::vector<Vec3> positions;
  for (const FarPlace& place : places)
    if (place.distance >= limit && place.distance < end) positions.push_back(place.at);
  return positions;
}

double farthest_of(const std::vector<FarPlace>& places) {
  double farthest = 0;
  for (const FarPlace& place : places) farthest = std::max(farthest, place.distance);
  return farthest;
}

std::vector<PointSize> sizes_against(const std::vector<FarPlace>& places, double tolerance, const SizeField& sizes) {
  std::vector<PointSize> wanted;
  for (const FarPlace& place : places) {
    if (place.distance < tolerance) continue;
    const double part = std::sqrt(kAim * tolerance / place.distance);
    wanted.push_back({place.at, sizes.at(place.at) * std::max(part, kLeastPart)});
  }
  return smallest_ones(std::move(wanted));
}

namespace {

/// Which vertices of the working mesh its result has: all that live, but for those of backs and of copies.
std::vector<std::uint8_t> vertices_to_keep(const WorkingMesh& mesh, const std::vector<VertexIndex>& sewn) {
  std::vector<std::uint8_t> keep(mesh.points.size(), 0);
  for (const std::uint32_t t : front_triangles(mesh))
    for (const VertexIndex v : mesh.triangle(t)) keep[sewn[v]] = 1;
  return keep;
}

}  // namespace

Outcome outcome_of(const Draft& draft, const SurfaceMesh& input) {
  const WorkingMesh& mesh = draft.mesh;
  Outcome c{{{}, {}, {}, draft.sizes}, {}, {}, draft.is_clear, draft.nearness};
  SurfaceMesh& s = c.result.surface;
  const std::vector<VertexIndex> sewn = sewn_vertices(mesh);
  const std::vector<std::uint8_t> keep = vertices_to_keep(mesh, sewn);
  const std::vector<Sides> sides = sides_of_patches(input);
  std::vector<VertexIndex> old_to_new(mesh.points.size(), kNone);
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (!keep[v]) continue;
    old_to_new[v] = static_cast<VertexIndex>(s.points.size());
    s.points.push_back(mesh.points[v]);
    c.vertex_face.push_back(mesh.face[v]);
    c.is_inner.push_back(mesh.is_free(v));
    if (mesh.kind[v] == VertexKind::kCorner) c.result.features.corners.push_back(old_to_new[v]);
  }
  s.patch_names = input.patch_names;
  s.patch_labels = input.patch_labels;
  s.region_names = input.region_names;
  s.region_labels = input.region_labels;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.is_removed(t) || mesh.is_back(t)) continue;
    Triangle triangle;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const HalfEdge h = 3 * t + i;
      triangle[i] = old_to_new[sewn[mesh.start[h]]];
      if (mesh.is_feature[h] && (h < mesh.twin[h] || mesh.is_seam(h))) {
        const VertexIndex a = triangle[i], b = old_to_new[sewn[mesh.end(h)]];
        c.result.features.edges.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    s.triangles.push_back(triangle);
    if (!input.patch.empty()) s.patch.push_back(mesh.patch[t]);
    if (!sides.empty()) s.sides.push_back(sides[mesh.patch[t]]);
  }
  std::vector<Edge>& edges = c.result.features.edges;
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());  // a seam has one in each of its parts
  for (const VertexIndex v : c.nearness.near_limit)
    if (mesh.outgoing[v] != kNone) c.result.near_limit.push_back(old_to_new[sewn[v]]);
  return c;
}

SurfaceMesh sewn_triangles(const WorkingMesh& mesh, const std::vector<std::uint32_t>& number) {
  SurfaceMesh alive;
  alive.points = mesh.points;
  const std::vector<VertexIndex> sewn = sewn_vertices(mesh);
  for (const std::uint32_t t : number) {
    const auto [a, b, c] = mesh.triangle(t);
    alive.triangles.push_back({sewn[a], sewn[b], sewn[c]});
  }
  return alive;
}

std::vector<std::uint8_t> crossing_triangles(const WorkingMesh& mesh) {
  const std::vector<std::uint32_t> number = front_triangles(mesh);
  std::vector<std::uint8_t> crossing(mesh.triangle_count(), 0);
  for (const auto& [s, t] : find_crossings(sewn_triangles(mesh, number))) crossing[number[s]] = crossing[number[t]] = 1;
  return crossing;
}

std::vector<std::uint32_t> triangles_of(const std::vector<std::array<std::uint32_t, 2>>& pairs) {
  std::vector<std::uint32_t> triangles;
  for (const auto& [s, t] : pairs) triangles.insert(triangles.end(), {s, t});
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

}  // namespace octafront::surface
