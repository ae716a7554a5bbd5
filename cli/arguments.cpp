#include "arguments.h"

#include <octafront/io.h>
#include <octafront/option_table.h>

#include "line_options.h"
#include "units.h"

#include <algorithm>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

bool lists(std::string_view words, std::string_view word) {
  const std::string padded = fmt::format(" {} ", words);
  return padded.find(fmt::format(" {} ", word)) != std::string::npos;
}

bool takes(std::string_view command, const OptionInfo& info) {
  return info.commands != "-" && (lists(info.tasks, command) || lists(info.commands, command));
}

/// "--keep-surface", "--gradation,--grading"
std::string names_on_the_line(const OptionInfo& info) {
  std::string names = "--" + std::string(info.typed.empty() ? info.name : info.typed);
  std::ranges::replace(names, '_', '-');
  if (const std::size_t comma = names.find(','); comma != std::string::npos) names.insert(comma + 1, "--");
  return names;
}

/// The first of them.
std::string option_of(const OptionInfo& info) {
  const std::string names = names_on_the_line(info);
  return names.substr(0, names.find(','));
}

template <class Visit>
void for_each_row(const Visit& visit) {
  for (const auto* table : {&option_table(), &intake_table(), &write_table()})
    for (const OptionInfo& info : *table) visit(info);
}

std::string in_words(const OptionValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  return {};
}

/// The formats that heed an option of writing, ": vtu, msh"; empty: it is not about formats.
std::string formats_with(std::string_view name) {
  const bool is_text = name == "ascii";
  std::string names;
  if (!is_text && name != "parts") return names;
  for (const FormatInfo& info : known_formats())
    if (is_text ? info.also_text : info.holds.parts) names += (names.empty() ? ": " : ", ") + std::string(info.name);
  return names;
}

/// What the help says: with range and default, in the words of the command line.
std::string help_of(const OptionInfo& info, const OptionValue& standard) {
  static const OptionNames names = [] {
    OptionNames all;
    for_each_row([&](const OptionInfo& row) { all.add(std::string(row.name), option_of(row)); });
    return all;
  }();
  std::string text = std::string(info.help) + formats_with(info.name);
  if (info.kind != OptionInfo::Kind::kFlag && info.choices.empty() && !info.range().empty())
    text += "; " + info.range();
  const std::string without = info.unset.empty() ? in_words(standard) : std::string(info.unset);
  if (info.kind != OptionInfo::Kind::kFlag && !without.empty()) text += fmt::format(" [{}]", without);
  return names.translated(text);
}

/// Declares rows of one table, whose values go to `all`, as options of a command.
template <class All>
class Rows {
 public:
  Rows(CLI::App& group, Arguments& arguments, All& all) : group_(group), arguments_(arguments), all_(all) {}

  void add(const OptionInfo& info) {
    help_ = help_of(info, option_value(All{}, info.name));
    names_ = names_on_the_line(info);
    if (info.kind == OptionInfo::Kind::kFlag)
      add_flag(info);
    else if (!info.choices.empty())
      add_choice(info);
    else if (info.is_length)
      add_length(info);
    else if (info.kind == OptionInfo::Kind::kText)
      add_text(info);
    else
      add_number(info);
  }

 private:
  template <class Typed, class Value>
  CLI::Option* add_valued(const OptionInfo& info, const std::string& letter, const Value& value_of) {
    const auto set = [this_all = &all_, name = info.name, option = option_of(info), value_of](const Typed& typed) {
      as_usage(option, [&] { set_option(*this_all, name, value_of(option, typed)); });
    };
    return group_.add_option_function<Typed>(names_, set, help_)->type_name(letter);
  }

  void add_flag(const OptionInfo& info) {
    const bool is_opposite = info.typed.starts_with("no-");
    group_
        .add_flag_function(
            names_,
            [all = &all_, name = info.name, is_opposite](std::int64_t n) {
              set_option(*all, name, (n > 0) != is_opposite);
            },
            help_)
        ->type_name("");
  }

  void add_choice(const OptionInfo& info) {
    Choice<OptionValue> choice;
    for (const std::string_view name : info.choices)
      choice.names.emplace_back(name, info.kind == OptionInfo::Kind::kWhole
                                          ? OptionValue(std::int64_t{std::stoi(std::string(name))})
                                          : OptionValue(std::string(name)));
    add_valued<std::string>(info, choice.listed("|"), [choice](const std::string& option, const std::string& typed) {
      return choice.value_of(option, typed);
    });
  }

  /// In units of the input, or with a unit of its own: "2", "2mm".
  void add_length(const OptionInfo& info) {
    add_valued<std::string>(info, std::string(info.letter),
                            [a = &arguments_, name = info.name](const std::string& option, const std::string& typed) {
                              const auto [number, unit] = length_of(option, typed);
                              if (!unit.empty()) a->lengths.push_back({option, unit, name});
                              return OptionValue(number);
                            });
  }

  void add_text(const OptionInfo& info) {
    const auto as_it_is = [](const std::string&, const std::string& typed) { return OptionValue(typed); };
    if (info.letter != "PLACE" && info.letter != "CONTACT=WAY") {
      add_valued<std::string>(info, std::string(info.letter), as_it_is);
      return;
    }
    add_valued<std::vector<std::string>>(info, std::string(info.letter),
                                         [](const std::string&, const std::vector<std::string>& typed) {
                                           return OptionValue(CLI::detail::join(typed, ";"));
                                         });
  }

