#include <octafront/error.h>
#include <octafront/validity.h>
#include <octafront/vec.h>

#include "adapt/metric/expected.h"
#include "adapt/schedule/rim_metric.h"
#include "adapt/schedule/section.h"
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

/// Per tet 1 if it is in one of the places, which have semicolons between them (AdaptOptions::only), else 0. Throws
/// OptionError for what is no place, for names that the mesh has not (with those that it has), and if a place holds no
/// element.
std::vector<std::uint8_t> chosen_tets(const TetMesh& mesh, const std::string& places) {
  TetChooser chooser(mesh);
  for (const Place& place : places_listed("only", places, ';', {})) chooser.add(place);
  return std::move(chooser).chosen();
}

std::size_t count_of(const std::vector<std::uint8_t>& marks) {
  return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1));
}

std::optional<std::string> defect_of(const TetMesh& part, const Stage& stage) {
  if (part.tets.empty()) return std::nullopt;
  return first_defect(adapt::closed_part(part, {}), stage.context());
}

void require_valid_section(const TetMesh& whole, const adapt::Section& section, const Stage& stage) {
  const auto defect = defect_of(adapt::closed_part(section.mesh, section.loose), stage);
  if (!defect) return;
  // The whole mesh has numbers that its owner knows.
  throw InputError("not a valid mesh: " + first_defect(whole, stage.context()).value_or(*defect));
}

/// Where the boundary crosses itself, among the triangles in the box of what was changed.
std::vector<TriangleCorners> crossings_near(const TetMesh& mesh, const std::vector<Vec3>& changed, const Stage& stage) {
  const Box3 box = bounding_box(changed);
  std::vector<Triangle> near;
  for (const Triangle& t : mesh.boundary) {
    Box3 own;
    for (const VertexIndex v : t) own.add(mesh.points[v]);
    if (own.overlaps(box)) near.push_back(t);
  }
  return crossing_triangles(mesh.points, near, stage);
}

struct Changed {
  adapt::Adapted part;
  TetMesh whole;
  adapt::SplicedIds ids;
};

Changed changed_by(const TetMesh& given, const adapt::Section& section, const adapt::MetricField& metric,
                   const adapt::AdaptRules& rules, const Stage& stage) {
  Changed made{adapt::adapt_mesh(section.mesh, metric, rules, stage), given, {}};
  made.ids = adapt::splice(made.whole, section, made.part.mesh, made.part.from);
  return made;
}

void tell_section(const TetMesh& given, std::size_t chosen, std::size_t may_change, const Changed& made,
                  const AdaptOptions& asked, const Stage& stage) {
  const auto same = std::count_if(made.ids.old_tet_of_new.begin(), made.ids.old_tet_of_new.end(),
                                  [](TetIndex t) { return t != kNone; });
  const auto gone = static_cast<std::int64_t>(given.tets.size()) - same;
  stage.count("elements chosen", static_cast<double>(chosen));
  stage.count("elements of the halo", static_cast<double>(may_change - chosen));
  stage.count("elements replaced", static_cast<double>(gone));
  std::string text =
      fmt::format("{} elements chosen, {} more in a halo of {} layers: {} were replaced, the other {} are as they were",
                  chosen, may_change - chosen, asked.halo, gone, same);
  if (made.ids.moved_vertices + made.ids.moved_tets != 0)
    text += fmt::format(
        "; the mesh has fewer vertices or elements than before, so {} vertices and {} elements outside, the last ones, "
        "got numbers that had become free",
        made.ids.moved_vertices, made.ids.moved_tets);
  stage.note(text);
}

}  // namespace

WallDeviation deviation_of(const adapt::Adapted& made) {
  const adapt::Deviation worst = adapt::worst_of(made.deviations);
  return {worst.bound, worst.lower, worst.upper, worst.place};
}

void adapt_section(const TetMesh& given, const adapt::MetricField& wanted, const adapt::AdaptRules& asked,
                   AdaptedMesh& result, Run& run) {
  run.stage("adapt", [&](const Stage& stage) {
    std::vector<std::uint8_t> chosen = chosen_tets(given, run.options.adapt.only);
    const std::size_t count = count_of(chosen);
    const adapt::Section section = adapt::section_of(given, chosen, run.options.adapt.halo);
    require_valid_section(given, section, stage);
    const TetMesh part = adapt::closed_part(section.mesh, section.loose);
    const adapt::RimMetric metric(section.mesh, section.frozen, wanted);
    require_budget(adapt::expected_tets(part, metric), stage);
    result.before = summary_of(adapt::fit_of(part, metric));
    adapt::AdaptRules rules = asked;
    rules.frozen = section.frozen;
    Changed made;
    const TryWalls attempt = [&](const adapt::MetricField& now, const adapt::AdaptRules& by) {
      made = changed_by(given, section, now, by, stage);
      return crossings_near(made.whole, made.part.mesh.points, stage);
    };
    keep_walls_apart(section.mesh, metric, rules, attempt, stage);
    if (const auto defect = defect_of(made.part.mesh, stage))
      throw MeshingError("the mesh made is not valid, which is a bug of ours; please report it with the input. " +
                         *defect);
    tell_given(made.part.given, stage);
    tell_section(given, count, count_of(chosen), made, run.options.adapt, stage);
    result.after = summary_of(adapt::fit_of(made.part.mesh, metric));
    result.deviation = deviation_of(made.part);
    result.mesh = std::move(made.whole);
    result.old_of_new = std::move(made.ids.old_of_new);
    result.old_tet_of_new = std::move(made.ids.old_tet_of_new);
  });
}

}  // namespace octafront
