#pragma once

#include "folders.h"
#include "session.h"

#include <optional>
#include <string>
#include <vector>

namespace octafront::cli {

/// What every call may take at most; what a call asks for less holds.
struct ToolLimits {
  std::optional<double> elements, seconds, memory_mb;
  int threads = 0;
};

/// A tool: a command of the program, for programs that talk to it.
struct Tool {
  const char *name, *title, *about;
  const char* command;  ///< of the command line; empty: answered without one
  enum class Output { kNone, kOne, kSeveral, kPicture } output = Output::kNone;
  enum class Input { kOne, kSeveral, kTwo } input = Input::kOne;
  const char* keys;  ///< of the report that are answered, with blanks between
};
const std::vector<Tool>& tools();
/// Null: there is none.
const Tool* tool_called(const std::string& name);

/// As `tools/list` has it, with the schemas of what goes in and what comes out: made of the table of options, and of
/// the schema of reports.
Json tool_in_json(const Tool& tool, const CLI::App& app, const Folders& folders);

/// A call that cannot be: what is wrong with its arguments.
struct BadCall {
  std::string code, message;
};

/// What a call runs, one after the other: command lines without the name of the program.
struct Plan {
  std::vector<std::vector<std::string>> lines;
  std::optional<double> seconds;  ///< at most, by the clock
};
/// Throws BadCall.
Plan plan_of(const Tool& tool, const Json& arguments, const CLI::App& app, const Folders& folders,
             const ToolLimits& limits);

/// What a run left.
struct RunResult {
  int status = 0;
  Json report;         ///< of --json; null where there is none
  std::string errors;  ///< what it said
};

/// What a call is answered, by the schema of the tool: the keys of its reports, lists cut where they are long; of a
/// call that failed what is wrong and which calls may help.
Json answer_of(const Tool& tool, const Json& arguments, const std::vector<RunResult>& runs, const Folders& folders);
Json answer_of(const BadCall& refused, const Tool& tool, const Json& arguments, const Folders& folders);
/// The same in a sentence.
std::string in_a_sentence(const Tool& tool, const Json& answer);

/// What an option means, or what was wrong with the last run that failed; `last`: its answer, or null.
Json explained(const Json& arguments, const Json& last, const CLI::App& app);

}  // namespace octafront::cli
