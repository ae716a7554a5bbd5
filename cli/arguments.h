#pragma once

#include <octafront/domain.h>
#include <octafront/io.h>
#include <octafront/limits.h>
#include <octafront/named_groups.h>
#include <octafront/options.h>
#include <octafront/solver_checks.h>

#include "option_names.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace octafront::cli {

/// A length of Options that was typed with a unit.
struct TypedLength {
  std::string option, unit;
  std::optional<double>* value;
};

/// What people choose who do not want to think: how fine automatic sizes are, and how long elements are improved.
enum class Preset { kDraft, kStandard, kFine };

/// What the user typed, as the commands need it.
struct Arguments {
  std::string command;
  std::string command_line;  ///< quoted for a shell
  std::filesystem::path input, output, json, surface, page;
  std::vector<std::filesystem::path> bodies;  ///< all inputs, the first one too, of commands that take several
  IntakeOptions intake;                       ///< what becomes of them on the way in
  std::filesystem::path defects;              ///< where the changes of repair are shown; empty: nowhere
  std::vector<std::filesystem::path> meshes;  ///< that are written; "-": to standard output
  std::vector<std::string> formats;           ///< of the meshes in turn; empty: by their endings
  bool ascii = false;                         ///< of the meshes: as text
  bool cells_only = false;                    ///< of the meshes: tetrahedra alone
  bool cohesive = false;                      ///< of the meshes: with cohesive elements where they are split
  std::string beams;                          ///< of the meshes: curves that are beams, too
  int parts = 0;                              ///< of the meshes: divided into so many; 0: whole
  Partitioner partitioner = Partitioner::kCurve;
  bool split_files = false;        ///< of the meshes: a file for each part
  std::vector<std::string> only;   ///< places that may change
  std::vector<std::string> keep;   ///< what stays beside them
  std::vector<std::string> carry;  ///< fields of the input that go along; empty: all, "none": none
  std::filesystem::path map_file;  ///< where old vertices and elements are now; empty: none
  std::filesystem::path regions, point_sizes, size_field;  ///< files with sizes; empty: none
  std::string metric;                                      ///< FILE[:FIELD] with a metric; empty: none
  std::string field;                                       ///< of the input, of which a metric is made; empty: none
  double norm = 2;                                         ///< p of L^p, in which that metric makes its error least
  std::filesystem::path metric_out;                        ///< where the metric is written; empty: nowhere
  Options options;
  std::optional<Solver> solver;      ///< whose limits a mesh is checked by
  std::string unit;                  ///< of the input's coordinates; empty: what the file says
  std::vector<TypedLength> lengths;  ///< that wait for it
  std::optional<Preset> preset;
  bool dry_run = false;
  std::vector<GroupRule> groups;  ///< that are added to it
  int new_order = 0;              ///< of a converted mesh; 0: as it is
  int threads = 0;
  ProcessLimits limits;
  bool quiet = false;
  OptionNames names;
  std::vector<std::string> words_with_line_ends;           ///< of the command line
  std::vector<std::pair<std::string, std::string>> given;  ///< options and values as typed; flags are "true"
};

/// Declares what each command understands; defaults are those of Options. A field of Options has the name of its
/// option, with underscores, unless said otherwise in `names`.
void declare_input(CLI::App& command, Arguments& arguments, const std::string& what = {});
void declare_mesh_input(CLI::App& command, Arguments& arguments);
void declare_output(CLI::App& command, Arguments& arguments, const std::string& what, bool required);
/// Several materials: how walls and bodies become regions.
void declare_complex(CLI::App& command, Arguments& arguments);
/// Sheets, lines and points inside.
void declare_inside(CLI::App& command, Arguments& arguments);
/// --split.
void declare_split(CLI::App& command, Arguments& arguments);
/// What is done about surfaces with defects.
void declare_repair(CLI::App& command, Arguments& arguments);
void declare_cad(CLI::App& command, Arguments& arguments);
/// Bodies by a formula.
void declare_formula(CLI::App& command, Arguments& arguments);
/// -o, --format and --group of commands that write a mesh.
void declare_mesh_output(CLI::App& command, Arguments& arguments);
/// --report: the web page.
void declare_page(CLI::App& command, Arguments& arguments);
void declare_preset(CLI::App& command, Arguments& arguments);
void declare_dry_run(CLI::App& command, Arguments& arguments);
void declare_report(CLI::App& command, Arguments& arguments);
void declare_run(CLI::App& command, Arguments& arguments);
void declare_sizes(CLI::App& command, Arguments& arguments);
void declare_surface(CLI::App& command, Arguments& arguments);
void declare_periodic(CLI::App& command, Arguments& arguments);
void declare_layers(CLI::App& command, Arguments& arguments);
void declare_volume(CLI::App& command, Arguments& arguments);
void declare_improvement(CLI::App& command, Arguments& arguments);
/// --require-volume and --require-angle; `of_sizes`: --require-size, too.
void declare_requirements(CLI::App& command, Arguments& arguments, bool of_sizes);
void declare_ground(CLI::App& command, Arguments& arguments);
/// How a mesh is adapted.
void declare_adaptation(CLI::App& command, Arguments& arguments);
void declare_order(CLI::App& command, Arguments& arguments);
void declare_conversion(CLI::App& command, Arguments& arguments);
void declare_solver(CLI::App& command, Arguments& arguments);

/// The commands of the program.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// Every option of a command, those of its groups too.
std::vector<const CLI::Option*> options_of(const CLI::App& command);

/// Enters the command that was chosen into `arguments`: its name, its options as typed, the names of fields.
void note_command(const CLI::App& command, Arguments& arguments);

/// An option whose value is one of a few names, in either case; the help lists them in the order of `names`.
template <class Value>
struct Choice {
  std::vector<std::pair<std::string, Value>> names;

  std::string listed(const std::string& between) const {
    std::string all;
    for (const auto& [name, value] : names) all += (all.empty() ? "" : between) + name;
    return all;
  }
  std::string name_of(Value wanted) const {
    for (const auto& [name, value] : names)
      if (value == wanted) return name;
    return {};
  }
  /// Throws CLI::ValidationError.
  Value value_of(const std::string& option, const std::string& typed) const {
    for (const auto& [name, value] : names)
      if (CLI::detail::to_lower(typed) == name) return value;
    throw CLI::ValidationError(option, "is one of " + listed(", ") + "; \"" + typed + "\" is none of them");
  }
};

/// NAME=box:x0,y0,z0,x1,y1,z1, NAME=sphere:x,y,z,r, NAME=patches:a,b,c, or with what is to be in the group before:
/// NAME=elements:box:... Throws CLI::ValidationError.
GroupRule group_rule(const std::string& typed);

/// NAME=x,y,z. Throws CLI::ValidationError.
RegionSeed region_seed(const std::string& typed);

/// "1e5" is a number of elements too. Throws CLI::ValidationError.
std::int64_t whole_number(const char* option, double n);

}  // namespace octafront::cli
