#include "program.h"

#include <octafront/error.h>

#include "commands.h"
#include "completion.h"
#include "image_arguments.h"
#include "manual.h"
#include "text.h"
#include "units.h"

#include <cstdio>
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

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
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
  declare_makers();
  declare_surfaces();
  declare_lookers();
  declare_helpers();
}

CLI::App* Program::add(const std::string& name, const std::string& help, const std::string& examples,
                       std::function<void(Session&)> run) {
  CLI::App* command = app_.add_subcommand(name, help);
  command->callback([this, run = std::move(run)] { chosen_ = run; });
  if (!examples.empty()) command->footer("Examples:\n" + examples);
  return command;
}

void Program::declare_makers() {
  Arguments& a = arguments_;
  CLI::App* mesh =
      add("mesh", "Mesh a surface: octafront mesh part.stl -o part.vtu",
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
          run_mesh);
  declare_input(*mesh, a);
  declare_complex(*mesh, a);
  declare_inside(*mesh, a);
  declare_image(*mesh, a.intake.image);
  declare_formula(*mesh, a);
  declare_repair(*mesh, a);
  declare_cad(*mesh, a);
  declare_mesh_output(*mesh, a);
  declare_preset(*mesh, a);
  declare_dry_run(*mesh, a);
  declare_sizes(*mesh, a);
  declare_surface(*mesh, a);
  declare_periodic(*mesh, a);
  declare_layers(*mesh, a);
  declare_volume(*mesh, a);
  declare_improvement(*mesh, a);
  declare_requirements(*mesh, a, true);
  declare_order(*mesh, a);
  declare_split(*mesh, a);
  declare_page(*mesh, a);
  declare_report(*mesh, a);
  declare_run(*mesh, a);
}

void Program::declare_surfaces() {
  Arguments& a = arguments_;
  CLI::App* surface = add("surface", "Triangulate the surface anew and stop there",
                          "  octafront surface scan.ply -o even.stl --size 0.5\n", run_surface);
  declare_input(*surface, a);
  declare_complex(*surface, a);
  declare_inside(*surface, a);
  declare_image(*surface, a.intake.image);
  declare_formula(*surface, a);
  declare_repair(*surface, a);
  declare_cad(*surface, a);
  declare_output(*surface, a, "Surface: .stl, .obj, .off or .ply", true);
  declare_sizes(*surface, a);
  declare_surface(*surface, a);
  declare_periodic(*surface, a);
  declare_report(*surface, a);
  declare_run(*surface, a);

  CLI::App* repair = add("repair", "Mend a surface with defects and stop there: octafront repair in.stl -o out.stl",
                         "  octafront repair scan.ply -o closed.ply --json changes.json --defects places.ply\n"
                         "  octafront repair part.stl -o part.off --tolerance 0.05\n"
                         "  octafront repair soup.obj -o skin.stl --repair wrap       a closed skin around it\n",
                         run_repair);
  declare_input(*repair, a);
  declare_complex(*repair, a);
  declare_repair(*repair, a);
  declare_cad(*repair, a);
  declare_output(*repair, a, "Surface: .stl, .obj, .off or .ply", true);
  declare_report(*repair, a);
  declare_run(*repair, a);

  CLI::App* size = add(
      "size", "Show the element sizes, and how many elements they would make",
      "  octafront size part.stl --curvature 24\n"
      "  octafront size part.stl -o sizes.vtu                      the field: to look at, to edit, for --size-field\n",
      run_size);
  declare_input(*size, a);
  declare_complex(*size, a);
  declare_image(*size, a.intake.image);
  declare_formula(*size, a);
  declare_repair(*size, a);
  declare_cad(*size, a);
  declare_output(*size, a, "Background grid: .vtu", false);
  declare_sizes(*size, a);
  declare_surface(*size, a);
  declare_periodic(*size, a);
  declare_report(*size, a);
  declare_run(*size, a);

  CLI::App* better = add("improve", "Make the elements of a mesh better: octafront improve in.msh -o out.vtu",
                         "  octafront improve in.msh -o out.vtu                       the boundary stays\n"
                         "  octafront improve in.msh -o out.vtu --surface part.stl    it may slide on that surface\n",
                         run_improve);
  declare_mesh_input(*better, a);
  declare_mesh_output(*better, a);
  declare_ground(*better, a);
  declare_improvement(*better, a);
  declare_requirements(*better, a, false);
  declare_order(*better, a);
  declare_page(*better, a);
  declare_report(*better, a);
  declare_run(*better, a);

  CLI::App* adapted =
      add("adapt", "Change a mesh until it fits other sizes: octafront adapt in.msh --sizes new.vtk:h -o out.msh",
          "  octafront adapt in.msh --sizes new.vtk:h -o out.msh       a field on a mesh, this or another\n"
          "  octafront adapt in.msh --size 1 --size-near 0,0,0=0.5:2 -o out.vtu\n"
          "  octafront adapt in.mesh --metric in.sol -o out.mesh       other lengths in other directions\n"
          "  octafront adapt in.vtu --from u --elements 1e5 -o out.vtu    where a field bends\n"
          "  octafront adapt in.msh --size 1 --surface part.step -o out.msh    on the geometry that was meshed\n"
          "  octafront adapt part.stl --size 1 -o finer.ply            a surface alone\n",
          run_adapt);
  declare_mesh_input(*adapted, a);
  declare_mesh_output(*adapted, a);
  declare_sizes(*adapted, a);
  declare_adaptation(*adapted, a);
  declare_requirements(*adapted, a, true);
  declare_page(*adapted, a);
  declare_report(*adapted, a);
  declare_run(*adapted, a);

  CLI::App* convert = add("convert", "Another format, with all names and sets that it holds: in.msh -o out.inp",
                          "  octafront convert in.med -o out.inp\n"
                          "  octafront convert in.msh -o out.bdf --group load=box:0,0,0,1,1,0\n"
                          "  octafront convert in.vtu -o out.pvtu --parts 8    # a piece for each of 8 processes\n"
                          "  octafront convert in.vtu -o - --format abaqus > out.inp\n",
                          run_convert);
  declare_mesh_input(*convert, a);
  declare_mesh_output(*convert, a);
  declare_conversion(*convert, a);
  declare_report(*convert, a);
  declare_run(*convert, a);
}

