#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/improve_existing.h>
#include <octafront/repair.h>
#include <octafront/validity.h>

#include "core/thread_limit.h"
#include "geometry/triangle_tree.h"
#include "improve/improve.h"
#include "mesh/features.h"
#include "pipeline/follow_boundary.h"
#include "pipeline/pipeline.h"
#include "pipeline/run_stage.h"
#include "surface/surface_check.h"

#include <fmt/format.h>

namespace octafront {
namespace {

SurfaceMesh boundary_of(const TetMesh& mesh) {
  SurfaceMesh boundary;
  boundary.points = mesh.points;
  boundary.triangles = mesh.boundary;
  boundary.patch = mesh.patch;
  return boundary;
}

SurfaceMesh without_inner_points(const SurfaceMesh& surface) {
  SurfaceMesh out;
  std::vector<VertexIndex> here(surface.points.size(), kNone);
  for (Triangle t : surface.triangles) {
    for (VertexIndex& v : t) {
      if (here[v] == kNone) {
        here[v] = static_cast<VertexIndex>(out.points.size());
        out.points.push_back(surface.points[v]);
      }
      v = here[v];
    }
    out.triangles.push_back(t);
  }
  return out;
}

/// A surface for the boundary to move on, and what of either must be kept.
struct Ground {
  RepairedSurface repaired;
  Features features, of_mesh;
};

/// Vertices this near to the surface, in parts of the diagonal, lie on it: files round to seven digits.
constexpr double kOnSurface = 1e-5;

void require_on_surface(const TetMesh& mesh, const SurfaceMesh& boundary, const SurfaceMesh& surface) {
  const TriangleTree tree(surface);
  const double limit = kOnSurface * bounding_box(surface.points).diagonal();
  for (const Triangle& t : boundary.triangles)
    for (const VertexIndex v : t) {
      const Vec3 p = mesh.points[v];
      if (tree.nearest(p, limit * limit).triangle != kNone) continue;
      throw InputError(fmt::format(
          "the boundary of the mesh does not lie on the surface given: vertex {} at ({}, {}, {}) is farther from it "
          "than {:.3g}. Give the surface that was meshed, or none: then the boundary stays as it is.",
          v, p.x, p.y, p.z, limit));
    }
}

Ground prepare_ground(const TetMesh& mesh, const SurfaceMesh& surface, double feature_angle) {
  Ground g;
  g.repaired = repair_surface(surface);
  const SurfaceDefects defects = find_defects(g.repaired);
  if (!defects.clean()) throw InputError(defects.describe());
  const SurfaceMesh boundary = boundary_of(mesh);
  require_on_surface(mesh, boundary, g.repaired.surface);
  if (const auto defect = first_surface_defect(without_inner_points(boundary), g.repaired.surface))
    throw InputError("the boundary of the mesh cannot be moved on the surface given: " + *defect);
  // The patches of mesh and surface may be numbered differently; those of the mesh are kept as feature curves.
  g.repaired.surface.patch.clear();
  g.features = detect_features(g.repaired.surface, feature_angle);
  g.of_mesh = detect_features(boundary, feature_angle);
  return g;
}

void require_valid(const TetMesh& mesh) {
  if (const auto defect = first_defect(mesh)) throw InputError("not a valid mesh: " + *defect);
}

}  // namespace

Improved improve_existing(const TetMesh& mesh, const Options& options, const SurfaceMesh* surface,
                          const RunContext& context) {
  const ThreadLimit limit(context.threads);
  check_options(options);
  Improved result;
  Report& report = result.report;
  run_stage(report, context, "check of the input", [&](StageReport&) { require_valid(mesh); });
  result.mesh = mesh;
  result.before = summarize_quality(mesh);
  report.input_volume = enclosed_volume(boundary_of(mesh));
  Ground ground;
  if (surface)
    run_stage(report, context, "surface",
              [&](StageReport&) { ground = prepare_ground(mesh, *surface, options.surface.feature_angle); });
  run_stage(report, context, "improve", [&](StageReport& stage) {
    const TriangleTree tree(ground.repaired.surface);
    const improve::BoundaryInput on{ground.repaired.surface, tree, ground.features, ground.of_mesh};
    if (improve_mesh(result.mesh, surface ? &on : nullptr, options.improve, context, stage))
      renew_sources(result.mesh, boundary_of(mesh), tree, ground.repaired.face_of_triangle);
  });
  run_stage(report, context, "check", [&](StageReport&) {
    if (const auto defect = first_defect(result.mesh))
      throw MeshingError("the mesh made is not valid, which is a bug of ours; please report it with the input. " +
                         *defect);
  });
  report.points = result.mesh.points.size();
  report.tets = result.mesh.tets.size();
  report.boundary_faces = result.mesh.boundary.size();
  report.volume = enclosed_volume(boundary_of(result.mesh));
  report.quality = summarize_quality(result.mesh);
  report.hash = mesh_hash(result.mesh);
  close_report(report);
  return result;
}

}  // namespace octafront
