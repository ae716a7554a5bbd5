#include "mcp_tools.h"

#include <octafront/option_table.h>

#include "arguments.h"
#include "schema.h"
#include "text.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// Options that the server gives itself, or that would write where it reads.
constexpr std::string_view kOwnOptions[] = {"help",   "json",         "quiet",       "output", "threads",
                                            "memory", "max-elements", "cpu-seconds", "within", "dry-run"};
constexpr std::size_t kListed = 40;
constexpr double kLeastMegabytes = 64;  // without which nothing runs

const OptionInfo* row_of(const std::string& name) {
  std::string field = name;
  std::ranges::replace(field, '-', '_');
  for (const auto* table : {&option_table(), &intake_table(), &write_table()})
    for (const OptionInfo& info : *table)
      if (info.name == field) return &info;
  return nullptr;
}

bool is_own(const std::string& name) {
  return std::ranges::find(kOwnOptions, name) != std::end(kOwnOptions);
}

const CLI::App* command_called(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : commands_of(app))
    if (command->get_name() == name) return command;
  return nullptr;
}

/// Those that a call may give.
std::vector<const CLI::Option*> options_for_calls(const CLI::App& command) {
  std::vector<const CLI::Option*> all;
  for (const CLI::Option* option : options_of(command))
    if (!option->get_lnames().empty() && !is_own(option->get_lnames().front())) all.push_back(option);
  return all;
}

bool is_flag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

/// The value of an option in a call: a number, a text, or a list of them where it may be repeated.
Json option_in_schema(const CLI::Option& option, const std::string& about) {
  const std::string type = option.get_type_name(), name = option.get_lnames().front();
  Json row{{"description", about}};
  if (is_flag(option)) {
    row["type"] = "boolean";
  } else if (type.find('|') != std::string::npos && type == CLI::detail::to_lower(type)) {
    row["enum"] = CLI::detail::split(type, '|');
    // "2" is 2 to whoever writes JSON.
    if (const OptionInfo* info = row_of(name); info != nullptr && info->kind == OptionInfo::Kind::kWhole)
      for (const std::string& choice : CLI::detail::split(type, '|')) row["enum"].push_back(Json::parse(choice));
  } else if (const OptionInfo* info = row_of(name); info != nullptr && info->kind != OptionInfo::Kind::kText) {
    row["type"] = {"number", "string"};
  } else {
    row["type"] = {"string", "number", "array"};
    row["items"] = {{"type", {"string", "number"}}};
  }
  return row;
}

Json files_in_schema(const char* about, bool several) {
  Json one{{"type", "string"}, {"minLength", 1}};
  if (!several) return {{"type", "string"}, {"minLength", 1}, {"description", about}};
  return {{"anyOf", {one, {{"type", "array"}, {"items", one}, {"minItems", 1}}}}, {"description", about}};
}

Json input_in_schema(Tool::Input input) {
  switch (input) {
    case Tool::Input::kOne:
      return files_in_schema("file", false);
    case Tool::Input::kSeveral:
      return files_in_schema("file; or several, a body each; or a formula", true);
    case Tool::Input::kTwo:
      break;
  }
  return {{"type", "array"},
          {"items", {{"type", "string"}, {"minLength", 1}}},
          {"minItems", 2},
          {"maxItems", 2},
          {"description", "two files: the mesh with the fields, and the mesh that they go to"}};
}

Json limits_in_schema() {
  const auto above_0 = [](const char* about) {
    return Json{{"type", "number"}, {"exclusiveMinimum", 0}, {"description", about}};
  };
  return {{"type", "object"},
          {"description", "what this call may take at most"},
          {"additionalProperties", false},
          {"properties",
           {{"elements", above_0("tetrahedra that are made or read")},
            {"seconds", above_0("by the clock")},
            {"memory_mb", {{"type", "number"}, {"minimum", kLeastMegabytes}, {"description", "megabytes"}}}}}};
}

