#include "program.h"

#include <octafront/error.h>
#include <octafront/option_table.h>

#include "commands.h"
#include "completion.h"
#include "help.h"
#include "manual.h"
#include "mcp_server.h"
#include "schema.h"
#include "text.h"
#include "units.h"

#include <map>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// Options of earlier versions, and what they are called now.
const std::map<std::string, std::string> kRenamed{{"--size-grid", "--size-field"}};

std::vector<std::string> names_of_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(command))
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string unknown(const std::string& what, const std::string& typed, const std::vector<std::string>& known) {
  const auto renamed = kRenamed.find(typed);
  if (renamed != kRenamed.end()) return fmt::format("{} is called {} now", typed, renamed->second);
  const std::string nearest = nearest_word(typed, known);
  return fmt::format("there is no {} {}{}", what, typed,
                     nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest));
}

/// ", such as: octafront mesh part.stl -o part.vtu": the first example of a command; empty if it has none.
std::string example_of(const CLI::App& command) {
  const std::string examples = command.get_footer();
  const std::size_t begin = examples.find("octafront ");
  if (begin == std::string::npos) return {};
  return ", such as: " +
         examples.substr(begin, std::min(examples.find("   ", begin), examples.find('\n', begin)) - begin);
}

}  // namespace

std::string unknown_command(const CLI::App& app, const std::string& typed) {
  return unknown("command", typed, names_of_commands(app));
}

Failure usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  // A word that is not known goes before what is missing because of it.
  for (const std::string& extra : command.remaining()) {
    if (extra.starts_with("--"))
      return {kUsage, "usage", unknown("option", extra.substr(0, extra.find('=')), names_of_options(command)),
              "unknown_option"};
    if (chosen.empty()) return {kUsage, "usage", unknown_command(app, extra), "unknown_command"};
  }
  if (chosen.empty()) return {kUsage, "usage", "give a command, such as: octafront mesh part.stl -o part.vtu"};
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError))
    return {kUsage, "usage", error.what() + example_of(command)};
  return {kUsage, "usage", error.what()};
}

Program::Program() {
  app_.set_version_flag("--version", OCTAFRONT_VERSION);
  app_.require_subcommand(1);
  app_.footer(
      "octafront help mesh: options and examples of a command\n"
      "Exit status: 0 done, 2 usage, 3 input refused, 4 no valid mesh, 5 output not written, 6 out of memory, "
      "7 a limit reached, 130 interrupted (also by a hang-up), 1 a bug of ours");
  // Else names that begin with a slash would be options on Windows.
  app_.allow_windows_style_options(false);
  declare_commands();
  declare_helpers();
  declare_server();
  declare_workbench();
}

CLI::App* Program::add(const std::string& name, const std::string& help, const std::string& examples,
                       std::function<void(Session&)> run) {
  CLI::App* command = app_.add_subcommand(name, help);
  command->callback([this, run = std::move(run)] { chosen_ = run; });
  if (!examples.empty()) command->footer("Examples:\n" + examples);
  command->formatter_fn(
      [](const CLI::App* asked, const std::string&, CLI::AppFormatMode) { return help_of_command(*asked); });
  return command;
}

