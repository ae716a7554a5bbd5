#include "compare.h"

#include <octafront/octafront.h>

#include "comparison.h"
#include "terminal.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include <fmt/format.h>

namespace octafront::cli {

namespace {

const std::map<std::string, Method> kMethods{
    {"octree-aft", Method::kOctreeAft}, {"aft", Method::kAft}, {"octree", Method::kOctree}};

std::string name_of(Method method) {
  for (const auto& [name, m] : kMethods)
    if (m == method) return name;
  return "recover";
}

Comparison run_one(const std::filesystem::path& input, const SurfaceFile& file, Method method, const Options& given,
                   const RunContext& context) {
  Comparison c;
  c.model = input.stem().string();
  c.method = name_of(method);
  c.faces = file.surface.triangles.size();
  c.elements_wanted = given.size.elements.value_or(0);
  Options options = given;
  options.method = method;
  try {
    c.report = generate(file.surface, options, context).report;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    c.failure = error.what();
  }
  return c;
}

}  // namespace

void declare_compare(CLI::App& command, CompareArguments& a) {
  command.add_option("inputs", a.inputs, "Closed surfaces: STL, OBJ, OFF or PLY")->required()->type_name("FILE");
  command.add_option("-o,--output", a.common.output, "Folder for the tables and charts; made if it is not there")
      ->required()
      ->type_name("DIR");
  command.add_option("--methods", a.methods, "octree-aft, aft, octree, by commas [all three]")
      ->delimiter(',')
      ->transform(CLI::CheckedTransformer(kMethods, CLI::ignore_case))
      ->type_name("LIST");
  auto* elements = command.add_option("--elements", a.elements, "Numbers of tetrahedra, by commas: one run for each")
                       ->delimiter(',')
                       ->type_name("LIST");
  command.add_option("--size", a.common.options.size.size, "Edge length, in units of the input")
      ->excludes(elements)
      ->type_name("H");
  declare_surface(command, a.common);
  declare_run(command, a.common);
}

int run_compare(const CompareArguments& a) {
  std::error_code error;
  std::filesystem::create_directories(a.common.output, error);
  if (error) throw OutputError(fmt::format("{}: {}", a.common.output.string(), error.message()));
  check_text_target(a.common.output / "compare.csv");
  const RunContext context = terminal_context(a.common.threads, a.common.quiet);
  std::vector<std::int64_t> counts = a.elements;
  if (counts.empty()) counts.push_back(0);
  std::vector<Comparison> all;
  for (const std::filesystem::path& input : a.inputs) {
    const SurfaceFile file = read_surface(input);
    for (const std::int64_t count : counts) {
      Options options = a.common.options;
      if (count != 0) options.size.elements = count;
      for (const Method method : a.methods) {
        all.push_back(run_one(input, file, method, options, context));
        clear_progress();
        if (!a.common.quiet) std::fputs((all.size() == 1 ? table_head() : "").c_str(), stdout);
        if (!a.common.quiet) std::fputs(table_row(all.back()).c_str(), stdout);
        std::fflush(stdout);
      }
    }
  }
  write_comparison(a.common.output, all);
  if (!a.common.quiet) std::fputs(summary_of(all, a.common.output).c_str(), stdout);
  const bool any = std::any_of(all.begin(), all.end(), [](const Comparison& c) { return c.failure.empty(); });
  if (!any) throw MeshingError("no method made a mesh; the first said: " + all.front().failure);
  return 0;
}

}  // namespace octafront::cli
