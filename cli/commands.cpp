#include "commands.h"

#include <octafront/octafront.h>

#include "carrying.h"
#include "domain.h"
#include "estimate.h"
#include "id_map.h"
#include "inputs.h"
#include "level_sets.h"
#include "mesh_in_words.h"
#include "metric_input.h"
#include "open_cavity.h"
#include "overlaps.h"
#include "page.h"
#include "presets.h"
#include "ranks.h"
#include "targets.h"
#include "text.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

// Files with sizes are small: they are read, and all options checked, before the input.
Options checked_options_of(const Session& session) {
  const Arguments& a = session.arguments();
  Options options = with_preset(a);
  if (!a.regions.empty()) options.size.regions = read_size_regions(a.regions.string(), session.context());
  if (!a.point_sizes.empty()) options.size.point_sizes = read_point_sizes(a.point_sizes.string(), session.context());
  if (!a.size_field.empty()) read_sizes_into(options.size, a.size_field.string(), session.context());
  check_options(options);
  return options;
}

// Invalid elements of second order are named, for solvers stop at them.
void prove_jacobians(Session& session, const TetMesh& mesh) {
  if (mesh.order() == 1) return;
  const JacobianSummary found = check_jacobians(mesh, session.context());
  session.found({{"second_order", Json::parse(to_json(found))}});
  if (found.invalid == 0) {
    session.say(fmt::format("order {}: every Jacobian proven positive; the least scaled one is {:.4f} (tet {})\n",
                            mesh.order(), found.least_scaled_jacobian, found.least_tet));
    return;
  }
  session.found({{"kind", "mesh"}, {"valid", false}});
  std::string list;
  for (const InvalidElement& e : found.first)
    list += fmt::format("\n  element {} at ({:.6g}, {:.6g}, {:.6g}): least scaled Jacobian {:.4g}", e.tet, e.at.x,
                        e.at.y, e.at.z, e.scaled_jacobian);
  throw InputError(
      fmt::format("{}: the Jacobian of {} is not positive everywhere, by the exact signs of its "
                  "coefficients{}; move nodes towards where those of straight edges are, or mesh anew:{}{}",
                  session.arguments().input.string(), counted(found.invalid, "element"),
                  found.undecided > 0 ? fmt::format(" (of {} it is too near to 0 to tell)", found.undecided) : "", list,
                  found.invalid > found.first.size() ? "\n  ..." : ""));
}

// What the solver would say, limit by limit. Returns the number of elements that it would refuse.
std::uint64_t ask_solver(Session& session, const TetMesh& mesh) {
  const Arguments& a = session.arguments();
  if (!a.solver) return 0;
  const std::vector<SolverFinding> findings = check_for_solver(mesh, *a.solver, session.context());
  std::uint64_t refused = 0;
  for (const SolverFinding& f : findings) {
    refused += f.refused ? f.count : 0;
    session.say(fmt::format("  {:<8} {:<46} {} {:<8g} {}\n", f.refused ? "refused" : "warned", f.measure,
                            f.above ? "above" : "below", f.limit, counted(f.count, "element")));
    for (const SolverFinding::Element& e : f.worst)
      session.say(fmt::format("           element {} at ({:.6g}, {:.6g}, {:.6g}): {:.6g}\n", e.tet, e.at.x, e.at.y,
                              e.at.z, e.value));
  }
  session.found({{"solver", Json::parse(to_json(findings))}});
  return refused;
}

/// A file whose elements are all the other way round has another convention, and reading them is no guess.
std::optional<std::string> inverted(const MeshFile& file) {
  const std::size_t all = file.mesh.tets.size();
  if (file.turned == 0 || file.turned == all) return std::nullopt;
  if (file.turned_wide > 0)
    return fmt::format("{} of its {} wedges and pyramids are inverted", file.turned_wide, file.mesh.wide_cells.size());
  return fmt::format("{} of its {} elements are inverted", file.turned, all);
}