Json options_in_schema(const CLI::App& command) {
  Json properties = Json::object(), others = Json::array();
  for (const CLI::Option* option : options_for_calls(command)) {
    const std::string brief = brief_of(command, *option), name = option->get_lnames().front();
    brief.empty() ? others.push_back(name) : void(properties[name] = option_in_schema(*option, brief));
  }
  std::string names;
  for (const Json& name : others) names += (names.empty() ? "" : ", ") + name.get<std::string>();
  Json schema{{"type", "object"}, {"properties", properties}};
  schema["additionalProperties"] = {{"type", {"string", "number", "boolean", "array"}}};
  schema["description"] =
      names.empty() ? "options" : "options; explain {option} says what each of these further ones means: " + names;
  return schema;
}

Json input_schema(const Tool& tool, const CLI::App& app) {
  Json properties = Json::object();
  Json required = Json::array();
  if (std::string_view(tool.command).empty()) {
    properties["option"] = {{"type", "string"}, {"description", "an option, such as layers: what it means and takes"}};
    properties["command"] = {{"type", "string"}, {"description", "the tool that takes the option [mesh]"}};
    properties["file"] = {{"type", "string"}, {"description", "a surface or a mesh: what is wrong with it, and where"}};
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  }
  const CLI::App& command = *command_called(app, tool.command);
  properties["input"] = input_in_schema(tool.input);
  required.push_back("input");
  if (tool.output == Tool::Output::kOne || tool.output == Tool::Output::kSeveral) {
    properties["output"] = files_in_schema(
        "file that is written, its format by the ending (.inp CalculiX and Abaqus, .msh Gmsh, .vtu ParaView, .med, "
        ".bdf Nastran, ...)",
        tool.output == Tool::Output::kSeveral);
    required.push_back("output");
  }
  if (tool.output == Tool::Output::kPicture)
    properties["output"] = files_in_schema("PNG that is written; without it the picture is in the answer alone", false);
  properties["options"] = options_in_schema(command);
  properties["limits"] = limits_in_schema();
  return {{"type", "object"}, {"properties", properties}, {"required", required}, {"additionalProperties", false}};
}

std::vector<std::string> words_in(const char* keys) {
  std::vector<std::string> words;
  for (const std::string& word : CLI::detail::split(keys, ' '))
    if (!word.empty()) words.push_back(word);
  return words;
}

Json call_in_schema() {
  return {{"type", "array"},
          {"description", "calls that may help, the likeliest first"},
          {"items",
           {{"type", "object"},
            {"required", {"tool", "why"}},
            {"properties",
             {{"tool", {{"type", "string"}}}, {"arguments", {{"type", "object"}}}, {"why", {{"type", "string"}}}}}}}};
}

Json output_schema(const Tool& tool, const CLI::App& app) {
  const Json reports = schema_of(app);
  Json properties{
      {"status", {{"type", "integer"}, {"description", "0: done"}}},
      {"command_line", {{"type", "string"}, {"description", "the same by hand"}}},
      {"error",
       {{"type", "object"},
        {"properties",
         {{"kind", {{"type", "string"}}}, {"code", {{"type", "string"}}}, {"message", {{"type", "string"}}}}},
        {"required", {"kind", "code", "message"}}}},
      {"next", call_in_schema()},
      {"cut",
       {{"type", "array"}, {"items", {{"type", "string"}}}, {"description", "lists of which the first are here"}}}};
  for (const std::string& key : words_in(tool.keys)) {
    properties[key] = reports["properties"].contains(key) ? reports["properties"][key] : Json::object();
    // What is not told of a failed run, or cut, is no breach.
    properties[key].erase("additionalProperties");
  }
  if (std::string_view(tool.name) == "plan")
    properties["sources"] = {{"type", "array"},
                             {"description", "who asked for the sizes, and for which part of the elements"},
                             {"items", {{"type", "object"}}}};
  if (std::string_view(tool.name) == "explain")
    properties["text"] = {{"type", "string"}},
    properties["advice"] = {{"type", "array"}, {"items", {{"type", "string"}}}};
  return {{"type", "object"}, {"properties", properties}, {"required", {"status"}}};
}

}  // namespace

