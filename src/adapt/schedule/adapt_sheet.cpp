#include "adapt/schedule/adapt_sheet.h"

#include "adapt/schedule/sheet.h"
#include "adapt/schedule/sheet_cells.h"
#include "adapt/schedule/sheet_passes.h"
#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/geometry/blocks.h"
#include "base/geometry/measures.h"
#include "base/mesh/surface_topology.h"

#include <algorithm>
#include <map>
#include <utility>

namespace octafront::adapt {
namespace {

constexpr int kMostCyclesOfSheet = 60;
/// Less than one change for so many triangles is not worth another cycle.
constexpr int kDoneOfSheet = 200;
/// As of adapt_mesh(): times that triangles are made smaller where they stray too far, the part of the bound within
/// which all is near enough, and the least size that may be a reason.
constexpr int kMostMendingsOfSheet = 6;
constexpr double kShareOfSheetBound = 0.85, kLeastEdgeOfSheetStray = 8;

/// What lies on both sides, and the patch: what stays of a triangle.
using Kept = std::pair<std::uint32_t, Sides>;

class SheetAdapter {
 public:
  SheetAdapter(const SurfaceMesh& given, const AdaptRules& rules, std::span<const VertexIndex> fixed)
      : input_(given),
        walls_(walls_of(given, rules)),
        is_fixed_(touching_vertices(given.triangles, walls_.edges, given.points.size(), FansOver::kAllEdges)) {
    for (const VertexIndex v : fixed) is_fixed_[v] = 1;
  }

  AdaptedSheet run(const MetricField& metric, const AdaptRules& rules, const Stage& stage) {
    const bool outer = !walls_.outer.empty() && walls_.outer[0] != 0;
    const Ground ground(std::move(walls_), rules.given);
    const Guide guide{metric, ground, rules.tolerance, stage.context()};
    const SheetGuide sheet_guide{guide, outer};
    Sheet sheet = sheet_of(ground.walls(), rules);
    parallel_for(sheet.vertices.size(), [&](std::size_t v) { guide.ask(sheet.vertices[v]); });
    cycles(sheet, sheet_guide, stage);
    AdaptedSheet out;
    mend(sheet, sheet_guide, rules, out, stage);
    out.given = given_fit(ground, sheet.vertices);
    out.surface = surface_of(sheet, out.old_of_new);
    return out;
  }

 private:
  Walls walls_of(const SurfaceMesh& given, const AdaptRules& rules) {
    Walls walls;
    walls.surface.points = given.points;
    walls.surface.triangles = given.triangles;
    std::map<Kept, std::uint32_t> number;
    for (std::size_t t = 0; t < given.triangles.size(); ++t) {
      const Kept kept{given.patch.empty() ? 0 : given.patch[t],
                      given.sides.empty() ? Sides{kNone, kNone} : given.sides[t]};
      const auto [at, is_new] = number.try_emplace(kept, static_cast<std::uint32_t>(kept_.size()));
      if (is_new) kept_.push_back(kept);
      walls.surface.patch.push_back(at->second);
    }
    walls.edges = make_edge_table(given.points.size(), given.triangles);
    walls.lines = detect_features(walls.surface, walls.edges, rules.feature_angle);
    walls.path = find_paths(given.points.size(), walls.lines, [](std::uint32_t, std::uint32_t) { return true; });
    walls.outer.assign(given.triangles.size(), has_front(walls, rules.given != nullptr));
    return walls;
  }

  /// Of what is to lie on a given surface also outward.
  static bool has_front(const Walls& walls, bool and_outward) {
    const auto& triangles = walls.surface.triangles;
    if (!is_turned_one_way(triangles, walls.edges, and_outward)) return false;
    double volume = 0;
    for (const auto& [a, b, c] : triangles)
      volume += six_volumes(walls.surface.points[0], walls.surface.points[a], walls.surface.points[b],
                            walls.surface.points[c]);
    return !and_outward || volume > 0;
  }

  Sheet sheet_of(const Walls& walls, const AdaptRules& rules) const {
    std::vector<Vertex> vertices(input_.points.size());
    for (VertexIndex v = 0; v < vertices.size(); ++v) {
      vertices[v].at = input_.points[v], vertices[v].id = v;
      vertices[v].kind = Kind::kSurface, vertices[v].off = rules.given != nullptr;
    }
    for (const Edge& e : walls.lines.edges)
      for (const VertexIndex v : e) vertices[v].kind = Kind::kCurve;
    for (const VertexIndex v : walls.lines.corners) vertices[v].kind = Kind::kFixed;
    for (VertexIndex v = 0; v < vertices.size(); ++v)
      if (is_fixed_[v]) vertices[v].kind = Kind::kFixed, vertices[v].off = false;
    Sheet sheet(std::move(vertices), walls.surface.triangles, walls.surface.patch);
    for (std::uint32_t e = 0; e < walls.lines.edges.size(); ++e)
      sheet.line_edges.set(walls.lines.edges[e][0], walls.lines.edges[e][1], walls.path[e]);
    return sheet;
  }

