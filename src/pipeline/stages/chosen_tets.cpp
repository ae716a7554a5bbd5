#include <octafront/error.h>
#include <octafront/vec.h>

#include "base/places/places.h"
#include "pipeline/stages/adapting.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {
namespace {

class TetChooser {
 public:
  explicit TetChooser(const TetMesh& mesh) : mesh_(mesh), chosen_(mesh.tets.size(), 0) {}

  void add(const Place& place) {
    const auto before = count();
    added_ = 0;
    if (const auto* box = std::get_if<Box3>(&place.where))
      add_box(*box);
    else if (const auto* ball = std::get_if<GroupRule::Sphere>(&place.where))
      add_ball(*ball);
    else
      add_named(items_at(mesh_, "only", place));
    if (added_ == 0 && count() == before) throw OptionError(fmt::format("`only`: no element is in \"{}\"", place.text));
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

  void add_box(const Box3& wanted) {
    add_where([&](TetIndex t) { return box_of(t).overlaps(wanted); });
  }
  void add_ball(const GroupRule::Sphere& ball) {
    add_where([&](TetIndex t) {
      double sum = 0;
      const Box3 box = box_of(t);
      for (int i = 0; i < 3; ++i) {
        const double away = std::max({box.lo[i] - ball.center[i], ball.center[i] - box.hi[i], 0.0});
        sum += away * away;
      }
      return sum <= ball.radius * ball.radius;
    });
  }

  void add_named(const MeshItems& items) {
    for (const std::uint32_t t : items.tets) chosen_[t] = 1, ++added_;
    std::vector<std::uint8_t> touched(mesh_.points.size(), 0);
    const auto touch = [&](const auto& item) {
      for (const VertexIndex v : item) touched[v] = 1;
    };
    const std::size_t outer = mesh_.boundary.size();
    for (const std::uint32_t v : items.nodes) touched[v] = 1;
    for (const std::uint32_t e : items.edges) touch(mesh_.curve_edges[e]);
    for (const std::uint32_t f : items.faces) touch(f < outer ? mesh_.boundary[f] : mesh_.interfaces[f - outer]);
    add_where([&](TetIndex t) {
      return std::any_of(mesh_.tets[t].begin(), mesh_.tets[t].end(), [&](VertexIndex v) { return touched[v] != 0; });
    });
  }

  const TetMesh& mesh_;
  std::vector<std::uint8_t> chosen_;
  std::size_t added_ = 0;
};

}  // namespace

std::vector<std::uint8_t> chosen_tets(const TetMesh& mesh, const std::string& places) {
  TetChooser chooser(mesh);
  for (const Place& place : places_listed("only", places, ';', {})) chooser.add(place);
  return std::move(chooser).chosen();
}

}  // namespace octafront