namespace {

/// A command that does something with files.
struct CommandRow {
  const char *name, *about, *examples;
  const char* input;  ///< in words, or one of those below
  void (*run)(Session&);
};
/// Inputs that become a surface, and a mesh.
constexpr const char *kFiles = "", *kMesh = "mesh", *kTwoMeshes = "meshes";

const std::vector<CommandRow>& command_rows() {
  static const std::vector<CommandRow> rows{
      {"mesh", "Mesh a surface: octafront mesh part.stl -o part.vtu",
       "  octafront mesh part.stl -o part.vtu                       automatic sizes\n"
       "  octafront mesh part.stl -o part.vtu --preset fine         smaller elements, better ones\n"
       "  octafront mesh part.stl -o part.inp --size 2 --order 2    edges of length 2, curved elements\n"
       "  octafront mesh part.obj -o part.msh --unit mm --size 0.1in\n"
       "  octafront mesh part.step -o part.inp --size 2             CAD: solids, names, colours\n"
       "  octafront mesh plate.stl bolt.stl -o bolted.msh           a region each, faces shared\n"
       "  octafront mesh labels.nii.gz -o organs.msh --labels names.txt    a region per label\n"
       "  octafront mesh 'gyroid(x,y,z) - 0.3' -o cell.msh --cell 10            a unit cell by a formula\n"
       "  octafront mesh head.nii.gz -o head.msh --band skin=-200:226 --band bone=226:\n"
       "  octafront mesh part.stl -o part.msh -o part.vtu --elements 1e5 --report part.html\n"
       "  octafront mesh part.stl --dry-run --size 0.5              elements, memory, time; nothing made\n"
       "  octafront mesh part.stl -o - --format vtk | gzip > part.vtk.gz\n",
       kFiles, run_mesh},
      {"surface", "Triangulate the surface anew and stop there",
       "  octafront surface scan.ply -o even.stl --size 0.5\n", kFiles, run_surface},
      {"repair", "Mend a surface with defects and stop there: octafront repair in.stl -o out.stl",
       "  octafront repair scan.ply -o closed.ply --json changes.json --defects places.ply\n"
       "  octafront repair part.stl -o part.off --tolerance 0.05\n"
       "  octafront repair soup.obj -o skin.stl --repair wrap       a closed skin around it\n",
       kFiles, run_repair},
      {"size", "Show the element sizes, and how many elements they would make",
       "  octafront size part.stl --curvature 24\n"
       "  octafront size part.stl -o sizes.vtu                      the field, for --size-field\n",
       kFiles, run_size},
      {"improve", "Make the elements of a mesh better: octafront improve in.msh -o out.vtu",
       "  octafront improve in.msh -o out.vtu                       the boundary stays\n"
       "  octafront improve in.msh -o out.vtu --surface part.stl    it may slide on that surface\n",
       kMesh, run_improve},
      {"adapt", "Change a mesh until it fits other sizes: octafront adapt in.msh --sizes new.vtk:h -o out.msh",
       "  octafront adapt in.msh --sizes new.vtk:h -o out.msh       a field on a mesh, this or another\n"
       "  octafront adapt in.msh --size 1 --size-near 0,0,0=0.5:2 -o out.vtu\n"
       "  octafront adapt in.mesh --metric in.sol -o out.mesh       other lengths in other directions\n"
       "  octafront adapt in.vtu --from u --elements 1e5 -o out.vtu    where a field bends\n"
       "  octafront adapt in.msh --size 1 --surface part.step -o out.msh    on the geometry that was meshed\n"
       "  octafront adapt in.vtu --level-set u=1 -o out.vtu         a region below it, faces where u is 1\n"
       "  octafront adapt part.stl --size 1 -o finer.ply            a surface alone\n",
       kMesh, run_adapt},
      {"move", "Move a mesh by a field, and mend it on the way: octafront move load.vtu --displacement u -o out.vtu",
       "  octafront move load.vtu --displacement u -o out.vtu       with all other fields of load.vtu\n"
       "  octafront move load.vtu --displacement u -o out.vtu --least-quality .3 --json history.json\n",
       kMesh, run_move},
      {"carry", "Bring fields of one mesh to another: octafront carry old.vtu new.msh -o new.vtu",
       "  octafront carry old.vtu new.msh -o new.vtu                all fields of old.vtu\n"
       "  octafront carry old.vtu new.vtu -o out.vtk --carry T,rho --json report.json\n"
       "  octafront carry old.vtu new.vtu -o both.vtu --linear-elements    of second order in elements\n",
       kTwoMeshes, run_carry},
      {"convert", "Another format, with all names and sets that it holds: in.msh -o out.inp",
       "  octafront convert in.med -o out.inp\n"
       "  octafront convert in.msh -o out.bdf --group load=box:0,0,0,1,1,0\n"
       "  octafront convert in.vtu -o out.pvtu --parts 8    # a piece for each of 8 processes\n"
       "  octafront convert in.vtu -o - --format abaqus > out.inp\n",
       kMesh, run_convert},
      {"info", "Say what is in a file: a surface, a mesh, an image or a size field",
       "  octafront info part.stl\n"
       "  octafront info head.nii.gz\n"
       "  octafront info part.msh --json -\n",
       "Surface, mesh, image, or size field as `octafront size -o` writes it", run_info},
      {"check", "Say what is wrong with a surface or a mesh, and what groups it has",
       "  octafront check part.stl\n"
       "  octafront check part.inp --solver calculix\n",
       "Surface or mesh; or several surfaces, a body each", run_check},
      {"report", "Show a mesh: a web page with it in 3D, and its numbers", "  octafront report part.msh -o part.html\n",
       kMesh, run_report},
      {"picture", "Draw any input or mesh as a PNG: octafront picture part.msh -o part.png",
       "  octafront picture part.step -o part.png --names           its faces by name\n"
       "  octafront picture part.msh -o inside.png --cut y          cut open, coloured by quality\n"
       "  octafront picture part.msh -o worst.png --worst           the worst element, near by\n"
       "  octafront picture part.msh -o where.png --highlight patch_1    where a face is\n",
       "Surface, mesh, CAD file, image or formula; or several files, a body each", run_picture},
  };
  return rows;
}

}  // namespace

void Program::declare_commands() {
  for (const CommandRow& row : command_rows()) {
    CLI::App* command = add(row.name, row.about, row.examples, row.run);
    if (row.input == std::string_view(kMesh))
      declare_mesh_input(*command, arguments_);
    else if (row.input == std::string_view(kTwoMeshes))
      declare_two_meshes(*command, arguments_);
    else
      declare_input(*command, arguments_, row.input);
    declare_options(*command, row.name, arguments_);
  }
}