void check_tet_mesh(Session& session) {
  const std::string name = session.arguments().input.string();
  const MeshFile file = read_mesh_file_input(session);
  const TetMesh& mesh = file.mesh;
  const std::uint64_t refused = ask_solver(session, mesh);
  prove_jacobians(session, mesh);
  auto defect = first_wide_defect(mesh);
  if (!defect) defect = first_defect(mesh, session.context());
  if (!defect) defect = inverted(file);
  if (!defect) defect = first_overlap(mesh, session.context());
  session.found({{"kind", "mesh"}, {"valid", !defect}});
  if (defect) throw InputError(fmt::format("{}: not a valid mesh: {}", name, *defect));
  tell_mesh(session, mesh, "a valid mesh");
  if (refused > 0) throw InputError(fmt::format("{}: the solver would refuse {}", name, counted(refused, "element")));
}

/// Of several regions each is a body; one that touches itself is as many as there are spaces in it.
std::pair<std::uint32_t, std::uint32_t> bodies_and_cavities(const RepairedSurface& clean, const RunContext& context) {
  if (clean.surface.sides.empty()) return {clean.bodies, clean.cavities};
  const BoundedSpaces spaces = bounded_spaces(clean.surface, context);
  return {clean.bodies > 1 ? clean.bodies : spaces.filled, spaces.cavities};
}

/// What small elements must fit into.
void tell_smallest(Session& session, const SurfaceMesh& clean) {
  const SmallestFeatures small = smallest_features(clean, kDefaultFeatureAngle, session.context());
  const auto at = [](Vec3 p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); };
  if (small.thickness < SmallestFeatures::kNone) {
    const auto part = [](double width) { return width < SmallestFeatures::kNone ? Json(width) : Json(nullptr); };
    session.found({{"thickness",
                    {{"least", small.thickness},
                     {"at", place(small.thinnest_at)},
                     {"tenth", part(small.thin_tenth)},
                     {"half", part(small.thin_half)}}}});
    session.say(fmt::format("  thinnest {:.4g}, at {}\n", small.thickness, at(small.thinnest_at)));
  }
  if (!(small.shortest_edge < SmallestFeatures::kNone)) return;
  session.found({{"shortest_edge", {{"length", small.shortest_edge}, {"at", place(small.shortest_at)}}}});
  session.say(fmt::format("  shortest edge {:.4g}, at {}\n", small.shortest_edge, at(small.shortest_at)));
}

void check_surface(Session& session) {
  const std::string name = session.arguments().input.string();
  IntakeOptions as_it_is = session.arguments().intake;
  as_it_is.repair = IntakeOptions::Repair::kOff;
  const Domain domain = open_input(session, as_it_is);
  session.context().report("checking", -1);
  const RepairedSurface repaired = repair_surface(domain.surface, session.context());
  for (const std::string& note : repaired.notes) session.say("would repair: " + note + "\n");
  const SurfaceDefects defects = find_defects(repaired, session.context());
  session.found({{"kind", "surface"},
                 {"format", domain.format},
                 {"triangles", domain.surface.triangles.size()},
                 {"clean", defects.clean()},
                 {"repairs", repaired.notes},
                 {"defects", Json::parse(to_json(defects))}});
  if (!defects.clean()) throw InputError(fmt::format("{}:\n{}", name, defects.describe()));
  const double volume = enclosed_volume(repaired.surface);
  const auto [bodies, cavities] = bodies_and_cavities(repaired, session.context());
  session.found({{"bodies", bodies}, {"cavities", cavities}, {"volume", volume}});
  session.say(fmt::format("{}: clean: {} {}, {} {}, volume {:.6g}\n", name, bodies, bodies == 1 ? "body" : "bodies",
                          cavities, cavities == 1 ? "cavity" : "cavities", volume));
  tell_smallest(session, repaired.surface);
}

/// What there is to a surface that is refused.
Json defects_in_json(const SurfaceDefects& defects) {
  return {{"kind", "surface"}, {"clean", defects.clean()}, {"defects", Json::parse(to_json(defects))}};
}

/// Runs work(); of a mesh that is not what was required the report is told, and no file is written.
template <class Work>
auto telling_what_was_made(Session& session, const Work& work) {
  try {
    return work();
  } catch (const RequirementError& error) {
    if (session.is_first()) session.tell(error.report);
    throw;
  }
}

