#include "commands.h"

#include <octafront/octafront.h>

#include "domain.h"
#include "open_cavity.h"
#include "text.h"

#include <fmt/core.h>

namespace octafront::cli {

namespace {

// Files with sizes are small: they are read, and all options checked, before the input.
Options checked_options(const Session& session) {
  const Arguments& a = session.arguments();
  Options options = a.options;
  if (!a.regions.empty()) options.size.regions = read_size_regions(a.regions, session.context());
  if (!a.point_sizes.empty()) options.size.point_sizes = read_point_sizes(a.point_sizes, session.context());
  if (!a.size_field.empty())
    options.size.field = read_size_field(a.size_field, options.size.gradation, session.context());
  check_options(options);
  return options;
}

// Tetrahedral meshes are told from surfaces by the ending: no surface format shares one with them.
bool is_tet_mesh_file(const std::filesystem::path& file) {
  const std::string ending = CLI::detail::to_lower(file.extension().string());
  for (const FormatInfo& info : known_formats())
    for (const std::string& known : CLI::detail::split(std::string(info.endings), ' '))
      if (info.reads_mesh && !ending.empty() && ending == known) return true;
  return false;
}

TetMesh read_mesh_input(const Session& session) {
  const Arguments& a = session.arguments();
  MeshFile file = read_mesh_file(a.input, session.context());
  session.say(fmt::format("{}: {}, {} tetrahedra{}\n", a.input.string(), file.format, file.mesh.tets.size(),
                          file.mesh.is_second_order() ? " of second order" : ""));
  session.say_notes("reading", file.notes);
  return std::move(file.mesh);
}

/// Adds the groups that were asked for, writes the mesh, and says what was lost on the way.
void write_mesh_output(Session& session, TetMesh mesh) {
  const Arguments& a = session.arguments();
  std::vector<std::string> notes;
  for (const GroupRule& rule : a.groups)
    if (std::string note = add_group(mesh, rule); !note.empty()) notes.push_back(std::move(note));
  session.context().report("writing", -1);
  for (std::string& note : write_mesh(a.output, mesh, session.context(), a.format)) notes.push_back(std::move(note));
  session.say_notes("writing", notes);
  session.found({{"output", {{"file", a.output.string()}, {"notes", notes}}}});
}

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

Json place(Vec3 p) {
  return {p.x, p.y, p.z};
}

Vec3 middle(const TetMesh& mesh, TetIndex tet) {
  const auto& [a, b, c, d] = mesh.tets[tet];
  return (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]) / 4;
}

// A number alone is hard to find in a viewer.
void tell_worst(Session& session, const TetMesh& mesh, const QualitySummary& quality) {
  const Vec3 p = middle(mesh, quality.beta_min_tet);
  session.say(fmt::format("worst element: number {} at ({:.6g}, {:.6g}, {:.6g}), beta {:.4f}\n", quality.beta_min_tet,
                          p.x, p.y, p.z, quality.beta_min));
  session.found({{"worst_element", {{"number", quality.beta_min_tet}, {"at", place(p)}, {"beta", quality.beta_min}}}});
}

std::string quality_in_words(const QualitySummary& q) {
  return fmt::format("{}; least beta {:.4f}, mean {:.4f}, dihedral angles {:.1f} to {:.1f} degrees",
                     q.elements == 1 ? "1 tetrahedron" : fmt::format("{} tetrahedra", q.elements), q.beta_min,
                     q.beta_mean, q.dihedral_min, q.dihedral_max);
}

Json json_of(const JacobianSummary& found) {
  Json first = Json::array();
  for (const InvalidElement& e : found.first)
    first.push_back({{"number", e.tet}, {"at", place(e.at)}, {"scaled_jacobian", e.scaled_jacobian}});
  return {{"least_scaled_jacobian", found.least_scaled_jacobian},
          {"least_tet", found.least_tet},
          {"invalid", found.invalid},
          {"first", first}};
}

// Invalid elements of second order are named, for solvers stop at them.
void prove_jacobians(Session& session, const TetMesh& mesh) {
  if (!mesh.is_second_order()) return;
  const JacobianSummary found = check_jacobians(mesh, session.context());
  session.found({{"second_order", json_of(found)}});
  if (found.invalid == 0) {
    session.say(fmt::format("second order: every Jacobian proven positive; the least scaled one is {:.4f} (tet {})\n",
                            found.least_scaled_jacobian, found.least_tet));
    return;
  }
  session.found({{"kind", "mesh"}, {"valid", false}});
  std::string list;
  for (const InvalidElement& e : found.first)
    list += fmt::format("\n  element {} at ({:.6g}, {:.6g}, {:.6g}): least scaled Jacobian {:.4g}", e.tet, e.at.x,
                        e.at.y, e.at.z, e.scaled_jacobian);
  throw InputError(
      fmt::format("{}: the Jacobian of {} is not positive everywhere, by the exact signs of its "
                  "coefficients; move mid-side nodes towards the middle of their edges, or mesh anew:{}{}",
                  session.arguments().input.string(), counted(found.invalid, "element"), list,
                  found.invalid > found.first.size() ? "\n  ..." : ""));
}

Json json_of(const SolverFinding& f) {
  Json worst = Json::array();
  for (const SolverFinding::Element& e : f.worst)
    worst.push_back({{"number", e.tet}, {"at", place(e.at)}, {"value", e.value}});
  return {{"measure", f.measure},
          {"refused", f.refused},
          {f.above ? "above" : "below", f.limit},
          {"count", f.count},
          {"worst", worst}};
}

// What the solver would say, limit by limit. Returns the number of elements that it would refuse.
std::uint64_t ask_solver(Session& session, const TetMesh& mesh) {
  const Arguments& a = session.arguments();
  if (!a.solver) return 0;
  Json all = Json::array();
  std::uint64_t refused = 0;
  for (const SolverFinding& f : check_for_solver(mesh, *a.solver, session.context())) {
    all.push_back(json_of(f));
    refused += f.refused ? f.count : 0;
    session.say(fmt::format("  {:<8} {:<46} {} {:<8g} {}\n", f.refused ? "refused" : "warned", f.measure,
                            f.above ? "above" : "below", f.limit, counted(f.count, "element")));
    for (const SolverFinding::Element& e : f.worst)
      session.say(fmt::format("           element {} at ({:.6g}, {:.6g}, {:.6g}): {:.6g}\n", e.tet, e.at.x, e.at.y,
                              e.at.z, e.value));
  }
  session.found({{"solver", all}});
  return refused;
}

void check_tet_mesh(Session& session) {
  const std::string name = session.arguments().input.string();
  const TetMesh mesh = read_mesh_input(session);
  const std::uint64_t refused = ask_solver(session, mesh);
  prove_jacobians(session, mesh);
  const auto defect = first_defect(mesh, session.context());
  session.found({{"kind", "mesh"}, {"valid", !defect}});
  if (defect) throw InputError(fmt::format("{}: not a valid mesh: {}", name, *defect));
  Report report;
  report.points = mesh.points.size();
  report.tets = mesh.tets.size();
  report.boundary_faces = mesh.boundary.size();
  report.quality = summarize_quality(mesh);
  session.found({{"points", report.points}, {"tets", report.tets}, {"boundary_faces", report.boundary_faces}});
  session.found({{"quality", Json::parse(to_json(report))["quality"]}});
  session.say(fmt::format("{}: a valid mesh of {}\n", name, quality_in_words(report.quality)));
  tell_worst(session, mesh, report.quality);
  tell_groups(session, mesh);
  if (refused > 0) throw InputError(fmt::format("{}: the solver would refuse {}", name, counted(refused, "element")));
}

Json json_of(const SurfaceDefects::Kind& kind) {
  Json first = Json::array();
  for (const SurfaceDefects::Place& p : kind.first) first.push_back({{"at", place(p.at)}, {"faces", p.faces}});
  return {{"count", kind.count}, {"first", first}};
}

Json json_of(const SurfaceDefects& d) {
  return {{"open_edges", json_of(d.open_edges)},
          {"open_loops", d.open_loops},
          {"non_manifold_edges", json_of(d.non_manifold_edges)},
          {"misoriented_edges", json_of(d.misoriented_edges)},
          {"non_manifold_vertices", json_of(d.non_manifold_vertices)},
          {"self_intersections", json_of(d.self_intersections)},
          {"degenerate_faces", json_of(d.degenerate_faces)}};
}

void check_surface(Session& session) {
  const std::string name = session.arguments().input.string();
  const SurfaceFile file = read_domain(session);
  session.context().report("checking", -1);
  const RepairedSurface repaired = repair_surface(file.surface, session.context());
  for (const std::string& note : repaired.notes) session.say("would repair: " + note + "\n");
  const SurfaceDefects defects = find_defects(repaired, session.context());
  session.found({{"kind", "surface"},
                 {"format", file.format},
                 {"triangles", file.surface.triangles.size()},
                 {"clean", defects.clean()},
                 {"repairs", repaired.notes},
                 {"defects", json_of(defects)}});
  if (!defects.clean()) throw InputError(fmt::format("{}:\n{}", name, defects.describe()));
  const double volume = enclosed_volume(repaired.surface);
  session.found({{"bodies", repaired.bodies}, {"cavities", repaired.cavities}, {"volume", volume}});
  session.say(fmt::format("{}: clean: {} {}, {} {}, volume {:.6g}\n", name, repaired.bodies,
                          repaired.bodies == 1 ? "body" : "bodies", repaired.cavities,
                          repaired.cavities == 1 ? "cavity" : "cavities", volume));
}

// Runs one of the library's generators on the input; its refusals name the file.
template <class Generator>
auto run_on_input(Session& session, const Generator& generator) {
  const Arguments& a = session.arguments();
  const Options options = checked_options(session);
  const SurfaceFile file = read_domain(session);
  try {
    return generator(file.surface, options, session.context());
  } catch (const OpenCavityError& error) {
    throw with_cavity_written(error, a.output);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", a.input.string(), error.what()));
  }
}

void say_written(const Session& session) {
  session.say(fmt::format("written: {}\n", session.arguments().output.string()));
}

// Which of the two files that improvement reads is at fault: the surface if it is not clean by itself.
std::filesystem::path file_at_fault(const Arguments& a, const SurfaceMesh& surface) {
  const bool is_surface = !a.surface.empty() && !find_defects(repair_surface(surface)).clean();
  return is_surface ? a.surface : a.input;
}

}  // namespace

