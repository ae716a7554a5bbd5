#pragma once

#include <octafront/domain.h>
#include <octafront/io.h>
#include <octafront/limits.h>
#include <octafront/options.h>
#include <octafront/picture.h>
#include <octafront/solver_checks.h>

#include "option_names.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace octafront::cli {

/// A length of Options that was typed with a unit.
struct TypedLength {
  std::string option, unit;
  std::string_view name;  ///< of its row
};

/// What people choose who do not want to think: how fine automatic sizes are, and how long elements are improved.
enum class Preset { kDraft, kStandard, kFine, kHead };

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
  WriteOptions writing;                       ///< of all of them, whatever their formats
  std::vector<std::string> carry;             ///< fields of the input that go along; empty: all, "none": none
  std::filesystem::path map_file;             ///< where old vertices and elements are now; empty: none
  std::filesystem::path regions, point_sizes, size_field;  ///< files with sizes; empty: none
  std::string metric;                                      ///< FILE[:FIELD] with a metric; empty: none
  std::string field;                                       ///< of the input, of which a metric is made; empty: none
  std::string displacement;                                ///< the field of the input that it moves by
  std::vector<std::pair<std::string, double>> level_sets;  ///< fields of the input, and the values of their surfaces
  double norm = 2;                                         ///< p of L^p, in which that metric makes its error least
  std::filesystem::path metric_out;                        ///< where the metric is written; empty: nowhere
  Options options;
  std::optional<Solver> solver;      ///< whose limits a mesh is checked by
  std::string unit;                  ///< of the input's coordinates; empty: what the file says
  std::vector<TypedLength> lengths;  ///< that wait for it
  std::optional<Preset> preset;
  bool dry_run = false;
  std::vector<std::pair<std::string, std::string>> samples;   ///< images and what their values are called on the mesh
  std::vector<std::pair<std::string, std::string>> formulas;  ///< fields by name and formula, in turn
  std::uint32_t material_bins = 0;                            ///< of the last field; 0: none
  PictureOptions picture;
  int new_order = 0;  ///< of a converted mesh; 0: as it is
  int threads = 0;
  ProcessLimits limits;
  bool quiet = false;
  OptionNames names;
  std::vector<std::string> words_with_line_ends;           ///< of the command line
  std::vector<std::pair<std::string, std::string>> given;  ///< options and values as typed; flags are "true"
};

/// What a command works on: files that become a surface, or a mesh. `what`: in words.
void declare_input(CLI::App& command, Arguments& arguments, const std::string& what = {});
void declare_mesh_input(CLI::App& command, Arguments& arguments);
void declare_two_meshes(CLI::App& command, Arguments& arguments);

/// Declares the options that the command of this name takes: the rows of the library's tables
/// (octafront/option_table.h) and of line_options.h, group by group; only those of one group, where one is named. A
/// field has the name of its option, with underscores, unless its row says otherwise.
void declare_options(CLI::App& command, std::string_view name, Arguments& arguments, std::string_view group = {});

/// The commands of the program.
std::vector<const CLI::App*> commands_of(const CLI::App& app);
std::vector<std::string> names_of_commands(const CLI::App& app);

/// Every option of a command, those of its groups too.
std::vector<const CLI::Option*> options_of(const CLI::App& command);

/// In a few words, of options that most people use; else empty.
std::string brief_of(const CLI::App& command, const CLI::Option& option);

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

}  // namespace octafront::cli