const std::vector<Tool>& tools() {
  using Output = Tool::Output;
  using Input = Tool::Input;
  static const std::vector<Tool> all{
      {"inspect", "What is in a file",
       "What a file holds before anything is made: a CAD file's solids, named faces, contacts and unit; a surface's "
       "patches, area, defects, thinnest wall and shortest edge; a mesh's order, quality and groups; an image's "
       "labels. Names that it lists are "
       "places for options of the other tools.",
       "info", Output::kNone, Input::kOne,
       "kind format unit lengths notes input_notes triangles vertices box area places bodies cavities clean defects "
       "solids named_faces contacts thickness shortest_edge shortest_edges narrowest_faces groups size spacing frame "
       "voxels labels least largest points tets order volume "
       "quality worst_element"},
      {"plan", "What meshing would take",
       "A dry run of mesh: elements, memory and seconds, and which source of size asked for the elements. Nothing is "
       "written. Call it before mesh where sizes are not sure.",
       "mesh", Output::kNone, Input::kSeveral, "dry_run expected_tets input_volume bodies notes defects leak"},
      {"mesh", "Make a tetrahedral mesh",
       "Meshes CAD (STEP, IGES, BREP), surfaces (STL, OBJ, PLY, ...), images of voxels or a formula into valid "
       "tetrahedra and writes it. Names of solids and faces become groups. Without a size an automatic one is chosen. "
       "For solvers of structures give order 2.",
       "mesh", Output::kSeveral, Input::kSeveral,
       "tets points boundary_faces order volume input_volume true_volume regions layers opened_contacts quality "
       "worst_element second_order output outputs notes defects leak wall_seconds hash"},
      {"check", "Whether a surface or a mesh is sound",
       "Whether a surface can be meshed as it is, or a mesh is valid; with options {solver} which elements a solver "
       "would warn of or refuse.",
       "check", Output::kNone, Input::kSeveral,
       "kind format clean valid defects repairs bodies cavities volume tets quality worst_elements solver second_order "
       "groups"},
      {"improve", "Make the elements of a mesh better",
       "Smoothing and reconnection of a mesh of any tool; its names and sets stay.", "improve", Output::kSeveral,
       Input::kOne, "tets points order quality worst_element output outputs notes wall_seconds hash"},
      {"adapt", "Change a mesh to other sizes",
       "Refines and coarsens a mesh until it fits sizes: size, size-near, a field of sizes, a metric, or a field of "
       "the mesh (from, with elements).",
       "adapt", Output::kSeveral, Input::kOne,
       "tets points order quality fit deviation carried output outputs notes wall_seconds hash"},
      {"carry", "Bring fields of one mesh to another",
       "Values at nodes and in elements of a mesh, such as a solver's, on a mesh made anew: of elements integrals and "
       "bounds stay. Fields are named by options {carry: [T, rho]}; without, all go.",
       "carry", Output::kSeveral, Input::kTwo, "carry carried tets points output outputs notes wall_seconds hash"},
      {"move", "Move a mesh by a field",
       "A mesh moved by the field of displacements that options {displacement: NAME} name, in steps as long as its "
       "elements allow, mended on the way; other fields go along.",
       "move", Output::kSeveral, Input::kOne,
       "history carry carried tets points order quality worst_element output outputs notes wall_seconds hash"},
      {"convert", "Write a mesh in another format", "With all names and sets that the other format holds.", "convert",
       Output::kSeveral, Input::kOne, "output outputs notes input_notes"},
      {"explain", "What an option means, or why a run failed",
       "With {option} what it means and takes; with {file} what is wrong with a surface or poor in a mesh, where, and "
       "what to do; without arguments why the last call that failed did.",
       "", Output::kNone, Input::kOne, "kind clean valid defects quality worst_elements"},
      {"picture", "Draw an input or a mesh",
       "A PNG of a file: cut open with options {cut: y}, faces by name {names: true}, where a face is {highlight: "
       "NAME}, the worst element {worst: true}, coloured by {color: quality, region, size or patch}.",
       "picture", Output::kPicture, Input::kSeveral, "picture"},
  };
  return all;
}