  static std::size_t triangles_of(const Sheet& sheet) {
    std::size_t count = 0;
    for (std::uint32_t t = 0; t < sheet.slots(); ++t) count += sheet.alive(t);
    return count;
  }

  static void cycles(Sheet& sheet, const SheetGuide& guide, const Stage& stage) {
    Counts sum;
    for (int cycle = 0; cycle < kMostCyclesOfSheet; ++cycle) {
      stage.check();
      const Counts now = cycle_in_cells(sheet, guide, cycle);
      validate(sheet);
      sum += now;
      stage.progress(-1);
      // Before all stages have been, much may be left across cells.
      if (cycle + 1 >= kCellStages && now.changes() * kDoneOfSheet < triangles_of(sheet)) break;
    }
    sum.tell(stage);
  }

  /// The triangles, numbered as the vertices of the sheet.
  static SurfaceMesh walls_of(const Sheet& sheet) {
    SurfaceMesh surface;
    for (const Vertex& v : sheet.vertices) surface.points.push_back(v.at);
    for (std::uint32_t t = 0; t < sheet.slots(); ++t)
      if (sheet.alive(t)) surface.triangles.push_back(sheet.corners(t)), surface.patch.push_back(sheet.part(t));
    return surface;
  }

  /// Brings triangles that stray too far nearer to the ground.
  static void mend(Sheet& sheet, const SheetGuide& guide, const AdaptRules& rules, AdaptedSheet& out,
                   const Stage& stage) {
    if (rules.tolerance <= 0) return;
    const auto& parts = guide.guide.ground.walls().surface.patch;
    const std::size_t count = parts.empty() ? 1 : *std::max_element(parts.begin(), parts.end()) + 1;
    SmoothWalls smooth(
        guide.guide.ground,
        {std::vector<double>(count, rules.tolerance), std::vector<std::uint8_t>(count, rules.strict), {}, {}});
    out.deviation = worst_of(smooth.of(walls_of(sheet)));
    Sheet best = sheet;
    for (int k = 0; k < kMostMendingsOfSheet && out.deviation.excess() > 1; ++k) {
      const auto strays = smooth.strays(walls_of(sheet), kShareOfSheetBound, kLeastEdgeOfSheetStray);
      if (strays.empty()) break;
      stage.count("triangles that strayed", static_cast<double>(strays.size()));
      ask_for_smaller(sheet.vertices, strays);
      cycles(sheet, guide, stage);
      const Deviation now = worst_of(smooth.of(walls_of(sheet)));
      if (now.upper < out.deviation.upper) out.deviation = now, best = sheet;
    }
    sheet = std::move(best);
  }

  /// Vertices that were there in their order, new ones behind.
  SurfaceMesh surface_of(const Sheet& sheet, std::vector<VertexIndex>& old_of_new) const {
    SurfaceMesh surface;
    surface.patch_names = input_.patch_names, surface.region_names = input_.region_names;
    surface.patch_labels = input_.patch_labels, surface.region_labels = input_.region_labels;
    std::vector<VertexIndex> number(sheet.vertices.size(), kNone);
    for (VertexIndex v = 0; v < number.size(); ++v) {
      if (sheet.star(v).empty()) continue;
      number[v] = static_cast<VertexIndex>(surface.points.size());
      surface.points.push_back(sheet.point(v));
      old_of_new.push_back(sheet.vertices[v].id);
    }
    for (std::uint32_t t = 0; t < sheet.slots(); ++t) {
      if (!sheet.alive(t)) continue;
      Triangle c = sheet.corners(t);
      for (VertexIndex& v : c) v = number[v];
      surface.triangles.push_back(c);
      const Kept& kept = kept_[sheet.part(t)];
      if (!input_.patch.empty()) surface.patch.push_back(kept.first);
      if (!input_.sides.empty()) surface.sides.push_back(kept.second);
    }
    return surface;
  }

  const SurfaceMesh& input_;
  std::vector<Kept> kept_;  ///< per part
  Walls walls_;
  std::vector<std::uint8_t> is_fixed_;
};

}  // namespace

MetricFit fit_of(const SurfaceMesh& surface, const MetricField& metric) {
  FitFinder fit(surface.points, metric, 3 * surface.points.size());
  for (const Triangle& t : surface.triangles) {
    const std::array<const Vertex*, 3> corners{&fit.at(t[0]), &fit.at(t[1]), &fit.at(t[2])};
    const auto& [a, b, c] = corners;
    double complexity = 0;
    for (const Vertex* v : corners) complexity += metric_area(v->metric, b->at - a->at, c->at - a->at) / 3;
    fit.add(Sheet::score_of(corners), complexity, centroid(a->at, b->at, c->at));
    for (std::size_t i = 0; i < 3; ++i) fit.add_edge(t[i], t[(i + 1) % 3]);
  }
  return fit.found();
}

AdaptedSheet adapt_sheet(const SurfaceMesh& surface, const MetricField& metric, const AdaptRules& rules,
                         std::span<const VertexIndex> fixed, const Stage& stage) {
  return SheetAdapter(surface, rules, fixed).run(metric, rules, stage);
}

}  // namespace octafront::adapt
