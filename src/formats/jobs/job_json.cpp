// A job as JSON: objects by place, so that each place is said once.

#include <octafront/error.h>
#include <octafront/solver_job.h>

#include "base/places/shape_place.h"
#include "formats/containers/input.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include <fmt/core.h>

namespace octafront {
namespace {

using JobJson = nlohmann::ordered_json;

/// A value of the file, and how messages call it: `job`: "load", "wall".
class JobItem {
 public:
  JobItem(const JobJson& json, std::string path) : json_(json), path_(std::move(path)) {}

  [[noreturn]] void fail(std::string_view why) const { throw OptionError(fmt::format("{} {}", path_, why)); }
  const JobJson& json() const { return json_; }
  bool is_text() const { return json_.is_string(); }

  /// visit(key, item) for each entry of an object.
  template <class Visit>
  void for_each(const Visit& visit) const {
    if (!json_.is_object()) fail("is no object {...}");
    for (const auto& [key, value] : json_.items()) visit(key, JobItem(value, fmt::format("{}: \"{}\"", path_, key)));
  }
  double number() const {
    if (!json_.is_number() || !std::isfinite(json_.get<double>()))
      fail(fmt::format("needs a number, not {}", json_.dump()));
    return json_.get<double>();
  }
  std::string text() const {
    if (!json_.is_string()) fail(fmt::format("needs words in quotes, not {}", json_.dump()));
    return json_.get<std::string>();
  }
  Vec3 vector() const {
    if (!json_.is_array() || json_.size() != 3)
      fail(fmt::format("needs three numbers [x, y, z], not {}", json_.dump()));
    const auto at = [&](std::size_t i) { return JobItem(json_[i], path_).number(); };
    return {at(0), at(1), at(2)};
  }
  /// Takes what is under each key; keys that are none of these are refused.
  using Take = std::pair<std::string_view, std::function<void(const JobItem&)>>;
  void take(std::initializer_list<Take> known) const {
    for_each([&](const std::string& key, const JobItem& value) {
      for (const Take& t : known)
        if (t.first == key) return t.second(value);
      std::string list;
      for (const Take& t : known) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", t.first);
      fail(fmt::format("has \"{}\", which is none of {}", key, list));
    });
  }