const Tool* tool_called(const std::string& name) {
  for (const Tool& tool : tools())
    if (tool.name == name) return &tool;
  return nullptr;
}

Json tool_in_json(const Tool& tool, const CLI::App& app, const Folders& folders) {
  std::string where;
  for (const std::string& folder : folders.all()) where += (where.empty() ? "" : ", ") + folder;
  Json made{{"name", tool.name},
            {"title", tool.title},
            {"description", fmt::format("{} Files are in {}.", tool.about, where)},
            {"inputSchema", input_schema(tool, app)},
            {"outputSchema", output_schema(tool, app)}};
  const bool writes = tool.output != Tool::Output::kNone;
  made["annotations"] = {{"readOnlyHint", !writes}, {"destructiveHint", writes}, {"openWorldHint", false}};
  return made;
}

namespace {

/// A file that the call names, as the command line takes it. Throws BadCall.
std::string file_of(const Json& value, const char* what, const Folders& folders) {
  if (!value.is_string()) throw BadCall{"bad_arguments", fmt::format("{} is the name of a file", what)};
  const std::string name = value;
  if (name.empty() || name.find('\0') != std::string::npos)
    throw BadCall{"bad_arguments", fmt::format("{} has no name that a file can have", what)};
  if (name == "-")
    throw BadCall{"bad_arguments",
                  fmt::format("{} is the name of a file; standard input and output are the server's own", what)};
  if (!folders.hold(name))
    throw BadCall{"outside_folders", fmt::format("{}: lies outside of the folders that files may be in", name)};
  return name.starts_with('-') ? "./" + name : name;
}

std::vector<std::string> files_of(const Json& arguments, const char* key, bool several, const Folders& folders) {
  if (!arguments.contains(key)) throw BadCall{"bad_arguments", fmt::format("{} is missing", key)};
  const Json& value = arguments[key];
  if (!several || !value.is_array()) return {file_of(value, key, folders)};
  constexpr std::size_t kMostFiles = 1000;
  if (value.empty() || value.size() > kMostFiles)
    throw BadCall{"bad_arguments", fmt::format("{}: 1 to {} files", key, kMostFiles)};
  std::vector<std::string> all;
  for (const Json& one : value) all.push_back(file_of(one, key, folders));
  return all;
}

std::string typed(const std::string& name, const Json& value) {
  std::string text;
  if (value.is_string())
    text = value;
  else if (value.is_number_integer())
    text = value.dump();
  else if (value.is_number())
    text = fmt::format("{}", value.get<double>());
  else
    throw BadCall{"bad_arguments", fmt::format("{}: a text or a number", name)};
  if (text.empty() || text.find('\0') != std::string::npos)
    throw BadCall{"bad_arguments", fmt::format("{}: an empty value", name)};
  return text;
}

void add_option_words(const CLI::App& command, const std::string& name, const Json& value,
                      std::vector<std::string>& line) {
  const std::vector<const CLI::Option*> known = options_for_calls(command);
  const auto found = std::ranges::find_if(
      known, [&](const CLI::Option* o) { return std::ranges::find(o->get_lnames(), name) != o->get_lnames().end(); });
  if (found == known.end()) {
    std::vector<std::string> names;
    for (const CLI::Option* option : known) names.push_back(option->get_lnames().front());
    const std::string nearest = nearest_word(name, names);
    throw BadCall{"unknown_option", fmt::format("there is no option {}{}", name,
                                                nearest.empty() ? "" : "; did you mean " + nearest + "?")};
  }
  if (value.is_boolean()) {
    if (!is_flag(**found)) throw BadCall{"bad_arguments", fmt::format("{} takes a value", name)};
    if (value.get<bool>()) line.push_back("--" + name);
    return;
  }
  if (is_flag(**found)) throw BadCall{"bad_arguments", fmt::format("{} is true or false", name)};
  const Json list = value.is_array() ? value : Json::array({value});
  for (const Json& one : list) line.push_back(fmt::format("--{}={}", name, typed(name, one)));
}

/// The lesser of what the server and the call allow.
std::optional<double> least_limit(const Json& arguments, const char* key, const std::optional<double>& most) {
  std::optional<double> asked;
  if (arguments.contains("limits") && arguments["limits"].contains(key)) {
    const Json& value = arguments["limits"][key];
    if (!value.is_number() || !(value.get<double>() > 0))
      throw BadCall{"bad_arguments", fmt::format("limits.{} is a number above 0", key)};
    asked = value.get<double>();
  }
  return asked && most ? std::optional(std::min(*asked, *most)) : asked ? asked : most;
}

void add_limits(const Json& arguments, const ToolLimits& limits, const Folders& folders, Plan& plan,
                std::vector<std::string>& line) {
  if (arguments.contains("limits") && !arguments["limits"].is_object())
    throw BadCall{"bad_arguments", "limits is an object"};
  if (const auto n = least_limit(arguments, "elements", limits.elements))
    line.push_back(fmt::format("--max-elements={:.0f}", std::max(1.0, std::floor(*n))));
  const auto mb = least_limit(arguments, "memory_mb", limits.memory_mb);
  if (mb && *mb < kLeastMegabytes)
    throw BadCall{"bad_arguments", fmt::format("limits.memory_mb is {} at least", kLeastMegabytes)};
  if (mb) line.push_back(fmt::format("--memory={:.0f}", std::ceil(*mb * 1e6)));
  plan.seconds = least_limit(arguments, "seconds", limits.seconds);
  if (limits.threads > 0) line.push_back(fmt::format("--threads={}", limits.threads));
  for (const std::string& folder : folders.all()) line.push_back("--within=" + folder);
}

void refuse_others(const Json& arguments, const std::set<std::string>& known) {
  for (const auto& [key, value] : arguments.items())
    if (!known.contains(key))
      throw BadCall{"bad_arguments", fmt::format("there is no argument {}{}", key,
                                                 key == "options" ? "" : "; options of the program go into options")};
}

}  // namespace

