#include "commands.h"

#include <octafront/octafront.h>

#include "open_cavity.h"
#include "terminal.h"

#include <cstdio>

#include <fmt/format.h>

namespace octafront::cli {

namespace {

void say(const Arguments& a, const std::string& text) {
  clear_progress();
  if (!a.quiet) std::fputs(text.c_str(), stdout);
}

SurfaceFile read_input(const Arguments& a, const RunContext& context) {
  context.report("reading", -1);
  SurfaceFile file = read_surface(a.input);
  say(a, fmt::format("{}: {}, {} triangles\n", a.input.string(), file.format, file.surface.triangles.size()));
  for (const std::string& note : file.notes) say(a, "note (reading): " + note + "\n");
  return file;
}

// With what the files of sizes say.
Options options_for(const Arguments& a, const RunContext& context) {
  Options options = a.options;
  if (!a.regions.empty()) options.size.regions = read_size_regions(a.regions);
  if (!a.size_field.empty()) options.size.point_sizes = read_point_sizes(a.size_field);
  if (!a.size_grid.empty()) options.size.field = read_size_field(a.size_grid, options.size.gradation, context);
  return options;
}

void write_report(const Arguments& a, const Report& report) {
  say(a, to_table(report));
  if (!a.json.empty()) write_text(a.json, to_json(report));
}

// Tetrahedral meshes are told from surfaces by the ending: no surface format shares one with them.
bool is_tet_mesh_file(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".vtu" || ending == ".msh" || ending == ".mesh";
}

std::string quality_in_words(const QualitySummary& q) {
  return fmt::format("{} tetrahedra; least beta {:.4f}, mean {:.4f}, dihedral angles {:.1f} to {:.1f} degrees",
                     q.elements, q.beta_min, q.beta_mean, q.dihedral_min, q.dihedral_max);
}

int check_tet_mesh(const Arguments& a) {
  const TetMesh mesh = read_mesh(a.input);
  const auto defect = first_defect(mesh);
  if (defect) throw InputError(fmt::format("{}: not a valid mesh: {}", a.input.string(), *defect));
  say(a, fmt::format("{}: a valid mesh of {}\n", a.input.string(), quality_in_words(summarize_quality(mesh))));
  return 0;
}

// Runs one of the library's generators on the input; its refusals name the file.
template <class Generator>
auto run_on_input(const Arguments& a, const RunContext& context, const Generator& generator) {
  const SurfaceFile file = read_input(a, context);
  try {
    return generator(file.surface, options_for(a, context), context);
  } catch (const OpenCavityError& error) {
    throw with_cavity_written(error, a.output);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", a.input.string(), error.what()));
  }
}

// Everything that can be known to fail before the long work.
void check_report_target(const Arguments& a) {
  if (a.json.empty()) return;
  if (a.json == a.output) throw OptionError("--json and --output name the same file");
  check_text_target(a.json);
}

}  // namespace

int run_mesh(const Arguments& a) {
  check_mesh_target(a.output);
  check_report_target(a);
  const RunContext context = terminal_context(a.threads, a.quiet);
  const Result result = run_on_input(a, context, generate);
  context.report("writing", -1);
  write_mesh(a.output, result.mesh);
  write_report(a, result.report);
  say(a, fmt::format("written: {}\n", a.output.string()));
  return 0;
}

int run_surface(const Arguments& a) {
  check_surface_target(a.output);
  check_report_target(a);
  const RunContext context = terminal_context(a.threads, a.quiet);
  const SurfaceResult result = run_on_input(a, context, generate_surface);
  write_surface(a.output, result.surface);
  write_report(a, result.report);
  say(a, fmt::format("written: {}\n", a.output.string()));
  return 0;
}

int run_size(const Arguments& a) {
  if (!a.output.empty()) check_size_field_target(a.output);
  check_report_target(a);
  const RunContext context = terminal_context(a.threads, a.quiet);
  const SizeResult result = run_on_input(a, context, generate_sizes);
  if (!a.output.empty()) write_size_field(a.output, result.sizes);
  write_report(a, result.report);
  if (!a.output.empty()) say(a, fmt::format("written: {}\n", a.output.string()));
  return 0;
}

int run_improve(const Arguments& a) {
  check_mesh_target(a.output);
  check_report_target(a);
  const RunContext context = terminal_context(a.threads, a.quiet);
  context.report("reading", -1);
  const TetMesh mesh = read_mesh(a.input);
  SurfaceMesh surface;
  if (!a.surface.empty()) surface = read_surface(a.surface).surface;
  const auto run = [&] {
    try {
      return improve_existing(mesh, a.options, a.surface.empty() ? nullptr : &surface, context);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", a.input.string(), error.what()));
    }
  };
  const Improved result = run();
  context.report("writing", -1);
  write_mesh(a.output, result.mesh);
  say(a, fmt::format("{}: {}\nimproved: ", a.input.string(), quality_in_words(result.before)));
  say(a, quality_in_words(result.report.quality) + "\n");
  write_report(a, result.report);
  say(a, fmt::format("written: {}\n", a.output.string()));
  return 0;
}

int run_check(const Arguments& a) {
  if (is_tet_mesh_file(a.input)) return check_tet_mesh(a);
  const RunContext context = terminal_context(a.threads, a.quiet);
  const SurfaceFile file = read_input(a, context);
  const RepairedSurface repaired = repair_surface(file.surface);
  for (const std::string& note : repaired.notes) say(a, "would repair: " + note + "\n");
  const SurfaceDefects defects = find_defects(repaired);
  if (!defects.clean()) throw InputError(fmt::format("{}:\n{}", a.input.string(), defects.describe()));
  say(a, fmt::format("{}: clean: {} {}, {} {}, volume {:.6g}\n", a.input.string(), repaired.bodies,
                     repaired.bodies == 1 ? "body" : "bodies", repaired.cavities,
                     repaired.cavities == 1 ? "cavity" : "cavities", enclosed_volume(repaired.surface)));
  return 0;
}

}  // namespace octafront::cli
