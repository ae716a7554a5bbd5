#pragma once

#include <octafront/error.h>

#include "arguments.h"

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::cli {

struct LineOption;
/// Declares an option whose value goes to the arguments.
using Add = std::function<CLI::Option*(CLI::App&, const LineOption&, Arguments&)>;

/// An option that no row of the library's tables has, for it takes more than one value, or is about files and the run.
struct LineOption {
  std::string_view commands;  ///< with blanks between
  std::string_view group, names, letter;
  std::string help;
  Add add;
  std::string_view brief = {};  ///< of those that most people use
};
const std::vector<LineOption>& line_options();

/// Does `set()`; what the library refuses is a wrong usage of the option. Throws CLI::ValidationError.
template <class Set>
void as_usage(const std::string& option, const Set& set) {
  try {
    set();
  } catch (const OptionError& error) {
    const std::string text = error.what();
    const std::size_t end = text.starts_with('`') ? text.find('`', 1) + 1 : 0;
    throw CLI::ValidationError(option, text.substr(std::min(text.size(), text.find_first_not_of(": ", end))));
  }
}

/// take(arguments, typed) for each time that the option stands there.
template <class Take>
Add each(const Take& take) {
  return [take](CLI::App& app, const LineOption& o, Arguments& a) {
    const std::string option(o.names);
    return app
        .add_option_function<std::vector<std::string>>(
            option,
            [&a, take, option](const std::vector<std::string>& all) {
              for (const std::string& typed : all) as_usage(option, [&] { take(a, typed); });
            },
            o.help)
        ->type_name(std::string(o.letter))
        ->allow_extra_args(false);
  };
}

/// A group of options: `octafront help COMMAND KEY` shows it.
struct OptionGroup {
  std::string_view name, key, about;
};
/// In the order of help.
const std::vector<OptionGroup>& option_groups();

/// NAME=x,y,z. Throws CLI::ValidationError.
RegionSeed region_seed(const std::string& typed);

/// "1e5" is a number of elements too. Throws CLI::ValidationError.
std::int64_t whole_number(const std::string& option, double n);

}  // namespace octafront::cli