Plan plan_of(const Tool& tool, const Json& arguments, const CLI::App& app, const Folders& folders,
             const ToolLimits& limits) {
  if (!arguments.is_object()) throw BadCall{"bad_arguments", "arguments are an object"};
  Plan plan;
  if (std::string_view(tool.command).empty()) {
    refuse_others(arguments, {"option", "command", "file"});
    if (!arguments.contains("file")) return plan;
    std::vector<std::string> line{"check", file_of(arguments["file"], "file", folders), "--json=-"};
    add_limits(arguments, limits, folders, plan, line);
    plan.lines.push_back(line);
    return plan;
  }
  refuse_others(arguments, tool.output == Tool::Output::kNone
                               ? std::set<std::string>{"input", "options", "limits"}
                               : std::set<std::string>{"input", "output", "options", "limits"});
  const CLI::App& command = *command_called(app, tool.command);
  std::vector<std::string> line{tool.command};
  const std::vector<std::string> inputs = files_of(arguments, "input", tool.input != Tool::Input::kOne, folders);
  if (tool.input == Tool::Input::kTwo && inputs.size() != 2)
    throw BadCall{"bad_arguments", "input is two files: the mesh with the fields, and the mesh that they go to"};
  line.insert(line.end(), inputs.begin(), inputs.end());
  using Output = Tool::Output;
  if (tool.output == Output::kOne || tool.output == Output::kSeveral)
    for (const std::string& file : files_of(arguments, "output", tool.output == Output::kSeveral, folders))
      line.push_back("--output=" + file);
  const bool is_drawn = tool.output == Output::kPicture && !arguments.contains("output");
  if (tool.output == Output::kPicture)
    line.push_back("--output=" + (is_drawn ? "-" : file_of(arguments["output"], "output", folders)));
  if (std::string_view(tool.name) == "plan") line.push_back("--dry-run");
  if (arguments.contains("options")) {
    if (!arguments["options"].is_object()) throw BadCall{"bad_arguments", "options are an object"};
    for (const auto& [name, value] : arguments["options"].items()) add_option_words(command, name, value, line);
  }
  add_limits(arguments, limits, folders, plan, line);
  if (!is_drawn) line.push_back("--json=-");
  plan.lines.push_back(line);
  // What is in a surface is one thing, what is wrong with it another.
  if (std::string_view(tool.name) == "inspect") {
    std::vector<std::string> check{"check", inputs.front(), "--json=-"};
    add_limits(arguments, limits, folders, plan, check);
    plan.lines.push_back(check);
  }
  return plan;
}

