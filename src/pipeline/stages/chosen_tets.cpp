#include "pipeline/stages/chosen_tets.h"

#include <octafront/error.h>
#include <octafront/vec.h>

#include "base/core/doubles.h"
#include "base/geometry/measures.h"
#include "pipeline/stages/named_items.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/core.h>

namespace octafront {
namespace {

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
      refuse_name(mesh_, "only", place, "no box:X0,Y0,Z0,X1,Y1,Z1 or sphere:X,Y,Z,R, and ");
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
    const auto items = items_called(mesh_, name);
    if (!items) return false;
    for (const std::uint32_t t : items->tets) chosen_[t] = 1, ++added_;
    std::vector<std::uint8_t> touched(mesh_.points.size(), 0);
    const auto touch = [&](const auto& item) {
      for (const VertexIndex v : item) touched[v] = 1;
    };
    const std::size_t outer = mesh_.boundary.size();
    for (const std::uint32_t v : items->nodes) touched[v] = 1;
    for (const std::uint32_t e : items->edges) touch(mesh_.curve_edges[e]);
    for (const std::uint32_t f : items->faces) touch(f < outer ? mesh_.boundary[f] : mesh_.interfaces[f - outer]);
    add_where([&](TetIndex t) {
      return std::any_of(mesh_.tets[t].begin(), mesh_.tets[t].end(), [&](VertexIndex v) { return touched[v] != 0; });
    });
    return true;
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
