// One evaluator for every mesh, ours or a peer's: octafront_evaluate MESH [SURFACE [--kept]].
// Reads the written file back and prints one JSON object: validity, quality, and how true the boundary is to SURFACE;
// with --kept also what the surface allows at best.

#include <octafront/octafront.h>

#include "base/geometry/hausdorff.h"
#include "base/geometry/measures.h"
#include "surface_bound.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include <fmt/core.h>

namespace {

using namespace octafront;
using Json = nlohmann::ordered_json;

// Sampling density of the Hausdorff distance, as a part of the diagonal: small against the 0.5 % that is asked for.
constexpr double kHausdorffTolerance = 1e-4;

// Elements below this must be forced by the kept triangles.
constexpr double kPoor = 0.1;

SurfaceMesh boundary_of(const TetMesh& mesh) {
  SurfaceMesh boundary;
  boundary.points = mesh.points;
  boundary.triangles = mesh.boundary;
  return boundary;
}

void add_quality(Json& j, const TetMesh& mesh) {
  const QualitySummary q = summarize_quality(mesh);
  j["beta_mean"] = q.beta_mean;
  j["beta_min"] = q.beta_min;
  j["beta_classes"] = q.beta_classes;
  j["dihedral_min"] = q.dihedral_min;
  j["dihedral_max"] = q.dihedral_max;
}

void add_truth(Json& j, const TetMesh& mesh, const SurfaceMesh& input) {
  const SurfaceMesh boundary = boundary_of(mesh);
  const double diagonal = bounding_box(input.points).diagonal();
  const HausdorffBounds h = hausdorff_distance(boundary, input, kHausdorffTolerance * diagonal);
  j["hausdorff_percent"] = 100 * h.upper / diagonal;
  j["hausdorff_lower_percent"] = 100 * h.lower / diagonal;
  j["volume_percent"] = 100 * (enclosed_volume(boundary) / enclosed_volume(input) - 1);
}

Json evaluate(const std::string& mesh_file, const std::string& surface_file, bool kept) {
  const TetMesh mesh = read_mesh(mesh_file);
  SurfaceMesh input;
  if (!surface_file.empty()) input = repair_surface(read_surface(surface_file).surface).surface;
  const auto defect = kept ? first_defect(mesh, input) : first_defect(mesh);
  Json j{{"tets", mesh.tets.size()}, {"points", mesh.points.size()}, {"boundary_faces", mesh.boundary.size()}};
  double volume = 0;
  for (const Tet& t : mesh.tets)
    volume += signed_volume(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
  j["volume"] = volume;
  j["defect"] = defect ? Json(*defect) : Json(nullptr);
  add_quality(j, mesh);
  if (!input.triangles.empty()) add_truth(j, mesh, input);
  if (kept) {
    const SurfaceBound bound = bound_of(input);
    j["boundary_points"] = input.points.size();
    j["surface_beta"] = bound.beta;
    j["surface_dihedral"] = bound.dihedral;
    const PoorElements poor = poor_elements(mesh, kPoor);
    j["poor"] = {{"below", kPoor},
                 {"all", poor.all},
                 {"forced", poor.forced},
                 {"beside", poor.beside},
                 {"worst_other", poor.worst_other}};
  }
  return j;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("octafront_evaluate MESH [SURFACE [--kept]]\n", stderr);
    return 2;
  }
  try {
    const bool kept = argc > 3 && std::string(argv[3]) == "--kept";
    fmt::print("{}\n", evaluate(argv[1], argc > 2 ? argv[2] : "", kept).dump());
  } catch (const Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 3;
  }
  return 0;
}