namespace {

/// Cuts long lists; names those that were.
void cut_lists(Json& value, const std::string& path, Json& cut) {
  if (value.is_object())
    for (auto& [key, inner] : value.items()) cut_lists(inner, path.empty() ? key : path + "." + key, cut);
  if (!value.is_array()) return;
  if (value.size() > kListed && !value.front().is_number()) {
    cut.push_back(fmt::format("{}: {} of {}", path, kListed, value.size()));
    value.erase(value.begin() + static_cast<std::ptrdiff_t>(kListed), value.end());
  }
  for (Json& inner : value)
    if (inner.is_structured()) cut_lists(inner, path, cut);
}

Json call(const char* tool, const std::string& why, const Json& arguments = Json::object()) {
  Json made{{"tool", tool}, {"why", why}};
  if (!arguments.empty()) made["arguments"] = arguments;
  return made;
}

/// The same call with another option.
Json call_with(const Tool& tool, const Json& arguments, const char* option, const Json& value, const std::string& why) {
  Json changed = arguments;
  changed["options"][option] = value;
  return call(tool.name, why, changed);
}

Json next_calls(const Tool& tool, const Json& arguments, const Json& error, const Folders& folders) {
  const std::string kind = error.value("kind", ""), code = error.value("code", "");
  const Json input = arguments.is_object() && arguments.contains("input") ? arguments["input"] : Json();
  const Json first = input.is_array() && !input.empty() ? input.front() : input;
  Json next = Json::array();
  if (code == "outside_folders") {
    std::string where;
    for (const std::string& folder : folders.all()) where += (where.empty() ? "" : ", ") + folder;
    next.push_back(call(tool.name, "with files in " + where));
  } else if (kind == "usage") {
    if (code == "unknown_option") next.push_back(call("explain", "what options mean", {{"option", "size"}}));
    next.push_back(call(tool.name, "with the arguments put right as the message says"));
  } else if (code == "max_elements" || kind == "memory") {
    next.push_back(call("plan", "how many elements which sizes come to", {{"input", input}}));
    next.push_back(call_with(tool, arguments, "preset", "draft", "about a quarter of the elements"));
  } else if (kind == "limit") {
    next.push_back(call_with(tool, arguments, "preset", "draft", "fewer elements, made faster"));
    next.push_back(call("plan", "how long it takes", {{"input", input}}));
  } else if (kind == "requirement" || kind == "meshing") {
    next.push_back(call_with(tool, arguments, "improve", "best", "the best improvement"));
    next.push_back(call("explain", "what went wrong, with places"));
  } else if (kind == "input" && first.is_string()) {
    const bool was_inspected = std::string_view(tool.name) == "inspect";
    next.push_back(was_inspected ? call("inspect", "another file, or this one put right as the message says")
                                 : call("inspect", "what is in the file", {{"input", first}}));
    if (std::string_view(tool.command) == "mesh") {
      next.push_back(call("explain", "what is wrong with it, where, and what to do", {{"file", first}}));
      next.push_back(call_with(tool, arguments, "repair", "wrap", "a closed skin around what bounds nothing"));
    }
  } else if (kind == "output") {
    next.push_back(call(tool.name, "with another output"));
  }
  return next;
}

/// Which sources of size asked for the elements, largest share first.
Json sources_in(const Json& report) {
  std::vector<std::pair<double, std::string>> shares;
  const Json stages = report.value("stages", Json::array());
  for (const Json& stage : stages) {
    const Json counters = stage.value("counters", Json::object());
    for (const auto& [key, value] : counters.items())
      if (const std::size_t end = key.find(", % of the elements");
          key.starts_with("made for ") && end != std::string::npos)
        shares.emplace_back(value.get<double>(), key.substr(9, end - 9));
  }
  std::ranges::stable_sort(shares, [](const auto& a, const auto& b) { return a.first > b.first; });
  Json all = Json::array();
  for (const auto& [percent, source] : shares) all.push_back({{"source", source}, {"percent_of_elements", percent}});
  return all;
}

Json error_of(const RunResult& run) {
  if (run.report.is_object() && run.report.contains("error")) {
    Json error = run.report["error"];
    error.erase("status");
    return error;
  }
  std::string words = run.errors;
  if (words.starts_with("octafront: ")) words.erase(0, 11);
  while (words.ends_with('\n')) words.pop_back();
  switch (run.status) {
    case kUsage:
      return {{"kind", "usage"}, {"code", "usage"}, {"message", words}};
    case kInputRefused:
      return {{"kind", "input"}, {"code", "input"}, {"message", words}};
    case kNotWritten:
      return {{"kind", "output"}, {"code", "output"}, {"message", words}};
    case kOutOfMemory:
      return {{"kind", "memory"}, {"code", "memory"}, {"message", words}};
    case kLimitReached:
      return {{"kind", "limit"},
              {"code", words.find("folders") != std::string::npos ? "outside_folders" : "limit"},
              {"message", words}};
    case kInterrupted:
      return {{"kind", "interrupted"}, {"code", "interrupted"}, {"message", "interrupted"}};
    default:
      return {{"kind", "internal"},
              {"code", "internal"},
              {"message", words.empty() ? fmt::format("it ended with status {}", run.status) : words}};
  }
}

/// What to do about defects of a surface, and poor elements.
Json advice_on(const Json& report) {
  Json advice = Json::array();
  if (report.contains("defects") && report["defects"].is_object())
    for (const auto& [kind, found] : report["defects"].items())
      if (found.is_object() && found.value("count", 0) > 0)
        advice.push_back(
            fmt::format("{} {}: mesh mends them by itself (options {{\"repair\": \"auto\"}}); where that is refused, "
                        "{{\"repair\": \"wrap\"}} makes a closed skin",
                        found.value("count", 0), kind));
  if (report.contains("quality") && report["quality"].is_object()) {
    const double beta = report["quality"].value("beta_min", 1.0);
    if (beta < 0.2)
      advice.push_back(
          "the worst elements are poor: improve, or mesh with a smaller size there (options {\"size-near\": "
          "\"X,Y,Z=H:DISTANCE\"}); "
          "where the body itself has a sharp wedge or a tiny face no mesh is better");
    else
      advice.push_back("no element is poor: beta is at least .2");
  }
  if (report.contains("valid") && report["valid"].is_boolean() && !report["valid"].get<bool>())
    advice.push_back("the mesh is not valid: mesh the surface anew");
  return advice;
}

}  // namespace