// Runs one of the library's generators on the input; its refusals name the file.
template <class Generator>
auto run_on_input(Session& session, const Generator& generator) {
  const Arguments& a = session.arguments();
  Options options = checked_options_of(session);
  Domain domain;
  together(session.context().ranks, "input", [&] { domain = open_input(session, intake_for(options, a.intake)); });
  add_sizes_of_head(a, domain, options);
  if (a.writing.job) check_job(*a.writing.job, expected_place_names(domain, options));
  try {
    if (!a.page.empty()) find_repairs(session, domain.surface);
    return telling_what_was_made(session, [&] { return generator(domain, options, session.context()); });
  } catch (const OpenCavityError& error) {
    if (!session.is_first()) throw;
    const std::filesystem::path beside = cavity_neighbour(a);
    throw with_cavity_written(error, beside.empty() ? "octafront" : beside);
  } catch (const DefectsError& error) {
    session.found(defects_in_json(error.defects));
    throw InputError(fmt::format("{}: {}", a.input.string(), error.what()));
  } catch (const InputError& error) {
    tell_defects(session, domain.surface);
    throw InputError(fmt::format("{}: {}", a.input.string(), error.what()));
  }
}

void say_written(const Session& session) {
  const Arguments& a = session.arguments();
  std::vector<std::filesystem::path> all = a.meshes;
  all.insert(all.end(), {a.output, a.page});
  for (const std::filesystem::path& file : all)
    if (!file.empty()) session.say(fmt::format("written: {}\n", file.string()));
}

/// The last step of a run that made a mesh: its page, if one is wanted.
void finish_run(Session& session, const TetMesh& mesh, const SizeField* sizes) {
  if (!session.arguments().page.empty()) write_page(session.arguments().page, session, mesh, sizes);
  say_written(session);
}

// Which of the two files that improvement reads is at fault: the surface if it is not clean by itself.
std::filesystem::path file_at_fault(const Arguments& a, const SurfaceMesh& surface) {
  const bool is_surface = !a.surface.empty() && !find_defects(repair_surface(surface)).clean();
  return is_surface ? a.surface : a.input;
}

/// What a job names is looked for before the work; the mesh will have what it has, and its further groups.
void check_job_on(const Arguments& a, const TetMesh& mesh) {
  if (!a.writing.job) return;
  PlaceNames there = place_names(mesh);
  for (const std::string& group : a.options.groups) there.sets.push_back(group_rule(group).name);
  check_job(*a.writing.job, there);
}

/// They stand with the file that has them, too.
std::vector<std::string> notes_on_groups(const Report& report) {
  const auto groups = std::ranges::find(report.stages, "groups", &StageReport::name);
  return groups == report.stages.end() ? std::vector<std::string>() : groups->notes;
}

}  // namespace

void run_mesh(Session& session) {
  const Arguments& a = session.arguments();
  if (a.dry_run) return tell_estimate(session, run_on_input(session, generate_sizes));
  together(session.context().ranks, "output", [&] {
    if (!session.is_first()) return;
    check_mesh_targets(a);
    check_page_target(a.page);
  });
  Result result = run_on_input(session, [&](const Domain& domain, const Options& options, const RunContext& context) {
    if (context.ranks != nullptr) context.ranks->shares_tets = true;
    return generate(domain, options, context);
  });
  if (result.is_share && !takes_shares(a)) gather_at_first(result, session.context());
  const std::vector<PoorElement> worst = worst_elements(result, kWorstListed, session.context());
  tell_ranks(session, result.report);
  if (result.is_share) write_share_targets(session, result.mesh);
  if (!session.is_first()) return;
  if (!result.is_share) write_mesh_targets(session, result.mesh, {}, notes_on_groups(result.report));
  recommend_second_order(a, result.report);
  session.tell(result.report);
  tell_worst(session, worst);
  finish_run(session, result.mesh, &result.sizes);
}

void run_surface(Session& session) {
  const Arguments& a = session.arguments();
  check_surface_target(a.output.string());
  const SurfaceResult result = run_on_input(session, generate_surface);
  session.context().report("writing", -1);
  write_surface(a.output.string(), result.surface, session.context());
  session.tell(result.report);
  say_written(session);
}

void run_repair(Session& session) {
  const Arguments& a = session.arguments();
  check_surface_target(a.output.string());
  IntakeOptions options = a.intake;
  options.tidies = true;
  const Domain domain = open_input(session, options);
  session.context().report("writing", -1);
  write_surface(a.output.string(), domain.surface, session.context());
  say_written(session);
}

