#include "job_options.h"

#include <octafront/error.h>
#include <octafront/solver_job.h>

#include "session.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront::cli {
namespace {

constexpr std::string_view kJobWriters = "mesh improve adapt convert", kJobGroup = "Jobs";

/// add(job, typed). What places are like is known of CAD alone, and becomes groups of them.
template <class Change>
Add job_option(const Change& change) {
  return each([change](Arguments& a, const std::string& typed) {
    if (!a.writing.job) a.writing.job.emplace();
    change(*a.writing.job, typed);
    for (const std::string& place : places_by_shape(*a.writing.job))
      if (std::ranges::find(a.options.groups, place + "=" + place) == a.options.groups.end())
        a.options.groups.push_back(place + "=" + place);
  });
}

/// It is read with the line, and what cannot be read is a wrong use of the option.
void add_file(SolverJob& job, const std::string& file, const std::string& key = {}) {
  try {
    add_file_to_job(job, file, key);
  } catch (const InputError& error) {
    throw OptionError(error.what());
  }
}

/// A number, several with commas between, or words.
Json value_of_typed(const std::string& typed) {
  Json numbers = Json::array();
  for (const std::string& word : CLI::detail::split(typed, ',')) {
    double number = 0;
    if (!CLI::detail::lexical_cast(CLI::detail::trim_copy(word), number)) return typed;
    numbers.push_back(number);
  }
  return numbers.size() == 1 ? numbers[0] : numbers;
}

/// PLACE=VALUE as an entry of this key; of a place alone, or a value alone, what else stands there.
Add entry(const char* key, const char* place_alone = nullptr, const char* value_alone = nullptr) {
  return job_option([=](SolverJob& job, const std::string& typed) {
    const std::size_t equals = typed.rfind('=');
    std::string place = typed.substr(0, equals), value = equals == typed.npos ? "" : typed.substr(equals + 1);
    if (equals == typed.npos && value_alone != nullptr) value = value_alone;
    if (equals == typed.npos && place_alone != nullptr) value = std::exchange(place, place_alone);
    if (place.empty() || value.empty()) throw OptionError(fmt::format("\"{}\" has no place or no value", typed));
    add_to_job(job, Json{{key, {{place, value_of_typed(value)}}}}.dump(), typed);
  });
}

}  // namespace

std::vector<LineOption> job_options() {
  return {
      {kJobWriters, kJobGroup, "--job", "FILE.json",
       "All that follows in a file, and what is seldom wanted: gravity, points at a place of their own",
       job_option([](SolverJob& job, const std::string& file) { add_file(job, file); })},
      {kJobWriters, kJobGroup, "--materials", "FILE.json",
       "What parts are made of: {\"default\": {\"name\": \"steel\", \"E\": 210000, \"nu\": .3, \"density\": 7.85e-9}, "
       "\"PART\": ...} [steel in N, mm and t, which is said]",
       job_option([](SolverJob& job, const std::string& file) { add_file(job, file, "materials"); })},
      {kJobWriters, kJobGroup, "--fix", "PLACE[=xyz]",
       "What is held: in all directions, or in those of \"xyz\" (of a reference point also \"r\", its rotations), or "
       "of \"radial tangential axial\" of a cylinder",
       entry("fix", nullptr, "all")},
      {kJobWriters, kJobGroup, "--load", "PLACE=FX,FY,FZ", "A force, spread evenly over faces, or at a reference point",
       entry("load")},
      {kJobWriters, kJobGroup, "--pressure", "PLACE=P", "A pressure on faces; below 0 they are pulled",
       entry("pressure")},
      {kJobWriters, kJobGroup, "--couple", "NAME=PLACE",
       "A reference point of this name, in the middle of faces that follow it", entry("couple")},
      {kJobWriters, kJobGroup, "--friction", "[A|B=]MU",
       "What --split opened slides with this coefficient of friction, and lifts off, instead of being tied; all, or "
       "that of two parts; A|B=tie: that one is tied",
       entry("friction", "default")},
      {kJobWriters, kJobGroup, "--pretension", "PART=F",
       "The force by which a bolt is drawn together, in a section across its shank, before loads come",
       entry("pretension")},
  };
}

}  // namespace octafront::cli
