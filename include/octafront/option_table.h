#pragma once

#include <octafront/options.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace octafront {

struct IntakeOptions;

/// What is known of one option, for programs that set options by name: bindings to other languages, forms, files.
struct OptionInfo {
  enum class Kind { kNumber, kWhole, kFlag, kChoice, kText };
  std::string_view name;   ///< as on the command line, with underscores: "keep_surface"
  std::string_view field;  ///< what messages of the library call it, in backquotes: "keep"
  std::string_view group;  ///< e.g. "Sizes"
  std::string_view tasks;  ///< which of "mesh", "surface", "size", "improve", "adapt" heed it, separated by blanks
  Kind kind = Kind::kNumber;
  std::vector<std::string_view> choices;  ///< the values of a kChoice
  std::string_view help;                  ///< a sentence, with units
};

/// The value of an option; monostate: none is given, and the library chooses.
using OptionValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

/// Every option that one value sets, in the order of Options. What takes more has no row: SizeOptions::regions,
/// point_sizes, named, field and callback, ImproveOptions::after_pass.
const std::vector<OptionInfo>& option_table();

/// The value of an option. Throws OptionError if there is none of that name.
OptionValue option_value(const Options& options, std::string_view name);

/// Sets an option; numbers may come as whole ones. Ranges are looked at by check_options(). Throws OptionError if there
/// is no option of that name, or for a value of another kind.
void set_option(Options& options, std::string_view name, const OptionValue& value);

/// The same of what is asked on the way in (octafront/domain.h). No rows have ComplexOptions::regions and voids,
/// ImageIntake::names_file, crop and resample, LabelOptions, ImageRegions::bands, IntakeOptions::tidies and tell.
const std::vector<OptionInfo>& intake_table();
OptionValue option_value(const IntakeOptions& options, std::string_view name);
void set_option(IntakeOptions& options, std::string_view name, const OptionValue& value);

}  // namespace octafront