void run_size(Session& session) {
  const Arguments& a = session.arguments();
  if (!a.output.empty()) check_size_field_target(a.output.string());
  const SizeResult result = run_on_input(session, generate_sizes);
  if (!a.output.empty()) write_size_field(a.output.string(), result.sizes, session.context());
  session.tell(result.report);
  if (!a.output.empty()) say_written(session);
}

void run_improve(Session& session) {
  const Arguments& a = session.arguments();
  check_mesh_targets(a);
  check_page_target(a.page);
  check_options(a.options);
  const TetMesh mesh = read_mesh_input(session);
  check_job_on(a, mesh);
  const std::vector<MeshField> fields = fields_to_carry(session, mesh);
  SurfaceMesh surface;
  if (!a.surface.empty()) surface = read_surface(a.surface.string(), session.context()).surface;
  const auto improved = [&] {
    try {
      return telling_what_was_made(session, [&] {
        return improve_existing(mesh, a.options, a.surface.empty() ? nullptr : &surface, session.context());
      });
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", file_at_fault(a, surface).string(), error.what()));
    }
  };
  const Improved result = improved();
  write_mesh_targets(session, result.mesh, carried_fields(session, fields, mesh, result.mesh, OutsideNodes::kOnwards));
  session.say(fmt::format("{}: {}\n", a.input.string(), quality_in_words(result.before)));
  session.say(fmt::format("improved: {}\n", quality_in_words(result.report.quality)));
  session.tell(result.report);
  tell_worst(session, worst_elements(result.mesh, kWorstListed));
  finish_run(session, result.mesh, nullptr);
}

namespace {

/// Of a mesh or a surface.
template <class Adapted>
void tell_adapted(Session& session, const Adapted& result) {
  session.found({{"fit", Json::parse(to_json(result.after))}, {"deviation", Json::parse(to_json(result.deviation))}});
  session.tell(result.report);
}

/// Runs work(); its refusals name the input.
template <class Work>
auto on_adapted_input(Session& session, const Work& work) {
  try {
    return telling_what_was_made(session, work);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", session.arguments().input.string(), error.what()));
  }
}

/// Options that mean something for tetrahedra alone.
void refuse_for_surfaces(const Arguments& a) {
  const auto refuse = [](bool given, const char* option) {
    if (given)
      throw OptionError(fmt::format("{} is for meshes of tetrahedra, and the input is a surface alone", option));
  };
  refuse(!a.options.adapt.only.empty(), "--only"), refuse(!a.map_file.empty(), "--map"),
      refuse(!a.field.empty(), "--from");
  refuse(!a.level_sets.empty(), "--level-set"), refuse(!a.carry.empty(), "--carry"),
      refuse(!a.page.empty(), "--report"), refuse(!a.options.groups.empty(), "--group");
}

/// Triangles alone, as files have them; the sets that they had.
TetMesh mesh_of_triangles(Session& session, SurfaceMesh surface, const SurfaceFile& file) {
  TetMesh mesh;
  mesh.points = std::move(surface.points), mesh.boundary = std::move(surface.triangles);
  mesh.patch = std::move(surface.patch), mesh.patch_names = std::move(surface.patch_names);
  mesh.patch_labels = std::move(surface.patch_labels);
  if (const std::string missing = add_placed_sets(mesh, file.sets); !missing.empty())
    session.say_notes("sets", {missing});
  return mesh;
}

void adapt_surface_input(Session& session) {
  const Arguments& a = session.arguments();
  refuse_for_surfaces(a);
  check_surface_targets(a);
  const Options options = checked_options_of(session);
  const SurfaceFile file = read_input(session);
  const SurfaceMesh& surface = file.surface;
  const std::optional<MetricMesh> metric = metric_asked_for(session, TetMesh{});
  const std::optional<Domain> ground = open_ground(session);
  const Domain* home = ground ? &*ground : nullptr;
  AdaptedSurface result = on_adapted_input(session, [&] {
    return metric ? adapt_surface_to_metric(surface, *metric, options, session.context(), home, file.sets)
                  : adapt_surface(surface, options, session.context(), home, file.sets);
  });
  write_mesh_targets(session, mesh_of_triangles(session, std::move(result.surface), file));
  tell_adapted(session, result);
  say_written(session);
}

}  // namespace

