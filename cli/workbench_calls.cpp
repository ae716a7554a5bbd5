#include "workbench_calls.h"

#include <octafront/io.h>

#include "schema.h"
#include "workbench_files.h"

#include <algorithm>
#include <string_view>

namespace octafront::cli {

namespace {

/// What the page may run: tools of the door for agents, and what the page alone needs of them.
const std::vector<Tool>& workbench_tools() {
  using Output = Tool::Output;
  static const std::vector<Tool> all = [] {
    using Input = Tool::Input;
    std::vector<Tool> known{{"info", "", "", "info", Output::kNone, Input::kOne, ""},
                            {"surface", "", "", "surface", Output::kOne, Input::kSeveral, ""},
                            {"report", "", "", "report", Output::kOne, Input::kOne, ""}};
    for (const Tool& tool : tools())
      if (!std::string_view(tool.command).empty()) known.push_back(tool);
    return known;
  }();
  return all;
}

/// Throws RefusedRequest.
Json parsed_call(const std::string& text) {
  constexpr int kDeepest = 64;
  bool is_too_deep = false;
  const auto deep = [&](int depth, Json::parse_event_t, Json&) {
    return !(is_too_deep = is_too_deep || depth > kDeepest);
  };
  Json call = Json::parse(text, deep, false);
  if (is_too_deep || !call.is_object() || !call.contains("tool") || !call["tool"].is_string() ||
      !call.contains("arguments") || !call["arguments"].is_object())
    throw RefusedRequest{400, "bad_json", "a call is a JSON object with a tool and its arguments"};
  return call;
}

/// Outputs are plain names, in the folder of the run. Throws RefusedRequest.
void check_outputs(const Json& arguments) {
  if (!arguments.is_object() || !arguments.contains("output")) return;
  const Json& output = arguments["output"];
  for (const Json& name : output.is_array() ? output : Json::array({output}))
    if (!name.is_string() || !is_plain_name(name.get<std::string>()))
      throw RefusedRequest{400, "bad_name", "an output is the name of a file, without a folder"};
}

}  // namespace

Json in_json(const RefusedRequest& refused) {
  return {{"error", {{"kind", "request"}, {"code", refused.code}, {"message", refused.message}}}};
}

Json file_in_json(const std::filesystem::path& file, const std::string& name) {
  std::error_code ignored;
  return {{"name", name}, {"path", file.string()}, {"bytes", std::filesystem::file_size(file, ignored)}};
}

Json about_workbench(const CLI::App& app, const std::filesystem::path& file) {
  Json formats = Json::array();
  for (const FormatInfo& info : known_formats())
    if (info.writes_mesh)
      formats.push_back(
          {{"name", info.name}, {"title", info.title}, {"endings", info.endings}, {"one_file", info.one_file}});
  Json found{{"version", OCTAFRONT_VERSION}, {"formats", formats}};
  found["options"] = schema_of(app)["$defs"]["options_of_mesh"]["properties"];
  found["file"] = file.empty() ? Json() : file_in_json(file, file.filename().string());
  return found;
}

ToolCall call_of(const std::string& text) {
  Json call = parsed_call(text);
  const auto tool = std::ranges::find_if(workbench_tools(), [&](const Tool& t) { return call["tool"] == t.name; });
  if (tool == workbench_tools().end()) throw RefusedRequest{400, "no_tool", "there is no tool of this name"};
  check_outputs(call["arguments"]);
  return {&*tool, std::move(call["arguments"])};
}

Json outcome_of(const RunOfTool& run, const std::vector<RunResult>& results, const Folders& folders) {
  Json told = answer_of(run.tool, run.arguments, results, folders);
  Json done{{"status", told["status"]}, {"reports", Json::array()}, {"files", Json::array()}, {"run", run.number}};
  for (const char* key : {"error", "next", "sources"})
    if (told.contains(key)) done[key] = told[key];
  for (const RunResult& result : results) done["reports"].push_back(result.report);
  for (const std::string& name : files_below(run.folder))
    done["files"].push_back(file_in_json(run.folder / name, name));
  return done;
}

}  // namespace octafront::cli
