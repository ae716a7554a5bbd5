#include "session.h"

#include <octafront/error.h>
#include <octafront/formula.h>
#include <octafront/io.h>
#include <octafront/ranks.h>

#include "domain.h"
#include "open_cavity.h"
#include "terminal.h"
#include "text.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// A file and the option, or other words, by which the user named it.
struct NamedFile {
  std::string name;
  std::filesystem::path path;
};

std::vector<NamedFile> without_unused(std::vector<NamedFile> files) {
  std::erase_if(files, [](const NamedFile& f) { return f.path.empty() || f.path == kStandardOutput; });
  return files;
}

std::vector<NamedFile> inputs_of(const Arguments& a) {
  std::vector<NamedFile> files{{"the input", a.input},
                               {"--surface", a.surface},
                               {"--regions", a.regions},
                               {"--point-sizes", a.point_sizes},
                               {"--size-field", a.size_field}};
  for (std::size_t i = 1; i < a.bodies.size(); ++i) files.push_back({"an input", a.bodies[i]});
  return without_unused(std::move(files));
}

std::vector<NamedFile> outputs_of(const Arguments& a) {
  std::vector<NamedFile> all{{"--output", a.output}, {"--json", a.json}, {"--report", a.page}, {"--map", a.map_file}};
  for (const std::filesystem::path& mesh : a.meshes) all.push_back({"--output", mesh});
  if (const std::filesystem::path beside = cavity_neighbour(a); !beside.empty()) {
    all.push_back({"the file for a cavity that stays open", cavity_file(beside)});
    all.push_back({"the file for a leak", leak_file(beside)});
  }
  return without_unused(std::move(all));
}

/// Throws InputError for a file that is not there, with the one beside it that may have been meant; formulas are none.
void require_there(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() != std::filesystem::file_type::not_found || is_formula(file.string())) return;
  std::vector<std::string> names;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  constexpr std::size_t kMostNames = 10000;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (names.size() < kMostNames) names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::string nearest = nearest_word(file.filename().string(), names);
  throw InputError(fmt::format("{}: there is no such file{}", file.string(),
                               nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest)));
}

/// What is written to standard output, but for the table.
int uses_of_standard_output(const Arguments& a) {
  return (a.json == kStandardOutput) + (a.output == kStandardOutput) + (a.page == kStandardOutput) +
         static_cast<int>(std::count(a.meshes.begin(), a.meshes.end(), kStandardOutput));
}

}  // namespace

Session::Session(const Arguments& arguments, Ranks* ranks)
    : arguments_(arguments), context_(terminal_context(arguments.threads, arguments.quiet)) {
  context_.ranks = ranks;
}

std::string Session::shown(const std::string& text) const {
  return printable(arguments_.names.translated(text), arguments_.words_with_line_ends);
}

bool Session::is_first() const {
  return context_.ranks == nullptr || context_.ranks->rank() == 0;
}

void Session::say(const std::string& text) const {
  clear_progress();
  if (arguments_.quiet || uses_of_standard_output(arguments_) > 0) return;
  std::fputs(shown(text).c_str(), stdout);
  std::fflush(stdout);
}

void Session::say_exactly(const std::string& text) const {
  std::fputs(text.c_str(), stdout);
}

void Session::say_notes(const std::string& stage, const std::vector<std::string>& notes) const {
  for (const std::string& note : notes) say(fmt::format("note ({}): {}\n", stage, note));
}

void Session::warn(const std::string& stage, const std::vector<std::string>& notes) const {
  if (!arguments_.quiet && uses_of_standard_output(arguments_) == 0) return say_notes(stage, notes);
  clear_progress();
  for (const std::string& note : notes) fmt::print(stderr, "octafront: warning ({}): {}\n", stage, shown(note));
}

void Session::tell(const Report& report) {
  say(to_table(report));
  found(Json::parse(arguments_.names.translated(to_json(report))));
}

Json Session::json(const Json& error) const {
  Json options = Json::object();
  for (const auto& [option, value] : arguments_.given) options[option] = value;
  Json all = json_head(arguments_.command, arguments_.command_line);
  all["status"] = error.is_null() ? Json(0) : error["status"];
  all["input"] = arguments_.input.string();
  all["options"] = options;
  if (arguments_.bodies.size() > 1)
    for (const std::filesystem::path& body : arguments_.bodies) all["inputs"].push_back(body.string());
  if (!error.is_null()) all["error"] = error;
  all.update(findings_);
  return all;
}

void Session::write_json(const Json& error) const {
  if (!arguments_.json.empty()) write_json_to(arguments_.json, json(error));
}

Json json_head(const std::string& command, const std::string& command_line) {
  return {
      {"program", "octafront"}, {"version", OCTAFRONT_VERSION}, {"command", command}, {"command_line", command_line}};
}

Json json_of(const Failure& failure) {
  return {{"status", static_cast<int>(failure.status)},
          {"kind", failure.kind},
          {"code", failure.code},
          {"message", failure.message}};
}

void write_json_to(const std::filesystem::path& target, const Json& json) {
  // Names of files may hold bytes that no text has.
  const std::string text = printable_json(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
  if (target != kStandardOutput) return write_text(target.string(), text);
  clear_progress();
  std::fputs(text.c_str(), stdout);
}

std::filesystem::path cavity_neighbour(const Arguments& a) {
  for (const std::filesystem::path& mesh : a.meshes)
    if (mesh != kStandardOutput) return mesh;
  return a.output;
}

void check_files(const Arguments& a) {
  for (const std::filesystem::path& body : a.bodies) require_there(body);
  if (uses_of_standard_output(a) > 1)
    throw OptionError("only one of the outputs can go to standard output; give files for the others");
  const std::vector<NamedFile> inputs = inputs_of(a), outputs = outputs_of(a);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto refuse_same = [&](const NamedFile& other) {
      if (same_file(outputs[i].path.string(), other.path.string()))
        throw OptionError(fmt::format("{}: {} and {} are the same file: it would be overwritten; give another name",
                                      outputs[i].path.string(), outputs[i].name, other.name));
    };
    for (const NamedFile& input : inputs) refuse_same(input);
    for (std::size_t k = 0; k < i; ++k) refuse_same(outputs[k]);
  }
  for (const std::filesystem::path& text : {a.json, a.page})
    if (!text.empty() && text != kStandardOutput) check_text_target(text.string());
}

}  // namespace octafront::cli