Json answer_of(const Tool& tool, const Json& arguments, const std::vector<RunResult>& runs, const Folders& folders) {
  Json answer{{"status", runs.front().status}}, cut = Json::array();
  const bool is_explained = std::string_view(tool.name) == "explain",
             is_inspected = std::string_view(tool.name) == "inspect";
  for (const RunResult& run : runs) {
    if (!run.report.is_object()) continue;
    if (!answer.contains("command_line")) answer["command_line"] = run.report.value("command_line", "");
    for (const std::string& key : words_in(tool.keys))
      if (run.report.contains(key) && !answer.contains(key)) answer[key] = run.report[key];
  }
  if (std::string_view(tool.name) == "plan" && runs.front().report.is_object())
    answer["sources"] = sources_in(runs.front().report);
  if (is_explained) {
    answer["status"] = 0,
    answer["text"] = runs.front().status == 0 ? "nothing is wrong with it" : error_of(runs.front())["message"];
    answer["advice"] = advice_on(runs.front().report.is_object() ? runs.front().report : Json::object());
  }
  // What is wrong with a surface is what was asked for; it is no failure.
  const auto failed = std::ranges::find_if(runs, [](const RunResult& run) { return run.status != 0; });
  if (failed != runs.end() && !is_explained && !(is_inspected && failed != runs.begin())) {
    answer["status"] = failed->status, answer["error"] = error_of(*failed);
    answer["next"] = next_calls(tool, arguments, answer["error"], folders);
  }
  cut_lists(answer, "", cut);
  if (!cut.empty()) answer["cut"] = cut;
  return answer;
}