void Program::declare_helpers() {
  CLI::App* help_command = add("help", "Say what a command does, with its options and examples",
                               "  octafront help mesh                        what most people use\n"
                               "  octafront help mesh sizes                  a group of options; or all\n"
                               "  octafront help --man | man -l -\n",
                               [this](Session& session) { help(session); });
  help_command->add_option("command", topic_, "One of the commands; none: all of them in brief")->type_name("COMMAND");
  help_command->add_option("group", group_, "A group of its options, or all")->type_name("GROUP");
  help_command->add_flag("--man", wants_manual_, "The manual page, as man reads it");

  CLI::App* completion = add("completion", "Print what makes a shell complete commands, options and values",
                             "  source <(octafront completion bash)        in ~/.bashrc\n"
                             "  octafront completion zsh > _octafront      in a folder of $fpath\n"
                             "  octafront completion fish > ~/.config/fish/completions/octafront.fish\n",
                             [this](Session& session) { session.say_exactly(completion_for(shell_, app_)); });
  completion->add_option("shell", shell_, "The shell")->required()->type_name("bash|zsh|fish");

  add("schema", "Print a JSON Schema of all options, and of the reports that --json writes",
      "  octafront schema > octafront.schema.json\n",
      [this](Session& session) { session.say_exactly(schema_of(app_).dump(2) + "\n"); });
}

void Program::declare_server() {
  CLI::App* server = add("serve", "Answer programs, such as agents, until standard input ends: octafront serve --mcp",
                         "  octafront serve --mcp --folder parts                      files below parts, nowhere else\n"
                         "  octafront serve --mcp --max-elements 2e6 --seconds 600    what a call may take at most\n",
                         [this](Session&) { serve(); });
  server->add_flag("--mcp", speaks_mcp_, "By the Model Context Protocol, over standard input and output")->required();
  server->add_option("--folder", folders_, "A folder that files may be in, links followed; may be repeated [this one]")
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  server->add_option("--max-elements", server_limits_.elements, "Elements of a mesh at most")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  server->add_option("--seconds", server_limits_.seconds, "Seconds that a call may take, by the clock")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  server->add_option("--megabytes", server_limits_.memory_mb, "Memory that a call may take")
      ->type_name("MB")
      ->check(CLI::PositiveNumber);
  server->add_option("--threads", server_limits_.threads, "Threads at most; 0: all")
      ->type_name("N")
      ->check(CLI::Range(0, 1024));
}

void Program::declare_workbench() {
  CLI::App* ui = add("ui", "Pick, mesh, look and save in the browser: octafront ui part.step",
                     "  octafront ui part.step                       opens the browser; ends with the page\n"
                     "  octafront ui --no-browser --port 8123        says the address, for a browser of one's own\n",
                     [this](Session&) {
                       workbench_.opens_browser = !is_without_browser_;
                       serve_workbench(app_, workbench_);
                     });
  ui->add_option("file", workbench_.file, "CAD file, surface, image or mesh that is opened first")->type_name("FILE");
  ui->add_option("--port", workbench_.port, "Port on the loopback address; 0: any that is free [0]")
      ->type_name("N")
      ->check(CLI::Range(0, 65535));
  ui->add_flag("--no-browser", is_without_browser_, "Only say the address");
}

void Program::serve() {
  const Folders folders(folders_.empty() ? std::vector<std::filesystem::path>{"."} : folders_);
  serve_mcp(app_, folders, server_limits_);
}

void Program::help(Session& session) const {
  if (wants_manual_) return session.say_exactly(manual_page(app_));
  // app_.help() would be that of this very command.
  if (topic_.empty())
    return session.say_exactly(app_.get_formatter()->make_help(&app_, app_.get_name(), CLI::AppFormatMode::Normal));
  for (const CLI::App* command : commands_of(app_))
    if (command->get_name() == topic_) return session.say_exactly(help_of_command(*command, group_));
  throw OptionError(unknown_command(app_, topic_));
}

std::string command_line_of(int argc, const char* const* argv) {
  std::string line = "octafront";
  for (int i = 1; i < argc; ++i) line += " " + quoted_for_shell(argv[i]);
  return line;
}

Arguments& Program::arguments(int argc, char** argv) {
  Arguments& a = arguments_;
  note_command(*app_.get_subcommands().front(), a);
  a.command_line = command_line_of(argc, argv);
  a.words_with_line_ends = words_with_line_ends(argc, argv);
  try {
    check_ranges(a.intake), check_ranges(a.writing);
  } catch (const OptionError& error) {
    throw OptionError(a.names.translated(error.what()));
  }
  set_process_limits(a.limits);
  if (a.input == kStandardOutput) a.input = "/dev/stdin";
  for (std::filesystem::path& body : a.bodies)
    if (body == kStandardOutput) body = "/dev/stdin";
  convert_lengths(a);
  return a;
}

}  // namespace octafront::cli
