#include <octafront/error.h>

#include "arguments.h"
#include "commands.h"
#include "compare.h"
#include "failure.h"
#include "session.h"
#include "terminal.h"
#include "text.h"

#include <cstdio>
#include <functional>
#include <map>

#include <fmt/core.h>

namespace {

using namespace octafront;
using namespace octafront::cli;

/// Options of earlier versions, and what they are called now.
const std::map<std::string, std::string> kRenamed{{"--size-grid", "--size-field"}};

int fail(Status status, const std::string& message) {
  clear_progress();
  fmt::print(stderr, "octafront: {}\n", printable(message));
  return status;
}

/// A buffer that the disk or pipe did not take is found out now or never.
int finished(int status) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  return written || status != kDone ? status : fail(kNotWritten, "standard output cannot be written");
}

int fail_with_json(const Session& session, const Failure& failure) {
  const std::string message = session.arguments().names.translated(failure.message);
  const int status = fail(failure.status, message);
  try {
    session.write_json({{"kind", failure.kind}, {"message", message}});
  } catch (const std::exception& error) {
    fail(kNotWritten, error.what());
  }
  return status;
}

int run(const Arguments& arguments, const std::function<void(Session&)>& command) {
  try {
    check_files(arguments);
  } catch (const std::exception&) {
    const Failure failure = current_failure();
    return fail(failure.status, failure.message);
  }
  Session session(arguments);
  try {
    command(session);
    session.write_json(nullptr);
    return finished(kDone);
  } catch (const std::exception&) {
    return fail_with_json(session, current_failure());
  }
}

std::vector<std::string> names_of_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(command))
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::string unknown(const std::string& what, const std::string& typed, const std::vector<std::string>& known) {
  const auto renamed = kRenamed.find(typed);
  if (renamed != kRenamed.end()) return fmt::format("{} is called {} now", typed, renamed->second);
  const std::string nearest = nearest_word(typed, known);
  return fmt::format("there is no {} {}{}", what, typed,
                     nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest));
}

/// What is wrong with the command line, in words; a word that is not known goes before what is missing because of it.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  for (const std::string& extra : command.remaining()) {
    if (extra.starts_with("--")) return unknown("option", extra.substr(0, extra.find('=')), names_of_options(command));
    if (chosen.empty()) return unknown("command", extra, names_of_commands(app));
  }
  return error.what();
}

int refuse_usage(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const std::string command = chosen.empty() ? "" : chosen.front()->get_name() + " ";
  return fail(kUsage, fmt::format("{}\nMore: octafront {}--help", usage_error(app, error), command));
}

/// An empty value is a variable of a script that was not set: never what was meant.
bool has_empty_argument(int argc, char** argv, std::string& before) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    before = argument.empty() ? argv[i - 1] : argument;
    if (argument.empty() || (argument.starts_with("--") && argument.ends_with('='))) return true;
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  prepare_process();
  CLI::App app{"Octafront: tetrahedral meshes from closed surfaces"};
  app.set_version_flag("--version", OCTAFRONT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 2 usage, 3 input refused, 4 no valid mesh, 5 output not written, 6 out of memory, "
      "130 interrupted, 1 a bug of ours");
  Arguments a;
  std::function<void(Session&)> chosen;

  auto* mesh = app.add_subcommand("mesh", "Mesh a surface: octafront mesh part.stl -o part.vtu");
  declare_input(*mesh, a);
  declare_complex(*mesh, a);
  declare_mesh_output(*mesh, a);
  declare_sizes(*mesh, a);
  declare_surface(*mesh, a);
  declare_volume(*mesh, a);
  declare_improvement(*mesh, a);
  declare_order(*mesh, a);
  declare_report(*mesh, a);
  declare_run(*mesh, a);
  mesh->callback([&] { chosen = run_mesh; });

  auto* surface = app.add_subcommand("surface", "Triangulate the surface anew and stop there");
  declare_input(*surface, a);
  declare_complex(*surface, a);
  declare_output(*surface, a, "Surface: .stl, .obj, .off or .ply", true);
  declare_sizes(*surface, a);
  declare_surface(*surface, a);
  declare_report(*surface, a);
  declare_run(*surface, a);
  surface->callback([&] { chosen = run_surface; });

  auto* size = app.add_subcommand("size", "Show the element sizes, and how many elements they would make");
  declare_input(*size, a);
  declare_complex(*size, a);
  declare_output(*size, a, "Background grid: .vtu", false);
  declare_sizes(*size, a);
  declare_surface(*size, a);
  declare_report(*size, a);
  declare_run(*size, a);
  size->callback([&] { chosen = run_size; });

  auto* better =
      app.add_subcommand("improve", "Make the elements of a mesh better: octafront improve in.msh -o out.vtu");
  declare_mesh_input(*better, a);
  declare_mesh_output(*better, a);
  declare_ground(*better, a);
  declare_improvement(*better, a);
  declare_order(*better, a);
  declare_report(*better, a);
  declare_run(*better, a);
  better->callback([&] { chosen = run_improve; });

  auto* convert =
      app.add_subcommand("convert", "Another format, with all names and sets that it holds: in.msh -o out.inp");
  declare_mesh_input(*convert, a);
  declare_mesh_output(*convert, a);
  declare_conversion(*convert, a);
  declare_report(*convert, a);
  declare_run(*convert, a);
  convert->callback([&] { chosen = run_convert; });

  auto* check = app.add_subcommand("check", "Say what is wrong with a surface or a mesh, and what groups it has");
  declare_input(*check, a);
  declare_complex(*check, a);
  declare_solver(*check, a);
  declare_report(*check, a);
  declare_run(*check, a);
  check->callback([&] { chosen = run_check; });

  CompareArguments c;
  auto* compare = app.add_subcommand("compare", "Mesh surfaces with several methods; tables and charts of how they do");
  declare_compare(*compare, c);
  compare->callback([&] { chosen = [&c](Session& session) { run_compare(c, session); }; });

  std::string before;
  if (has_empty_argument(argc, argv, before))
    return fail(kUsage, fmt::format("there is an empty value behind {}: give one, or leave it out", before));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return e.get_exit_code() == 0 ? finished(app.exit(e)) : refuse_usage(app, e);
  }
  Arguments& common = app.got_subcommand(compare) ? c.common : a;
  note_command(*app.get_subcommands().front(), common);
  return run(common, chosen);
}
