#include "session.h"

#include <octafront/error.h>
#include <octafront/io.h>

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

constexpr const char* kStandardOutput = "-";

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
  return without_unused({{"--output", a.output},
                         {"--json", a.json},
                         {"the file for a cavity that stays open", a.output.empty() ? "" : cavity_file(a.output)},
                         {"the file for a leak", a.output.empty() ? "" : leak_file(a.output)}});
}

}  // namespace

Session::Session(const Arguments& arguments)
    : arguments_(arguments), context_(terminal_context(arguments.threads, arguments.quiet)) {}

void Session::say(const std::string& text) const {
  clear_progress();
  if (arguments_.quiet || arguments_.json == kStandardOutput) return;
  std::fputs(printable(arguments_.names.translated(text)).c_str(), stdout);
  std::fflush(stdout);
}

void Session::say_notes(const std::string& stage, const std::vector<std::string>& notes) const {
  for (const std::string& note : notes) say(fmt::format("note ({}): {}\n", stage, note));
}

void Session::tell(const Report& report) {
  say(to_table(report));
  found(Json::parse(arguments_.names.translated(to_json(report))));
}

void Session::write_json(const Json& error) const {
  if (arguments_.json.empty()) return;
  Json options = Json::object();
  for (const auto& [option, value] : arguments_.given) options[option] = value;
  Json all{{"program", "octafront"},
           {"version", OCTAFRONT_VERSION},
           {"command", arguments_.command},
           {"input", arguments_.input.string()},
           {"options", options}};
  if (arguments_.bodies.size() > 1)
    for (const std::filesystem::path& body : arguments_.bodies) all["inputs"].push_back(body.string());
  if (!error.is_null()) all["error"] = error;
  all.update(findings_);
  // Names of files may hold bytes that no text has.
  const std::string text = all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  if (arguments_.json == kStandardOutput) {
    clear_progress();
    std::fputs(text.c_str(), stdout);
  } else {
    write_text(arguments_.json, text);
  }
}

void check_files(const Arguments& a) {
  if (a.output == kStandardOutput)
    throw OptionError("-o -: nothing but JSON can go to standard output; give a file, such as mesh.vtu");
  const std::vector<NamedFile> inputs = inputs_of(a), outputs = outputs_of(a);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto refuse_same = [&](const NamedFile& other) {
      if (same_file(outputs[i].path, other.path))
        throw OptionError(fmt::format("{}: {} and {} are the same file: it would be overwritten; give another name",
                                      outputs[i].path.string(), outputs[i].name, other.name));
    };
    for (const NamedFile& input : inputs) refuse_same(input);
    for (std::size_t k = 0; k < i; ++k) refuse_same(outputs[k]);
  }
  if (!a.json.empty() && a.json != kStandardOutput) check_text_target(a.json);
}

}  // namespace octafront::cli
