#pragma once

#include <octafront/options.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace octafront {

struct IntakeOptions;
struct WriteOptions;

/// The value of an option; monostate: none is given, and the library chooses.
using OptionValue = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

/// What is known of one option, for programs that set options by name: the command line, bindings to other languages,
/// forms, files.
struct OptionInfo {
  enum class Kind { kNumber, kWhole, kFlag, kChoice, kText };
  std::string_view name;   ///< as on the command line, with underscores: "keep_surface"
  std::string_view field;  ///< what messages of the library call it, in backquotes: "keep"
  std::string_view group;  ///< e.g. "Sizes"
  std::string_view tasks;  ///< which of "mesh", "surface", "size", "improve", "adapt" heed it, separated by blanks
  Kind kind = Kind::kNumber;
  std::vector<std::string_view> choices;  ///< the values of a kChoice, and of a kWhole that is one of few
  std::string_view help;                  ///< a sentence, with units
  std::string_view unset;                 ///< what holds without a value, where that is no value: "40; images: 85"
  std::string_view letter;                ///< what stands for its value in help, "H"; empty for flags and choices
  bool is_length = false;                 ///< in the unit of the input
  /// The numbers that it may be; none: any. `is_above`, `is_below`: the ends are none of them.
  std::optional<double> least, most;
  bool is_above = false, is_below = false;
  /// Which commands of `octafront` take it, beside those of `tasks`; "-": none.
  std::string_view commands;
  std::string_view typed;  ///< its name there where that is another one, "no-heal"; a flag "no-..." sets false
  std::string_view brief;  ///< in a few words, of those that most people use; else empty

  /// "above 0 and at most 1"; empty: any number.
  std::string range() const;
};

/// Every option that one value sets, in the order of Options. What takes more has no row: SizeOptions::regions,
/// point_sizes, named, near, mesh, field and callback, ImproveOptions::after_pass, Options::groups.
const std::vector<OptionInfo>& option_table();

/// The value of an option. Throws OptionError if there is none of that name.
OptionValue option_value(const Options& options, std::string_view name);

/// Sets an option; numbers may come as whole ones. Ranges are looked at by check_options(). Throws OptionError if there
/// is no option of that name, or for a value of another kind.
void set_option(Options& options, std::string_view name, const OptionValue& value);

/// Throws OptionError for a value that is not in the range of its row.
void check_ranges(const Options& options);

/// The same of what is asked on the way in (octafront/domain.h). No rows have ComplexOptions::regions and voids,
/// ImageIntake::names_file, crop and resample, LabelOptions, ImageRegions::bands, IntakeOptions::tidies and tell.
const std::vector<OptionInfo>& intake_table();
OptionValue option_value(const IntakeOptions& options, std::string_view name);
void set_option(IntakeOptions& options, std::string_view name, const OptionValue& value);
void check_ranges(const IntakeOptions& options);

/// The same of what is asked of a mesh that is written (octafront/io.h).
const std::vector<OptionInfo>& write_table();
OptionValue option_value(const WriteOptions& options, std::string_view name);
void set_option(WriteOptions& options, std::string_view name, const OptionValue& value);
void check_ranges(const WriteOptions& options);

}  // namespace octafront
