#include <octafront/error.h>

#include "arguments.h"
#include "commands.h"
#include "compare.h"
#include "terminal.h"

#include <cstdio>
#include <functional>
#include <new>

#include <fmt/format.h>

namespace {

using namespace octafront;
using namespace octafront::cli;

// Status codes of the command line, by cause.
enum Status {
  kDone = 0,
  kInternal = 1,
  kUsage = 2,
  kInputRefused = 3,
  kNoMesh = 4,
  kNotWritten = 5,
  kInterrupted = 130
};

int fail(Status status, const char* message) {
  clear_progress();
  fmt::print(stderr, "octafront: {}\n", message);
  return status;
}

int guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const OptionError& e) {
    return fail(kUsage, e.what());
  } catch (const InputError& e) {
    return fail(kInputRefused, e.what());
  } catch (const MeshingError& e) {
    return fail(kNoMesh, e.what());
  } catch (const OutputError& e) {
    return fail(kNotWritten, e.what());
  } catch (const Cancelled&) {
    return fail(kInterrupted, "interrupted; nothing was written");
  } catch (const std::bad_alloc&) {
    return fail(kInternal, "out of memory; ask for fewer elements (--elements, --size)");
  } catch (const std::exception& e) {
    return fail(kInternal, fmt::format("unexpected error, which is a bug of ours: {}", e.what()).c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Octafront: tetrahedral meshes from closed surfaces"};
  app.set_version_flag("--version", OCTAFRONT_VERSION);
  app.require_subcommand(1);
  app.footer("Exit status: 0 done, 2 usage, 3 input refused, 4 no valid mesh, 5 output not written, 130 interrupted");
  Arguments a;
  std::function<int()> chosen;

  auto* mesh = app.add_subcommand("mesh", "Mesh a surface: octafront mesh part.stl -o part.vtu");
  declare_input(*mesh, a);
  declare_output(*mesh, a, "Mesh: .vtu, .msh (Gmsh 4.1) or .mesh (MEDIT)", true);
  declare_sizes(*mesh, a);
  declare_surface(*mesh, a);
  declare_volume(*mesh, a);
  declare_improvement(*mesh, a);
  declare_report(*mesh, a);
  declare_run(*mesh, a);
  mesh->callback([&] { chosen = [&] { return run_mesh(a); }; });

  auto* surface = app.add_subcommand("surface", "Triangulate the surface anew and stop there");
  declare_input(*surface, a);
  declare_output(*surface, a, "Surface: .stl, .obj, .off or .ply", true);
  declare_sizes(*surface, a);
  declare_surface(*surface, a);
  declare_report(*surface, a);
  declare_run(*surface, a);
  surface->callback([&] { chosen = [&] { return run_surface(a); }; });

  auto* size = app.add_subcommand("size", "Show the element sizes, and how many elements they would make");
  declare_input(*size, a);
  declare_output(*size, a, "Background grid: .vtu", false);
  declare_sizes(*size, a);
  declare_surface(*size, a);
  declare_report(*size, a);
  declare_run(*size, a);
  size->callback([&] { chosen = [&] { return run_size(a); }; });

  auto* better =
      app.add_subcommand("improve", "Make the elements of a mesh better: octafront improve in.msh -o out.vtu");
  declare_mesh_input(*better, a);
  declare_output(*better, a, "Mesh: .vtu, .msh (Gmsh 4.1) or .mesh (MEDIT)", true);
  declare_ground(*better, a);
  declare_improvement(*better, a);
  declare_report(*better, a);
  declare_run(*better, a);
  better->callback([&] { chosen = [&] { return run_improve(a); }; });

  auto* check = app.add_subcommand("check", "Say what is wrong with a surface, or with a mesh (.vtu, .msh, .mesh)");
  declare_input(*check, a);
  declare_run(*check, a);
  check->callback([&] { chosen = [&] { return run_check(a); }; });

  CompareArguments c;
  auto* compare = app.add_subcommand("compare", "Mesh surfaces with several methods; tables and charts of how they do");
  declare_compare(*compare, c);
  compare->callback([&] { chosen = [&] { return run_compare(c); }; });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kUsage;
  }
  return guarded(chosen);
}