void Program::declare_lookers() {
  Arguments& a = arguments_;
  CLI::App* info = add("info", "Say what is in a file: a surface, a mesh, an image or a size field",
                       "  octafront info part.stl\n"
                       "  octafront info head.nii.gz\n"
                       "  octafront info part.msh --json -\n",
                       run_info);
  declare_input(*info, a, "Surface, mesh, image, or size field as `octafront size -o` writes it");
  declare_image_choice(*info, a.intake.image);
  declare_report(*info, a);
  declare_run(*info, a);

  CLI::App* check = add("check", "Say what is wrong with a surface or a mesh, and what groups it has",
                        "  octafront check part.stl\n"
                        "  octafront check part.inp --solver calculix\n",
                        run_check);
  declare_input(*check, a, "Surface or mesh; or several surfaces, a body each");
  declare_complex(*check, a);
  declare_image(*check, a.intake.image);
  declare_solver(*check, a);
  declare_report(*check, a);
  declare_run(*check, a);

  CLI::App* report = add("report", "Show a mesh: a web page with it in 3D, and its numbers",
                         "  octafront report part.msh -o part.html\n", run_report);
  declare_mesh_input(*report, a);
  declare_output(*report, a, "Web page: .html, one file that needs no network", true);
  declare_report(*report, a);
  declare_run(*report, a);
}

void Program::declare_helpers() {
  CLI::App* help_command = add("help", "Say what a command does, with its options and examples",
                               "  octafront help mesh\n"
                               "  octafront help --man | man -l -\n",
                               [this](Session& session) { help(session); });
  help_command->add_option("command", topic_, "One of the commands; none: all of them in brief")->type_name("COMMAND");
  help_command->add_flag("--man", wants_manual_, "The manual page, as man reads it");

  CLI::App* completion = add("completion", "Print what makes a shell complete commands, options and values",
                             "  source <(octafront completion bash)        in ~/.bashrc\n"
                             "  octafront completion zsh > _octafront      in a folder of $fpath\n"
                             "  octafront completion fish > ~/.config/fish/completions/octafront.fish\n",
                             [this](Session& session) { session.say_exactly(completion_for(shell_, app_)); });
  completion->add_option("shell", shell_, "The shell")->required()->type_name("bash|zsh|fish");
}

void Program::help(Session& session) const {
  if (wants_manual_) return session.say_exactly(manual_page(app_));
  // app_.help() would be that of this very command.
  if (topic_.empty())
    return session.say_exactly(app_.get_formatter()->make_help(&app_, app_.get_name(), CLI::AppFormatMode::Normal));
  for (const CLI::App* command : commands_of(app_))
    if (command->get_name() == topic_) return session.say_exactly(command->help("octafront"));
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
  set_process_limits(a.limits);
  if (a.input == kStandardOutput) a.input = "/dev/stdin";
  for (std::filesystem::path& body : a.bodies)
    if (body == kStandardOutput) body = "/dev/stdin";
  convert_lengths(a);
  return a;
}

}  // namespace octafront::cli
