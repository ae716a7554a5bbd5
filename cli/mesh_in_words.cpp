#include "mesh_in_words.h"

#include <octafront/io.h>
#include <octafront/report.h>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// The groups of a mesh and their sizes, in words and for programs.
void tell_groups(Session& session, const TetMesh& mesh) {
  Json all = Json::array();
  std::string words;
  for (const GroupInfo& group : groups_of(mesh)) {
    all.push_back({{"origin", group.origin}, {"name", group.name}, {"size", group.size}});
    words += fmt::format("  {} \"{}\": {}\n", group.origin, group.name, group.size);
  }
  session.found({{"groups", all}});
  if (!words.empty()) session.say("groups:\n" + words);
}

/// Wedges and pyramids, which are several tetrahedra each.
void tell_wide_cells(Session& session, const TetMesh& mesh) {
  const auto tell = [&](const char* kind, const WideSummary& found) {
    if (found.count == 0) return;
    session.say(fmt::format(
        "{}s: {}, least scaled Jacobian {:.4f}, mean {:.4f}; the least one at ({:.6g}, {:.6g}, {:.6g})\n", kind,
        found.count, found.least_scaled_jacobian, found.mean_scaled_jacobian, found.at.x, found.at.y, found.at.z));
    session.found({{fmt::format("{}s", kind),
                    {{"count", found.count},
                     {"least_scaled_jacobian", found.least_scaled_jacobian},
                     {"mean_scaled_jacobian", found.mean_scaled_jacobian},
                     {"least_at", place(found.at)},
                     {"turned", found.turned},
                     {"torn", found.torn}}}});
  };
  tell("wedge", summarize_wedges(mesh));
  tell("pyramid", summarize_pyramids(mesh));
}

}  // namespace

Json place(Vec3 p) {
  return {p.x, p.y, p.z};
}

// A number alone is hard to find in a viewer.
void tell_worst(Session& session, const std::vector<PoorElement>& worst) {
  const PoorElement& least = worst.front();
  session.say(fmt::format("worst element: number {} at ({:.6g}, {:.6g}, {:.6g}), beta {:.4f}\n", least.tet, least.at.x,
                          least.at.y, least.at.z, least.beta));
  session.found({{"worst_element", {{"number", least.tet}, {"at", place(least.at)}, {"beta", least.beta}}}});
  Json all = Json::array();
  for (const PoorElement& e : worst)
    all.push_back({{"number", e.tet},
                   {"at", place(e.at)},
                   {"beta", e.beta},
                   {"dihedral_min_degrees", e.dihedral_min},
                   {"dihedral_max_degrees", e.dihedral_max}});
  session.found({{"worst_elements", all}});
}

std::string quality_in_words(const QualitySummary& q) {
  return fmt::format("{}; least beta {:.4f}, mean {:.4f}, dihedral angles {:.1f} to {:.1f} degrees",
                     q.elements == 1 ? "1 tetrahedron" : fmt::format("{} tetrahedra", q.elements), q.beta_min,
                     q.beta_mean, q.dihedral_min, q.dihedral_max);
}

void tell_mesh(Session& session, const TetMesh& mesh, const std::string& what) {
  Report report;
  report.points = mesh.points.size();
  report.tets = mesh.tets.size();
  report.boundary_faces = mesh.boundary.size();
  report.quality = summarize_quality(mesh);
  session.found({{"points", report.points}, {"tets", report.tets}, {"boundary_faces", report.boundary_faces}});
  session.found({{"quality", Json::parse(to_json(report))["quality"]}});
  session.say(
      fmt::format("{}: {} of {}\n", session.arguments().input.string(), what, quality_in_words(report.quality)));
  if (!mesh.tets.empty()) tell_worst(session, worst_elements(mesh, kWorstListed));
  tell_wide_cells(session, mesh);
  tell_groups(session, mesh);
}

}  // namespace octafront::cli
