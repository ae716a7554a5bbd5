#include "completion.h"

#include <octafront/error.h>

#include "arguments.h"

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// What may stand behind an option.
struct Value {
  bool none = false;  ///< a flag
  bool file = false;
  std::vector<std::string> words = {};  ///< one of these
};

Value value_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (option.get_items_expected_max() == 0) return {.none = true};
  if (type.find('|') != std::string::npos) return {.words = CLI::detail::split(type, '|')};
  return {.file = type.starts_with("FILE") || type == "MESH" || type == "DIR"};
}

std::string joined_words(const std::vector<std::string>& words) {
  return CLI::detail::join(words, " ");
}

std::vector<std::string> names_of_option(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// Of a command, without those by place.
std::vector<const CLI::Option*> named_options(const CLI::App& command) {
  std::vector<const CLI::Option*> options = options_of(command);
  std::erase_if(options, [](const CLI::Option* option) { return names_of_option(*option).empty(); });
  return options;
}

/// Words that may stand by place, such as the shells of `completion`.
std::vector<std::string> words_by_place(const CLI::App& app, const CLI::App& command) {
  for (const CLI::Option* option : options_of(command)) {
    if (!names_of_option(*option).empty()) continue;
    if (option->get_type_name() == "COMMAND") return names_of_commands(app);
    return value_of(*option).words;
  }
  return {};
}

std::string bash_command(const CLI::App& app, const CLI::App& command) {
  std::string values, names;
  for (const CLI::Option* option : named_options(command)) {
    names += (names.empty() ? "" : " ") + joined_words(names_of_option(*option));
    const Value value = value_of(*option);
    if (value.none) continue;
    values += fmt::format("        {}) {}; return ;;\n", CLI::detail::join(names_of_option(*option), "|"),
                          value.words.empty()
                              ? (value.file ? "compopt -o default" : ":")
                              : fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", joined_words(value.words)));
  }
  const std::vector<std::string> words = words_by_place(app, command);
  const std::string by_place = words.empty()
                                   ? "compopt -o default"
                                   : fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", joined_words(words));
  return fmt::format(
      "    {})\n      case $before in\n{}      esac\n      if [[ $word == -* ]]; then COMPREPLY=($(compgen -W '{}' -- "
      "\"$word\"))\n      else {}\n      fi ;;\n",
      command.get_name(), values, names, by_place);
}

std::string bash_script(const CLI::App& app) {
  std::string text =
      "# bash completion for octafront: source <(octafront completion bash)\n_octafront() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n";
  text += fmt::format("    COMPREPLY=($(compgen -W '{} --help --version' -- \"$word\"))\n    return\n  fi\n",
                      joined_words(names_of_commands(app)));
  text += "  case ${COMP_WORDS[1]} in\n";
  for (const CLI::App* command : commands_of(app)) text += bash_command(app, *command);
  return text + "  esac\n}\ncomplete -F _octafront octafront\n";
}

/// Inside single quotes, and inside the brackets and colons of zsh's specifications.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out;
}

std::string zsh_value(const Value& value) {
  if (value.none) return "";
  if (!value.words.empty()) return ":value:(" + joined_words(value.words) + ")";
  return value.file ? ":file:_files" : ":value: ";
}

std::string zsh_command(const CLI::App& app, const CLI::App& command) {
  std::string text = fmt::format("    {})\n      _arguments -s", command.get_name());
  for (const CLI::Option* option : named_options(command))
    for (const std::string& name : names_of_option(*option))
      text += fmt::format(" \\\n        '*{}[{}]{}'", name, zsh_text(option->get_description()),
                          zsh_value(value_of(*option)));
  const std::vector<std::string> words = words_by_place(app, command);
  text +=
      words.empty() ? " \\\n        '*:file:_files'" : fmt::format(" \\\n        ':word:({})'", joined_words(words));
  return text + " ;;\n";
}

std::string zsh_script(const CLI::App& app) {
  std::string text = "#compdef octafront\n# zsh completion for octafront: octafront completion zsh > _octafront\n";
  text += "_octafront() {\n  if (( CURRENT == 2 )); then\n    local -a commands=(\n";
  for (const CLI::App* command : commands_of(app))
    text += fmt::format("      '{}:{}'\n", command->get_name(), zsh_text(command->get_description()));
  text += "    )\n    _describe command commands\n    return\n  fi\n  local command=${words[2]}\n";
  text += "  words=(\"octafront $command\" \"${(@)words[3,-1]}\")\n  (( CURRENT-- ))\n  case $command in\n";
  for (const CLI::App* command : commands_of(app)) text += zsh_command(app, *command);
  return text + "  esac\n}\ncompdef _octafront octafront\n";
}

std::string fish_text(const std::string& text) {
  std::string out;
  for (const char c : text) out += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out;
}

std::string fish_option(const std::string& command, const CLI::Option& option) {
  std::string text = fmt::format("complete -c octafront -n '__fish_seen_subcommand_from {}'", command);
  for (const std::string& name : option.get_snames()) text += " -s " + name;
  for (const std::string& name : option.get_lnames()) text += " -l " + name;
  const Value value = value_of(option);
  if (!value.none) text += value.file ? " -r -F" : " -x";
  if (!value.words.empty()) text += fmt::format(" -a '{}'", joined_words(value.words));
  return text + fmt::format(" -d '{}'\n", fish_text(option.get_description()));
}

std::string fish_script(const CLI::App& app) {
  std::string text = "# fish completion for octafront: octafront completion fish | source\n";
  for (const CLI::App* command : commands_of(app)) {
    text += fmt::format("complete -c octafront -n __fish_use_subcommand -f -a {} -d '{}'\n", command->get_name(),
                        fish_text(command->get_description()));
    for (const CLI::Option* option : named_options(*command)) text += fish_option(command->get_name(), *option);
    const std::vector<std::string> words = words_by_place(app, *command);
    if (!words.empty())
      text += fmt::format("complete -c octafront -n '__fish_seen_subcommand_from {}' -f -a '{}'\n", command->get_name(),
                          joined_words(words));
  }
  return text;
}

}  // namespace

std::string completion_for(const std::string& shell, const CLI::App& app) {
  if (shell == "bash") return bash_script(app);
  if (shell == "zsh") return zsh_script(app);
  if (shell == "fish") return fish_script(app);
  throw OptionError("completion is for bash, zsh and fish; \"" + shell + "\" is none of them");
}

}  // namespace octafront::cli
