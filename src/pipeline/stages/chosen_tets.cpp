#include "pipeline/stages/chosen_tets.h"

#include <octafront/error.h>
#include <octafront/vec.h>

#include "base/core/doubles.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include <fmt/core.h>

namespace octafront {
namespace {

/// Names that a message lists at most.
constexpr std::size_t kMostNamesListed = 12;

std::vector<std::string> split_at(std::string_view text, char separator) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (c == separator)
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

/// The numbers of "box:1,2,..." behind its colon.
std::vector<double> numbers_of_place(const std::string& place, std::size_t count) {
  const std::string_view text = std::string_view(place).substr(place.find(':') + 1);
  std::vector<double> numbers;
  for (const std::string& word : split_at(text, ',')) {
    double value = 0;
    const auto [stop, error] = io::double_from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value)) break;
    numbers.push_back(value);
  }
  if (numbers.size() != count)
    throw OptionError(
        fmt::format("`only`: \"{}\" has not {} numbers with commas between; places are "
                    "box:X0,Y0,Z0,X1,Y1,Z1, sphere:X,Y,Z,R and names",
                    place, count));
  return numbers;
}

class TetChooser {
 public:
  explicit TetChooser(const TetMesh& mesh) : mesh_(mesh), chosen_(mesh.tets.size(), 0) {}

  void add(const std::string& place) {
    const auto before = count();
    added_ = 0;
    if (place.starts_with("box:"))
      add_box(place);
    else if (place.starts_with("sphere:"))
      add_sphere(place);
    else if (!add_named(place))
      refuse(place);
    if (added_ == 0 && count() == before) throw OptionError(fmt::format("`only`: no element is in \"{}\"", place));
  }
  std::vector<std::uint8_t> chosen() && { return std::move(chosen_); }

 private:
  std::size_t count() const { return static_cast<std::size_t>(std::count(chosen_.begin(), chosen_.end(), 1)); }

  template <class Wanted>
  void add_where(const Wanted& wanted) {
    for (TetIndex t = 0; t < chosen_.size(); ++t)
      if (wanted(t)) chosen_[t] = 1, ++added_;
  }
  Box3 box_of(TetIndex t) const {
    Box3 box;
    for (const VertexIndex v : mesh_.tets[t]) box.add(mesh_.points[v]);
    return box;
  }

  void add_box(const std::string& place) {
    const std::vector<double> n = numbers_of_place(place, 6);
    Box3 wanted;
    wanted.add(Vec3{n[0], n[1], n[2]}), wanted.add(Vec3{n[3], n[4], n[5]});
    add_where([&](TetIndex t) { return box_of(t).overlaps(wanted); });
  }
  void add_sphere(const std::string& place) {
    const std::vector<double> n = numbers_of_place(place, 4);
    if (!(n[3] > 0)) throw OptionError(fmt::format("`only`: \"{}\" has a radius that is not above 0", place));
    add_where([&](TetIndex t) {
      double sum = 0;
      const Box3 box = box_of(t);
      for (int i = 0; i < 3; ++i) {
        const double away =
            std::max({box.lo[i] - n[static_cast<std::size_t>(i)], n[static_cast<std::size_t>(i)] - box.hi[i], 0.0});
        sum += away * away;
      }
      return sum <= n[3] * n[3];
    });
  }

  /// False if nothing is called so.
  bool add_named(const std::string& name) {
    bool found = false;
    const auto number_of = [&](const std::vector<std::string>& names) {
      const auto at = std::find(names.begin(), names.end(), name);
      found |= at != names.end();
      return at == names.end() ? kNone : static_cast<std::uint32_t>(at - names.begin());
    };
    if (const std::uint32_t r = number_of(mesh_.region_names); r != kNone)
      add_where([&](TetIndex t) { return (mesh_.region.empty() ? 0 : mesh_.region[t]) == r; });
    std::vector<std::uint8_t> touched(mesh_.points.size(), 0);
    const auto touch = [&](const auto& item) {
      for (const VertexIndex v : item) touched[v] = 1;
    };
    if (const std::uint32_t p = number_of(mesh_.patch_names); p != kNone) {
      for (std::size_t f = 0; f < mesh_.boundary.size(); ++f)
        if ((mesh_.patch.empty() ? 0 : mesh_.patch[f]) == p) touch(mesh_.boundary[f]);
      for (std::size_t f = 0; f < mesh_.interfaces.size(); ++f)
        if ((mesh_.interface_patch.empty() ? 0 : mesh_.interface_patch[f]) == p) touch(mesh_.interfaces[f]);
    }
    if (const std::uint32_t c = number_of(mesh_.curve_names); c != kNone)
      for (std::size_t e = 0; e < mesh_.curve_edges.size(); ++e)
        if ((mesh_.curve.empty() ? 0 : mesh_.curve[e]) == c) touch(mesh_.curve_edges[e]);
    for (const NamedSet& set : mesh_.sets)
      if (set.name == name) found = true, add_set(set, touched, touch);
    add_where([&](TetIndex t) {
      return std::any_of(mesh_.tets[t].begin(), mesh_.tets[t].end(), [&](VertexIndex v) { return touched[v] != 0; });
    });
    return found;
  }
  template <class Touch>
  void add_set(const NamedSet& set, std::vector<std::uint8_t>& touched, const Touch& touch) {
    const std::size_t outer = mesh_.boundary.size();
    for (const std::uint32_t m : set.members) switch (set.kind) {
        case NamedSet::Kind::kNodes:
          touched[m] = 1;
          break;
        case NamedSet::Kind::kEdges:
          touch(mesh_.curve_edges[m]);
          break;
        case NamedSet::Kind::kFaces:
          touch(m < outer ? mesh_.boundary[m] : mesh_.interfaces[m - outer]);
          break;
        case NamedSet::Kind::kElements:
          chosen_[m] = 1, ++added_;
      }
  }

  [[noreturn]] void refuse(const std::string& place) const {
    std::set<std::string> names;
    for (const auto* list : {&mesh_.region_names, &mesh_.patch_names, &mesh_.curve_names})
      names.insert(list->begin(), list->end());
    for (const NamedSet& set : mesh_.sets) names.insert(set.name);
    names.erase("");
    std::string list;
    std::size_t listed = 0;
    for (const std::string& name : names) {
      if (listed++ == kMostNamesListed) break;
      list += (list.empty() ? "" : ", ") + name;
    }
    if (names.size() > kMostNamesListed) list += ", ...";
    throw OptionError(
        fmt::format("`only`: \"{}\" is no box:X0,Y0,Z0,X1,Y1,Z1 or sphere:X,Y,Z,R, and the mesh has no "
                    "region, patch, curve or set of that name; it has {}",
                    place, list.empty() ? "no names" : list));
  }

  const TetMesh& mesh_;
  std::vector<std::uint8_t> chosen_;
  std::size_t added_ = 0;
};

}  // namespace

std::vector<std::uint8_t> chosen_tets(const TetMesh& mesh, const std::string& places) {
  TetChooser chooser(mesh);
  for (const std::string& place : split_at(places, ';'))
    if (!place.empty()) chooser.add(place);
  return std::move(chooser).chosen();
}

}  // namespace octafront