  void add_number(const OptionInfo& info) {
    const bool is_whole = info.kind == OptionInfo::Kind::kWhole;
    add_valued<double>(info, std::string(info.letter), [is_whole](const std::string& option, double n) {
      return is_whole ? OptionValue(whole_number(option, n)) : OptionValue(n);
    });
  }

  CLI::App& group_;
  Arguments& arguments_;
  All& all_;
  std::string help_, names_;
};

/// Declares the options of a group, if the command takes any.
void declare_group(CLI::App& command, std::string_view name, Arguments& a, const OptionGroup& group) {
  CLI::App* made = nullptr;
  const auto where = [&]() -> CLI::App& {
    if (made == nullptr) made = command.add_option_group(std::string(group.name), std::string(group.about));
    return *made;
  };
  const auto declare = [&](const std::vector<OptionInfo>& table, auto& all) {
    for (const OptionInfo& info : table)
      if (info.group == group.name && takes(name, info)) Rows(where(), a, all).add(info);
  };
  const auto declare_lines = [&](bool first) {
    for (const LineOption& line : line_options())
      if (line.group == group.name && lists(line.commands, name) && line.names.starts_with("-o") == first)
        line.add(where(), line, a);
  };
  declare_lines(true);
  declare(option_table(), a.options);
  declare(intake_table(), a.intake);
  declare_lines(false);
  declare(write_table(), a.writing);
}

}  // namespace

void declare_input(CLI::App& command, Arguments& a, const std::string& what) {
  const std::string surface =
      "Closed surface, with inner walls or without: STL, OBJ, OFF, PLY, TetGen .poly, triangles of Gmsh .msh or MEDIT "
      ".mesh; -: from standard input; or several files, a body each. Or CAD: STEP, IGES, BREP. Or an image of labels "
      "or grey values: NIfTI, NRRD, MetaImage, raw with JSON, DICOM (a folder or its files). Or a formula";
  command
      .add_option_function<std::vector<std::string>>(
          "input",
          [&a](const std::vector<std::string>& all) {
            a.bodies.assign(all.begin(), all.end());
            a.input = a.bodies.front();
          },
          what.empty() ? surface : what)
      ->required()
      ->type_name("FILE");
}

namespace {

std::string endings_of_meshes() {
  std::string endings;
  for (const FormatInfo& info : known_formats())
    if (info.reads_mesh && !info.endings.empty() && !info.writes_surface)
      endings += (endings.empty() ? "" : ", ") + std::string(info.endings.substr(0, info.endings.find(' ')));
  return endings;
}

}  // namespace

void declare_mesh_input(CLI::App& command, Arguments& a) {
  command.add_option("input", a.input, "Tetrahedral mesh: " + endings_of_meshes())->required()->type_name("MESH");
}

void declare_two_meshes(CLI::App& command, Arguments& a) {
  command
      .add_option_function<std::vector<std::string>>(
          "input",
          [&a](const std::vector<std::string>& both) {
            a.bodies.assign(both.begin(), both.end());
            a.input = a.bodies.front();
          },
          "The mesh with fields, and the one that gets them: " + endings_of_meshes())
      ->required()
      ->expected(2)
      ->type_name("MESH");
}

void declare_options(CLI::App& command, std::string_view name, Arguments& a, std::string_view only) {
  for (const OptionGroup& group : option_groups())
    if (only.empty() || group.name == only) declare_group(command, name, a, group);
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_name().empty(); });
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
  return names;
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> options = command.get_options();
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (!group->get_name().empty()) continue;
    for (const CLI::Option* option : options_of(*group))
      if (option != group->get_help_ptr()) options.push_back(option);  // each group has one of its own
  }
  return options;
}

std::string brief_of(const CLI::App& command, const CLI::Option& option) {
  std::string brief;
  const auto is_it = [&](const std::string& names) {
    return !option.get_lnames().empty() &&
           lists(CLI::detail::join(CLI::detail::split(names, ','), " "), "--" + option.get_lnames().front());
  };
  for_each_row([&](const OptionInfo& info) {
    if (takes(command.get_name(), info) && is_it(names_on_the_line(info))) brief = info.brief;
  });
  for (const LineOption& line : line_options())
    if (lists(line.commands, command.get_name()) && is_it(std::string(line.names))) brief = line.brief;
  return brief;
}

void note_command(const CLI::App& command, Arguments& a) {
  a.command = command.get_name();
  // Of a field that two options set, each in commands of its own, that of this command.
  for (const bool is_ours : {false, true})
    for_each_row([&](const OptionInfo& info) {
      if (info.commands != "-" && takes(a.command, info) == is_ours)
        a.names.add(std::string(info.field), option_of(info));
    });
  a.names.add("field", "--size-field");
  for (const CLI::Option* option : options_of(command)) {
    if (option->get_lnames().empty()) continue;
    const std::string name = option->get_lnames().front();
    std::string field = name;
    std::replace(field.begin(), field.end(), '-', '_');
    a.names.add(field, "--" + name);
    const bool is_flag = option->get_items_expected_max() == 0;
    if (option->count() > 0) a.given.emplace_back(name, is_flag ? "true" : CLI::detail::join(option->results(), ","));
  }
}

}  // namespace octafront::cli
