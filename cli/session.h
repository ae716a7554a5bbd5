#pragma once

#include <octafront/report.h>
#include <octafront/run_context.h>

#include "arguments.h"
#include "failure.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace octafront::cli {

/// As the name of a file.
inline constexpr const char* kStandardOutput = "-";

using Json = nlohmann::ordered_json;

/// One run of a command: what was asked for, whom to tell, and what will stand in the JSON file.
class Session {
 public:
  /// `ranks`: that make the mesh together; null: this process is alone.
  explicit Session(const Arguments& arguments, Ranks* ranks = nullptr);

  const Arguments& arguments() const { return arguments_; }
  const RunContext& context() const { return context_; }

  /// Of several ranks only the first writes and speaks; who is alone is the first.
  bool is_first() const;

  /// To stdout, with fields of Options as the command line names them; nothing if the user wants none, or JSON there.
  void say(const std::string& text) const;
  /// What coordinates of the mesh count; empty: not known.
  std::string unit;
  /// Domain::densities.
  std::vector<std::pair<std::string, double>> densities;
  /// Where x, y and z of the mesh point, as Image::frame has it; empty: not known.
  std::string frame;

  /// What was asked for itself, such as a manual: byte by byte.
  void say_exactly(const std::string& text) const;
  void say_notes(const std::string& stage, const std::vector<std::string>& notes) const;
  /// Notes on what was asked for and is not there: on stderr where others are not shown.
  void warn(const std::string& stage, const std::vector<std::string>& notes) const;
  /// The table of a run; the same goes into the JSON file.
  void tell(const Report& report);
  /// Further keys of the JSON file.
  void found(const Json& keys) { findings_.update(keys); }

  /// `text` as it may go to a terminal, with fields of Options as the command line names them.
  std::string shown(const std::string& text) const;
  /// All that is known of the run; `error` is null for one that did what it was asked.
  Json json(const Json& error) const;
  /// Writes the JSON file if one is wanted; `error` is null for a run that did what it was asked. Throws OutputError.
  void write_json(const Json& error) const;

 private:
  const Arguments& arguments_;
  RunContext context_;
  Json findings_ = Json::object();
};

/// What the JSON of every run begins with.
Json json_head(const std::string& command, const std::string& command_line);
/// `error` of the JSON of a run that failed.
Json json_of(const Failure& failure);
/// Writes it. Throws OutputError.
void write_json_to(const std::filesystem::path& target, const Json& json);

/// The output that a cavity which stays open is written beside; empty if there is none.
std::filesystem::path cavity_neighbour(const Arguments& arguments);

/// Refuses outputs that would overwrite an input or each other, before any work. Throws OptionError, OutputError.
void check_files(const Arguments& arguments);

}  // namespace octafront::cli
