#include <octafront/surface_mesh.h>

#include "surface/remeshing/mend_folds.h"

namespace octafront::surface {

namespace {

/// The input with its patch borders as the only lines.
WorkingMesh bordered(const InputSurface& input) {
  WorkingMesh mesh(input);
  std::vector<int> borders(mesh.points.size(), 0);
  for (HalfEdge h = 0; h < mesh.start.size(); ++h) {
    if (mesh.patch[h / 3] == mesh.patch[mesh.twin[h] / 3]) continue;
    mesh.is_feature[h] = 1;
    ++borders[mesh.start[h]];
  }
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    mesh.kind[v] = borders[v] == 0 ? VertexKind::kFree : borders[v] == 2 ? VertexKind::kCurve : VertexKind::kCorner;
  }
  return mesh;
}

Unfolded unfolded(const WorkingMesh& mesh, const SurfaceMesh& input, MendedFolds mended) {
  SurfaceMesh surface;
  std::vector<double> moved;
  std::vector<VertexIndex> renumbered(mesh.points.size(), kNone);
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (mesh.outgoing[v] == kNone) continue;
    renumbered[v] = static_cast<VertexIndex>(surface.points.size());
    surface.points.push_back(mesh.points[v]);
  }
  surface.patch_names = input.patch_names;
  surface.patch_labels = input.patch_labels;
  surface.region_names = input.region_names;
  surface.region_labels = input.region_labels;
  for (const std::uint32_t t : mesh.alive_triangles()) {
    const auto [a, b, c] = mesh.triangle(t);
    surface.triangles.push_back({renumbered[a], renumbered[b], renumbered[c]});
    if (!input.patch.empty()) surface.patch.push_back(mesh.patch[t]);
    surface.source.push_back(input.source_of(t));
    moved.push_back(mended.moved[t]);
  }
  mended.moved = std::move(moved);
  return {std::move(surface), std::move(mended)};
}

}  // namespace

std::optional<Unfolded> unfold(const SurfaceMesh& surface, const EdgeTable& edges, double tolerance,
                               const RunContext& context) {
  WorkingMesh mesh = bordered(make_input_surface(surface, edges));
  const std::vector<std::uint8_t> none_fixed;
  MendedFolds mended = mend_folds(mesh, {.tolerance = tolerance, .total = tolerance, .is_fixed = none_fixed}, context);
  if (mended.operations == 0) return std::nullopt;
  return unfolded(mesh, surface, std::move(mended));
}

}  // namespace octafront::surface