void run_mesh(Session& session) {
  const Arguments& a = session.arguments();
  check_mesh_target(a.output, a.format);
  const Result result = run_on_input(session, generate);
  write_mesh_output(session, result.mesh);
  session.tell(result.report);
  tell_worst(session, result.mesh, result.report.quality);
  say_written(session);
}

void run_surface(Session& session) {
  const Arguments& a = session.arguments();
  check_surface_target(a.output);
  const SurfaceResult result = run_on_input(session, generate_surface);
  session.context().report("writing", -1);
  write_surface(a.output, result.surface, session.context());
  session.tell(result.report);
  say_written(session);
}

void run_size(Session& session) {
  const Arguments& a = session.arguments();
  if (!a.output.empty()) check_size_field_target(a.output);
  const SizeResult result = run_on_input(session, generate_sizes);
  if (!a.output.empty()) write_size_field(a.output, result.sizes, session.context());
  session.tell(result.report);
  if (!a.output.empty()) say_written(session);
}

void run_improve(Session& session) {
  const Arguments& a = session.arguments();
  check_mesh_target(a.output, a.format);
  check_options(a.options);
  const TetMesh mesh = read_mesh_input(session);
  SurfaceMesh surface;
  if (!a.surface.empty()) surface = read_surface(a.surface, session.context()).surface;
  const auto improved = [&] {
    try {
      return improve_existing(mesh, a.options, a.surface.empty() ? nullptr : &surface, session.context());
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", file_at_fault(a, surface).string(), error.what()));
    }
  };
  const Improved result = improved();
  write_mesh_output(session, result.mesh);
  session.say(fmt::format("{}: {}\n", a.input.string(), quality_in_words(result.before)));
  session.say(fmt::format("improved: {}\n", quality_in_words(result.report.quality)));
  session.tell(result.report);
  tell_worst(session, result.mesh, result.report.quality);
  say_written(session);
}

void run_convert(Session& session) {
  const Arguments& a = session.arguments();
  check_mesh_target(a.output, a.format);
  TetMesh mesh = read_mesh_input(session);
  if (a.new_order == 1) make_linear(mesh);
  if (a.new_order == 2 && !mesh.is_second_order()) make_second_order(mesh, nullptr, 40, session.context());
  // Whoever converts wants the mesh as it is; but nobody should find out in the solver.
  if (const auto defect = first_defect(mesh, session.context()))
    session.say_notes("checking", {"the mesh is not valid: " + *defect});
  write_mesh_output(session, std::move(mesh));
  say_written(session);
}

void run_check(Session& session) {
  const Arguments& a = session.arguments();
  if (a.bodies.size() == 1 && is_tet_mesh_file(a.input) && holds_tetrahedra(a.input)) return check_tet_mesh(session);
  if (session.arguments().solver) throw OptionError("--solver looks at tetrahedral meshes; this is a surface");
  check_surface(session);
}

}  // namespace octafront::cli
