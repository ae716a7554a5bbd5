#include <octafront/error.h>
#include <octafront/solver_job.h>

#include "base/places/places.h"

#include <algorithm>
#include <string_view>

#include <fmt/core.h>

namespace octafront {
namespace {

using Names = std::vector<NamesOfKind>;

bool is_among(const std::string& name, const Names& there) {
  return std::ranges::any_of(there, [&](const NamesOfKind& kind) { return !named_so(kind.names, name).empty(); });
}

/// Whether patches may meet in a curve of this name: "A|B", "A + A|B + B", "A end".
bool may_be_curve(const std::string& name, const Names& patches) {
  constexpr std::string_view kEnd = " end";
  if (name.ends_with(kEnd)) return is_among(name.substr(0, name.size() - kEnd.size()), patches);
  const std::string_view between = name.find(" + ") == name.npos ? "|" : " + ";
  const std::size_t at = name.find(between);
  return at != name.npos && is_among(name.substr(0, at), patches);
}

class JobCheck {
 public:
  JobCheck(const SolverJob& job, const PlaceNames& there) : job_(job), there_(there) {
    for (const JobCoupling& c : job.couplings) points_.push_back(c.name);
  }

  void check() const {
    for (const JobPart& part : job_.parts)
      if (!part.place.empty()) check("materials", part.place, parts());
    for (const JobFix& fix : job_.fixes) check_fix(fix.place);
    for (const JobLoad& load : job_.loads) check("load", load.place, faces(true));
    for (const JobPressure& pressure : job_.pressures) check("pressure", pressure.place, faces(false));
    for (const JobCoupling& c : job_.couplings) check("couple", c.place, faces(false));
    for (const JobPretension& bolt : job_.pretensions) check("pretension", bolt.region, parts());
    for (const JobContact& contact : job_.contacts)
      if (!contact.place.empty()) check_contact(contact.place);
  }

 private:
  Names parts() const { return {{"region", there_.regions}, {"set", there_.sets}}; }
  Names faces(bool with_points) const {
    Names names{{"patch", there_.patches}, {"set", there_.sets}};
    if (with_points && !points_.empty()) names.push_back({"reference point", points_});
    return names;
  }

  static void check(std::string_view option, const std::string& text, const Names& there) {
    const Place place = place_of(option, text);
    const auto* list = std::get_if<std::vector<std::string>>(&place.where);
    for (const std::string& name : list != nullptr ? *list : std::vector{text})
      if (!place.is_in_space() && !is_made_later(name) && !is_among(without_sides(name), there))
        throw OptionError(fmt::format("`{}`: {}", option, no_such_place(name, there)));
  }
  void check_fix(const std::string& place) const {
    Names there = faces(true);
    there.insert(there.begin(), {"region", there_.regions});
    there.push_back({"curve", there_.curves});
    if (!may_be_curve(place, {{"patch", there_.patches}})) check("fix", place, there);
  }
  void check_contact(const std::string& name) const {
    const Names there{{"opened contact", there_.contacts}};
    if (!is_made_later(name) && !is_among(name, there))
      throw OptionError(fmt::format("`friction`: {}; open contacts by `contacts` split", no_such_place(name, there)));
  }

  const SolverJob& job_;
  const PlaceNames& there_;
  std::vector<std::string> points_;
};

}  // namespace

void check_job(const SolverJob& job, const PlaceNames& there) {
  JobCheck(job, there).check();
}

}  // namespace octafront
