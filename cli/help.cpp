#include "help.h"

#include <octafront/error.h>

#include "arguments.h"
#include "line_options.h"

#include <algorithm>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

constexpr std::size_t kHelpWidth = 100;
constexpr std::size_t kHelpIndent = 26;

/// The text in lines behind `begin`, which has a line of its own if it is too long.
std::string wrapped(const std::string& begin, const std::string& text, std::size_t indent) {
  std::string out = begin, line;
  if (begin.size() + 1 > indent && indent > 0) {
    out += "\n" + std::string(indent, ' ');
  } else {
    out += std::string(indent - std::min(indent, begin.size()), ' ');
  }
  const auto end_line = [&] {
    out += line;
    line.clear();
  };
  for (const std::string& word : CLI::detail::split(text, ' ')) {
    if (!line.empty() && indent + line.size() + 1 + word.size() > kHelpWidth) {
      end_line();
      out += "\n" + std::string(indent, ' ');
    }
    line += (line.empty() ? "" : " ") + word;
  }
  end_line();
  return out + "\n";
}

/// "  -o,--output FILE"
std::string term_in_help(const CLI::Option& option) {
  const bool is_flag = option.get_items_expected_max() == 0;
  const std::string letter = is_flag ? "" : option.get_type_name();
  return "  " + option.get_name(false, true) + (letter.empty() ? "" : " " + letter);
}

std::vector<const CLI::App*> groups_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* group) { return group->get_name().empty(); });
}

std::vector<const CLI::Option*> own_options(const CLI::App& group) {
  std::vector<const CLI::Option*> options = group.get_options();
  std::erase_if(options, [&](const CLI::Option* option) { return option == group.get_help_ptr(); });
  return options;
}

/// `octafront help mesh KEY`: of the group with this name.
const OptionGroup& about_group(const CLI::App& group) {
  const auto is_it = [&](const OptionGroup& about) { return about.name == group.get_group(); };
  return *std::ranges::find_if(option_groups(), is_it);
}

std::string options_in_full(const CLI::App& group) {
  std::string text = group.get_group() + (group.get_description().empty() ? "" : ": " + group.get_description()) + "\n";
  for (const CLI::Option* option : own_options(group))
    text += wrapped(term_in_help(*option), option->get_description(), kHelpIndent);
  return text;
}

std::string positionals_of(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      text += wrapped("  " + option->get_name(true, false) + " " + option->get_type_name(), option->get_description(),
                      kHelpIndent);
  return text;
}

std::string head_of(const CLI::App& command) {
  std::string inputs;
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      inputs += fmt::format(" {}{}{}{}", option->get_required() ? "" : "[", option->get_name(true, false),
                            option->get_items_expected_max() > 1 ? "..." : "", option->get_required() ? "" : "]");
  return fmt::format("{}\nUsage: octafront {}{} [OPTIONS]\n", command.get_description(), command.get_name(), inputs);
}

std::string groups_in_brief(const CLI::App& command) {
  constexpr char kUnbroken = '~';
  std::string keys;
  for (const CLI::App* group : groups_of(command))
    keys += fmt::format("{}{}{}{}", keys.empty() ? "" : ", ", about_group(*group).key, kUnbroken,
                        own_options(*group).size());
  std::string text =
      wrapped("", fmt::format("More: octafront help {} GROUP, a group of {}, or all", command.get_name(), keys), 0);
  std::ranges::replace(text, kUnbroken, ' ');
  return text;
}

/// What most people use, a line each.
std::string options_in_brief(const CLI::App& command) {
  std::string text;
  for (const CLI::App* group : groups_of(command))
    for (const CLI::Option* option : own_options(*group))
      if (const std::string brief = brief_of(command, *option); !brief.empty())
        text += fmt::format("{:<28}  {}\n", term_in_help(*option), brief);
  return text;
}

std::string everything(const CLI::App& command) {
  std::string text = positionals_of(command);
  for (const CLI::Option* option : command.get_options())
    if (!option->get_positional()) text += wrapped(term_in_help(*option), option->get_description(), kHelpIndent);
  for (const CLI::App* group : groups_of(command)) text += "\n" + options_in_full(*group);
  return text;
}

}  // namespace

std::string help_of_command(const CLI::App& command, const std::string& topic) {
  const std::vector<const CLI::App*> groups = groups_of(command);
  if (topic == "all" || (topic.empty() && groups.empty()))
    return head_of(command) + everything(command) + "\n" + command.get_footer();
  if (topic.empty())
    return head_of(command) + options_in_brief(command) + groups_in_brief(command) + "\n" + command.get_footer();
  std::string keys;
  for (const CLI::App* group : groups) {
    const OptionGroup& about = about_group(*group);
    if (CLI::detail::to_lower(topic) == about.key || topic == about.name) return options_in_full(*group);
    keys += fmt::format("{}{}", keys.empty() ? "" : ", ", about.key);
  }
  throw OptionError(fmt::format("{} has no group of options \"{}\"; there are {}, and all", command.get_name(), topic,
                                keys.empty() ? "none" : keys));
}

}  // namespace octafront::cli