Json answer_of(const BadCall& refused, const Tool& tool, const Json& arguments, const Folders& folders) {
  Json answer{{"status", static_cast<int>(refused.code == "outside_folders" ? kLimitReached : kUsage)}};
  answer["error"] = {{"kind", refused.code == "outside_folders" ? "limit" : "usage"},
                     {"code", refused.code},
                     {"message", refused.message}};
  answer["next"] = next_calls(tool, arguments, answer["error"], folders);
  return answer;
}

std::string in_a_sentence(const Tool& tool, const Json& answer) {
  if (answer.contains("error")) {
    std::string text = fmt::format("{} failed ({}): {}", tool.name, answer["error"].value("code", ""),
                                   answer["error"].value("message", ""));
    if (answer.contains("next") && !answer["next"].empty())
      text += fmt::format("\nNext: {} ({})", answer["next"][0].value("tool", ""), answer["next"][0].value("why", ""));
    return text;
  }
  return answer.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json explained(const Json& arguments, const Json& last, const CLI::App& app) {
  if (!arguments.contains("option")) {
    if (last.is_null()) return {{"status", 0}, {"text", "no call has failed yet"}};
    Json answer{{"status", 0},
                {"text", last["error"].value("message", "")},
                {"advice", advice_on(last)},
                {"next", last.value("next", Json::array())}};
    if (last.contains("defects")) answer["defects"] = last["defects"];
    return answer;
  }
  if (!arguments["option"].is_string()) throw BadCall{"bad_arguments", "option is a name"};
  std::string name = arguments["option"];
  name.erase(0, name.find_first_not_of('-') == std::string::npos ? name.size() : name.find_first_not_of('-'));
  const Tool* tool = tool_called(arguments.contains("command") && arguments["command"].is_string()
                                     ? arguments["command"].get<std::string>()
                                     : "mesh");
  if (tool == nullptr || std::string_view(tool->command).empty())
    throw BadCall{"bad_arguments", "command is the name of a tool that takes options"};
  std::vector<std::string> names;
  for (const CLI::Option* option : options_for_calls(*command_called(app, tool->command))) {
    names.push_back(option->get_lnames().front());
    if (std::ranges::find(option->get_lnames(), name) != option->get_lnames().end())
      return {{"status", 0},
              {"text", fmt::format("{}{}: {}", name, is_flag(*option) ? "" : " " + option->get_type_name(),
                                   option->get_description())}};
  }
  const std::string nearest = nearest_word(name, names);
  throw BadCall{"unknown_option", fmt::format("{} has no option {}{}", tool->name, name,
                                              nearest.empty() ? "" : "; did you mean " + nearest + "?")};
}

}  // namespace octafront::cli
