#include "workbench_module.h"

#include "command_line.h"
#include "failure.h"
#include "program.h"
#include "workbench_calls.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace octafront;
using namespace octafront::cli;

/// Where the page puts the files that it has, and where runs write.
const std::filesystem::path kGiven = "/files-of-page", kMade = "/made";

struct CallInModule {
  ToolCall call;
  std::string number;
  std::filesystem::path folder;
  Folders folders;
  Plan plan;
  std::vector<RunResult> results;
};
std::unique_ptr<CallInModule> current_call;

const char* kept_text(const Json& json) {
  static std::string text;
  text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.c_str();
}

Json begun(const std::string& text, const std::string& number) {
  Program program;
  ToolCall call = call_of(text);
  const std::filesystem::path folder = kMade / number;
  std::filesystem::create_directories(folder), std::filesystem::create_directories(kGiven);
  const Folders folders({folder, kGiven, kMade});
  try {
    Plan plan = plan_of(*call.tool, call.arguments, program.app(), folders, {});
    current_call.reset(new CallInModule{std::move(call), number, folder, folders, std::move(plan), {}});
  } catch (const BadCall& bad) {
    return answer_of(bad, *call.tool, call.arguments, folders);
  }
  std::filesystem::current_path(folder);
  ::setenv("OCTAFRONT_PROGRESS", "lines", 1);
  return {{"lines", current_call->plan.lines.size()}};
}

/// What a line wrote to standard output: its report.
Json report_in(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  Json report = Json::parse(in, nullptr, false);
  return report.is_discarded() ? Json() : report;
}

}  // namespace

const char* octafront_workbench_about() {
  Program program;
  return kept_text(about_workbench(program.app(), {}));
}

const char* octafront_workbench_begin(const char* call, const char* number) {
  try {
    return kept_text(begun(call, number));
  } catch (const RefusedRequest& refused) {
    return kept_text(in_json(refused));
  }
}

int octafront_workbench_line() {
  const std::filesystem::path output = "/output.json";
  if (std::freopen(output.c_str(), "w", stdout) == nullptr) return kInternal;
  std::vector<RunResult>& results = current_call->results;
  std::vector<std::string> words{"octafront"};
  for (const std::string& word : current_call->plan.lines[results.size()]) words.push_back(word);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int status = octafront_command_line(static_cast<int>(words.size()), argv.data());
  std::fflush(stdout);
  results.push_back({status, report_in(output), ""});
  return status;
}

const char* octafront_workbench_end(const char* errors) {
  CallInModule& current = *current_call;
  current.results.back().errors = errors;
  const RunOfTool run{*current.call.tool, current.call.arguments, current.number, current.folder};
  return kept_text(outcome_of(run, current.results, current.folders));
}