 private:
  JobJson json_;
  std::string path_;
};

bool has_material(const SolverJob& job, const std::string& name) {
  return std::ranges::any_of(job.materials, [&](const JobMaterial& m) { return m.name == name; });
}

void take_material(const JobItem& item, JobMaterial& m) {
  m.young = 0;
  item.take({{"name", [&](const JobItem& i) { m.name = i.text(); }},
             {"E", [&](const JobItem& i) { m.young = i.number(); }},
             {"nu", [&](const JobItem& i) { m.poisson = i.number(); }},
             {"density", [&](const JobItem& i) { m.density = i.number(); }}});
  if (!(m.young > 0)) item.fail("needs \"E\", Young's modulus, above 0");
  if (!(m.poisson > -1 && m.poisson < 0.5)) item.fail("has a \"nu\" that is not above -1 and below .5");
  if (m.density && !(*m.density > 0)) item.fail("has a \"density\" that is not above 0");
}

void take_materials(const JobItem& item, SolverJob& job) {
  std::vector<JobItem> by_name;
  item.for_each([&](const std::string& place, const JobItem& value) {
    std::string name = value.is_text() ? value.text() : place;
    if (!value.is_text()) {
      JobMaterial m{.name = place};
      take_material(value, m);
      name = m.name;
      if (has_material(job, name))
        value.fail(fmt::format("is a second material \"{}\": name it alone where it is the same", name));
      job.materials.push_back(std::move(m));
    }
    job.parts.push_back({place == "default" ? "" : place, name});
  });
  for (const JobPart& part : job.parts)
    if (!has_material(job, part.material))
      item.fail(fmt::format("names \"{}\", which is no material of it", part.material));
}

JobFix fix_of(const JobItem& item, const std::string& place) {
  JobFix fix{place};
  const std::string text = item.text();
  for (const char* word : {"radial", "tangential", "axial"})
    if (text.find(word) != std::string::npos) fix.of_cylinder.emplace_back(word);
  if (!fix.of_cylinder.empty()) return fix;
  if (text != "all") fix.axes = text;
  if (fix.axes.find_first_not_of("xyzr") != std::string::npos || text.empty())
    item.fail(
        fmt::format("is \"{}\", and may be \"all\", of \"xyz\" (of a reference point also \"r\", its rotations), or "
                    "of \"radial tangential axial\" of a cylinder",
                    text));
  return fix;
}

JobContact contact_of(const JobItem& item, const std::string& place) {
  JobContact contact{place == "default" ? "" : place};
  if (item.is_text() && item.text() == "tie") return contact;
  if (item.is_text() || !(item.number() >= 0)) item.fail("is a coefficient of 0 or more, or \"tie\"");
  contact.friction = item.number();
  return contact;
}

JobCoupling coupling_of(const JobItem& item, const std::string& name) {
  JobCoupling c{.name = name, .place = {}};
  if (item.is_text()) {
    c.place = item.text();
    return c;
  }
  item.take({{"place", [&](const JobItem& i) { c.place = i.text(); }},
             {"at", [&](const JobItem& i) { c.at = i.vector(); }},
             {"kind", [&](const JobItem& i) {
                if (i.text() != "rigid" && i.text() != "distributing") i.fail("is \"rigid\" or \"distributing\"");
                c.is_rigid = i.text() == "rigid";
              }}});
  if (c.place.empty()) item.fail("needs a \"place\"");
  return c;
}

void take_job(const JobItem& item, SolverJob& job) {
  const auto each = [](auto add) { return [add](const JobItem& all) { all.for_each(add); }; };
  using Place = const std::string&;
  item.take({{"materials", [&](const JobItem& i) { take_materials(i, job); }},
             {"fix", each([&](Place place, const JobItem& v) { job.fixes.push_back(fix_of(v, place)); })},
             {"load", each([&](Place place, const JobItem& v) {
                job.loads.push_back({place, v.vector()});
              })},
             {"pressure", each([&](Place place, const JobItem& v) {
                job.pressures.push_back({place, v.number()});
              })},
             {"friction", each([&](Place place, const JobItem& v) { job.contacts.push_back(contact_of(v, place)); })},
             {"pretension", each([&](Place place, const JobItem& v) {
                job.pretensions.push_back({place, v.number()});
                if (!(job.pretensions.back().force > 0))
                  v.fail("is a force above 0, by which the bolt is drawn together");
              })},
             {"couple", each([&](Place name, const JobItem& v) { job.couplings.push_back(coupling_of(v, name)); })},
             {"gravity", [&](const JobItem& i) { job.gravity = i.vector(); }}});
}

JobJson parsed_job(const std::string& text, const std::string& name) {
  try {
    return JobJson::parse(text);
  } catch (const JobJson::exception& error) {
    throw OptionError(fmt::format("{} is no JSON: {}", name, error.what()));
  }
}

}  // namespace

void add_to_job(SolverJob& job, const std::string& text, const std::string& name) {
  take_job(JobItem(parsed_job(text, name), name), job);
}

void add_file_to_job(SolverJob& job, const std::string& file, const std::string& key) {
  const io::LoadedFile loaded(file);
  JobJson json = parsed_job(std::string(loaded.input().bytes), file);
  if (!key.empty()) json = JobJson{{key, std::move(json)}};
  take_job(JobItem(json, file), job);
}

std::vector<std::string> places_by_shape(const SolverJob& job) {
  std::vector<std::string> all;
  const auto add = [&](const auto& list) {
    for (const auto& item : list)
      if (shape_place_of(item.place) && std::ranges::find(all, item.place) == all.end()) all.push_back(item.place);
  };
  add(job.fixes), add(job.loads), add(job.pressures), add(job.couplings);
  return all;
}

}  // namespace octafront
