#include "compare.h"

#include <octafront/octafront.h>

#include "comparison.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

const Choice<Method> kMethods{{{"octree-aft", Method::kOctreeAft}, {"aft", Method::kAft}, {"octree", Method::kOctree}}};

Comparison run_one(const std::filesystem::path& input, const SurfaceFile& file, Method method, const Options& given,
                   const RunContext& context) {
  Comparison c;
  c.model = input.stem().string();
  c.method = kMethods.name_of(method);
  c.faces = file.surface.triangles.size();
  c.elements_wanted = given.size.elements.value_or(0);
  Options options = given;
  options.method = method;
  try {
    c.report = generate(file.surface, options, context).report;
  } catch (const Cancelled&) {
    throw;
  } catch (const LimitError&) {
    throw;
  } catch (const Error& error) {
    c.failure = error.what();
  }
  return c;
}

/// One for each number of elements asked for, all checked before the first run.
std::vector<Options> options_to_compare(const CompareArguments& a) {
  std::vector<Options> all;
  for (const std::int64_t count : a.elements) all.emplace_back(a.common.options).size.elements = count;
  if (all.empty()) all.push_back(a.common.options);
  for (const Options& options : all) check_options(options);
  return all;
}

/// No file that is compared may be one of those that the comparison writes.
void check_outputs(const CompareArguments& a) {
  for (const std::filesystem::path& output : comparison_files(a.common.output))
    for (const std::filesystem::path& input : a.inputs)
      if (same_file(input.string(), output.string()))
        throw OptionError(
            fmt::format("{}: an input that the comparison would overwrite; give another folder", input.string()));
  check_text_target(comparison_files(a.common.output).front().string());
}

}  // namespace

void declare_compare(CLI::App& command, CompareArguments& a) {
  command.add_option("inputs", a.inputs, "Closed surfaces: STL, OBJ, OFF or PLY")->required()->type_name("FILE");
  command.add_option("-o,--output", a.common.output, "Folder for the tables and charts; made if it is not there")
      ->required()
      ->type_name("DIR");
  const auto read_methods = [&a](const std::vector<std::string>& typed) {
    a.methods.clear();
    for (const std::string& name : typed) a.methods.push_back(kMethods.value_of("--methods", name));
  };
  command
      .add_option_function<std::vector<std::string>>("--methods", read_methods,
                                                     kMethods.listed(", ") + ", by commas [all three]")
      ->delimiter(',')
      ->type_name("LIST");
  const auto read_elements = [&a](const std::vector<double>& typed) {
    for (const double n : typed) a.elements.push_back(whole_number("--elements", n));
  };
  auto* elements = command
                       .add_option_function<std::vector<double>>("--elements", read_elements,
                                                                 "Numbers of tetrahedra, by commas: one run for each")
                       ->delimiter(',')
                       ->type_name("LIST");
  command.add_option("--size", a.common.options.size.size, "Edge length, in units of the input")
      ->excludes(elements)
      ->type_name("H");
  declare_surface(command, a.common);
  declare_run(command, a.common);
}

void run_compare(const CompareArguments& a, Session& session) {
  const std::vector<Options> runs = options_to_compare(a);
  std::error_code error;
  std::filesystem::create_directories(a.common.output, error);
  if (error) throw OutputError(fmt::format("{}: {}", a.common.output.string(), error.message()));
  check_outputs(a);
  std::vector<Comparison> all;
  for (const std::filesystem::path& input : a.inputs) {
    const SurfaceFile file = read_surface(input.string(), session.context());
    for (const Options& options : runs) {
      for (const Method method : a.methods) {
        all.push_back(run_one(input, file, method, options, session.context()));
        if (all.size() == 1) session.say(table_head());
        session.say(table_row(all.back()));
      }
    }
  }
  write_comparison(a.common.output, all);
  session.say(summary_of(all, a.common.output));
  const auto failed = [](const Comparison& c) { return !c.failure.empty(); };
  const auto first = std::find_if(all.begin(), all.end(), failed);
  if (first == all.end()) return;
  throw MeshingError(fmt::format("{} of {} runs made no mesh; the first, {} by {}, said: {}",
                                 std::count_if(all.begin(), all.end(), failed), all.size(), first->model, first->method,
                                 first->failure));
}

}  // namespace octafront::cli