void run_adapt(Session& session) {
  const Arguments& a = session.arguments();
  check_mesh_targets(a);
  check_map_target(a.map_file);
  check_page_target(a.page);
  check_metric_options(a);
  if (!a.level_sets.empty() && !a.map_file.empty())
    throw OptionError("--map: where elements are divided along --level-set no old number is kept");
  if (!is_tet_mesh_file(a.input.string()) || !holds_tetrahedra(a.input.string(), session.context()))
    return adapt_surface_input(session);
  const Options options = checked_options_of(session);
  TetMesh mesh = read_mesh_input(session);
  if (a.level_sets.empty()) check_job_on(a, mesh);
  const std::optional<MetricMesh> metric = metric_asked_for(session, mesh);
  std::vector<MeshField> fields = fields_to_carry(session, mesh);
  if (!a.level_sets.empty()) cut_along_fields(session, mesh, fields);
  const std::optional<Domain> ground = open_ground(session);
  const Domain* home = ground ? &*ground : nullptr;
  const AdaptedMesh result = on_adapted_input(session, [&] {
    return metric ? adapt_to_metric(mesh, *metric, options, session.context(), home)
                  : adapt_existing(mesh, options, session.context(), home);
  });
  const KnownItems same{result.old_of_new, result.old_tet_of_new};
  write_mesh_targets(session, result.mesh,
                     carried_fields(session, fields, mesh, result.mesh, OutsideNodes::kOnwards, &same));
  if (!a.map_file.empty()) write_map(a.map_file, mesh, result);
  tell_adapted(session, result);
  tell_worst(session, worst_elements(result.mesh, kWorstListed));
  finish_run(session, result.mesh, nullptr);
}

namespace {

void convert_surface_input(Session& session) {
  const Arguments& a = session.arguments();
  check_surface_targets(a);
  if (a.new_order > 1) throw OptionError("--order above 1 is for tetrahedra, and the input is a surface alone");
  const SurfaceFile file = read_input(session);
  write_mesh_targets(session, mesh_of_triangles(session, file.surface, file));
  say_written(session);
}

}  // namespace

void run_convert(Session& session) {
  const Arguments& a = session.arguments();
  check_mesh_targets(a);
  // A pipe can be read once.
  if (std::filesystem::is_regular_file(a.input) && !holds_tetrahedra(a.input.string(), session.context()))
    return convert_surface_input(session);
  TetMesh mesh = read_mesh_input(session);
  std::vector<MeshField> fields = all_fields(session, mesh);
  if (a.new_order > 0 && a.new_order != mesh.order()) {
    make_linear(mesh);
    const std::size_t corners = mesh.points.size();
    if (a.new_order > 1) make_curved(mesh, a.new_order, nullptr, 40, session.context());
    keep_fields_of_corners(session, fields, corners, mesh.points.size());
  }
  // Whoever converts wants the mesh as it is; but nobody should find out in the solver.
  if (const auto defect = first_defect(mesh, session.context()))
    session.say_notes("checking", {"the mesh is not valid: " + *defect});
  write_mesh_targets(session, mesh, fields);
  say_written(session);
}

void run_check(Session& session) {
  const Arguments& a = session.arguments();
  if (a.bodies.size() == 1 && is_tet_mesh_file(a.input.string()) && holds_tetrahedra(a.input.string()))
    return check_tet_mesh(session);
  if (session.arguments().solver) throw OptionError("--solver looks at tetrahedral meshes; this is a surface");
  check_surface(session);
}

void run_report(Session& session) {
  const Arguments& a = session.arguments();
  check_page_target(a.output);
  const TetMesh mesh = read_mesh_input(session);
  const auto defect = first_defect(mesh, session.context());
  session.found({{"kind", "mesh"}, {"valid", !defect}});
  if (defect) session.say_notes("checking", {"the mesh is not valid: " + *defect});
  tell_mesh(session, mesh, defect ? "a mesh that is not valid" : "a valid mesh");
  write_page(a.output, session, mesh, nullptr);
  say_written(session);
}

}  // namespace octafront::cli
