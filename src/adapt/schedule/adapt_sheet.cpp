#include "adapt/schedule/adapt_sheet.h"

#include "adapt/schedule/sheet.h"
#include "adapt/schedule/sheet_cells.h"
#include "adapt/schedule/sheet_passes.h"
#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/geometry/measures.h"
#include "base/shared/blocks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace octafront::adapt {
namespace {

constexpr int kMostCyclesOfSheet = 60;
/// Less than one change for so many triangles is not worth another cycle.
constexpr int kDoneOfSheet = 200;
/// As of adapt_mesh(): times that triangles are made smaller where they stray too far, how long their longest edges are
/// made to be, the part of the bound within which all is near enough, and the least size that may be a reason.
constexpr int kMostMendingsOfSheet = 6;
constexpr double kLengthOfSheetStray = 1.6, kShareOfSheetBound = 0.85, kLeastEdgeOfSheetStray = 8;
constexpr double kFarShortOfSheet = 0.5, kFarLongOfSheet = 2;

/// What lies on both sides, and the patch: what stays of a triangle.
using Kept = std::pair<std::uint32_t, Sides>;

class SheetAdapter {
 public:
  SheetAdapter(const SurfaceMesh& given, const AdaptRules& rules, std::span<const VertexIndex> fixed)
      : input_(given), walls_(walls_of(given, rules)), is_fixed_(touching(given)) {
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
    walls.outer.assign(given.triangles.size(), is_turned_one_way(walls, rules.given != nullptr));
    return walls;
  }

  /// Of what is to lie on a given surface also outward.
  static bool is_turned_one_way(const Walls& walls, bool and_outward) {
    const auto& triangles = walls.surface.triangles;
    for (std::size_t e = 0; e < walls.edges.size(); ++e) {
      const auto uses = walls.edges.uses(e);
      if (uses.size() > 2 || (and_outward && uses.size() != 2)) return false;
      if (uses.size() == 2 && start_of(triangles, uses[0]) == start_of(triangles, uses[1])) return false;
    }
    double volume = 0;
    for (const auto& [a, b, c] : triangles)
      volume += six_volumes(walls.surface.points[0], walls.surface.points[a], walls.surface.points[b],
                            walls.surface.points[c]);
    return !and_outward || volume > 0;
  }

  /// Vertices where fans of triangles meet that share no edge there.
  static std::vector<std::uint8_t> touching(const SurfaceMesh& surface) {
    const EdgeTable table = make_edge_table(surface.points.size(), surface.triangles);
    const auto corners = static_cast<std::uint32_t>(3 * surface.triangles.size());
    DisjointSets fans(corners);
    const auto corner_at = [&](HalfEdge h, VertexIndex v) {
      return start_of(surface.triangles, h) == v ? h : next_of(h);
    };
    for (std::size_t e = 0; e < table.size(); ++e) {
      const auto uses = table.uses(e);
      for (std::size_t k = 1; k < uses.size(); ++k)
        for (const VertexIndex v : table.edges[e]) fans.join(corner_at(uses[0], v), corner_at(uses[k], v));
    }
    std::vector<std::uint32_t> fan(surface.points.size(), kNone);
    std::vector<std::uint8_t> touches(surface.points.size(), 0);
    for (std::uint32_t c = 0; c < corners; ++c) {
      const VertexIndex v = surface.triangles[c / 3][c % 3];
      if (fan[v] == kNone) fan[v] = fans.find(c);
      touches[v] |= fan[v] != fans.find(c);
    }
    return touches;
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
      sheet.set_line(walls.lines.edges[e][0], walls.lines.edges[e][1], walls.path[e]);
    return sheet;
  }

  static std::size_t triangles_of(const Sheet& sheet) {
    std::size_t count = 0;
    for (std::uint32_t t = 0; t < sheet.slots(); ++t) count += sheet.alive(t);
    return count;
  }

  static void cycles(Sheet& sheet, const SheetGuide& guide, const Stage& stage) {
    SheetCounts sum;
    for (int cycle = 0; cycle < kMostCyclesOfSheet; ++cycle) {
      stage.check();
      const SheetCounts now = cycle_in_cells(sheet, guide, cycle);
      validate(sheet);
      sum += now;
      stage.progress(-1);
      // Before all stages have been, much may be left across cells.
      if (cycle + 1 >= kCellStages && now.changes() * kDoneOfSheet < triangles_of(sheet)) break;
    }
    stage.count("splits", static_cast<double>(sum.split.done));
    stage.count("collapses", static_cast<double>(sum.collapse.done));
    stage.count("swaps", static_cast<double>(sum.swap.done));
    stage.count("moves", static_cast<double>(sum.move.done));
  }

  /// The triangles, numbered as the vertices of the sheet.
  static SurfaceMesh walls_of(const Sheet& sheet) {
    SurfaceMesh surface;
    for (const Vertex& v : sheet.vertices) surface.points.push_back(v.at);
    for (std::uint32_t t = 0; t < sheet.slots(); ++t)
      if (sheet.alive(t)) surface.triangles.push_back(sheet.corners(t)), surface.patch.push_back(sheet.part(t));
    return surface;
  }

  static void ask_for_smaller(Sheet& sheet, const std::vector<SmoothWalls::Stray>& strays) {
    std::vector<double> factor(sheet.vertices.size(), 1);
    for (const auto& [t, bound] : strays) {
      double longest = 0;
      for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, sheet.edge_length(t[i], t[(i + 1) % 3]));
      if (longest > 0)
        for (const VertexIndex v : t) factor[v] = std::max(factor[v], kLengthOfSheetStray / longest);
    }
    for (VertexIndex v = 0; v < factor.size(); ++v) {
      Vertex& vertex = sheet.vertices[v];
      if (factor[v] <= 1) continue;
      vertex.metric = factor[v] * factor[v] * vertex.metric;
      vertex.density = density_of(vertex.metric);
      vertex.exact = false, vertex.active = true;
    }
  }

  /// Brings triangles that stray too far nearer to the ground.
  static void mend(Sheet& sheet, const SheetGuide& guide, const AdaptRules& rules, AdaptedSheet& out,
                   const Stage& stage) {
    if (rules.tolerance <= 0) return;
    const auto& parts = guide.guide.ground.walls().surface.patch;
    const std::size_t count = parts.empty() ? 1 : *std::max_element(parts.begin(), parts.end()) + 1;
    const SmoothWalls smooth(
        guide.guide.ground,
        {std::vector<double>(count, rules.tolerance), std::vector<std::uint8_t>(count, rules.strict), {}, {}});
    out.deviation = worst_of(smooth.of(walls_of(sheet)));
    Sheet best = sheet;
    for (int k = 0; k < kMostMendingsOfSheet && out.deviation.excess() > 1; ++k) {
      std::vector<SmoothWalls::Stray> strays = smooth.strays(walls_of(sheet), kShareOfSheetBound);
      std::erase_if(strays, [&](const SmoothWalls::Stray& s) {
        const auto [a, b, c] = sheet.places(s.corners);
        return longest_squared_edge(a, b, c) < kLeastEdgeOfSheetStray * kLeastEdgeOfSheetStray * s.bound * s.bound;
      });
      if (strays.empty()) break;
      stage.count("triangles that strayed", static_cast<double>(strays.size()));
      ask_for_smaller(sheet, strays);
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
  std::vector<Vertex> at(surface.points.size());
  parallel_for(at.size(), [&](std::size_t v) {
    at[v].at = surface.points[v];
    at[v].metric = metric.at(at[v].at, at[v].hint);
    at[v].density = density_of(at[v].metric);
  });
  MetricFit fit;
  fit.quality_min = 1, fit.shortest = HUGE_VAL;
  double sum = 0;
  FlatSet<Edge> seen(3 * surface.points.size());
  for (const Triangle& t : surface.triangles) {
    const double quality = Sheet::score_of({&at[t[0]], &at[t[1]], &at[t[2]]});
    if (quality < fit.quality_min)
      fit.quality_min = quality, fit.quality_min_at = centroid(at[t[0]].at, at[t[1]].at, at[t[2]].at);
    sum += quality;
    const Vec3 u = at[t[1]].at - at[t[0]].at, w = at[t[2]].at - at[t[0]].at;
    for (const VertexIndex v : t) {
      const Metric& m = at[v].metric;
      const double uw = dot(u, m.times(w));
      fit.complexity += std::sqrt(std::max(m.squared(u) * m.squared(w) - uw * uw, 0.0)) / 6;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex &a = at[t[i]], &b = at[t[(i + 1) % 3]];
      if (!seen.insert(sorted_edge(t[i], t[(i + 1) % 3]))) continue;
      const double l = Sheet::length_between(a, b);
      ++fit.edges, fit.fitting += l >= kShortest && l <= kLongest;
      fit.far += l < kFarShortOfSheet || l > kFarLongOfSheet;
      if (l < fit.shortest) fit.shortest = l, fit.shortest_at = 0.5 * (a.at + b.at);
      if (l > fit.longest) fit.longest = l, fit.longest_at = 0.5 * (a.at + b.at);
    }
  }
  fit.quality_mean = surface.triangles.empty() ? 0 : sum / static_cast<double>(surface.triangles.size());
  return fit;
}

AdaptedSheet adapt_sheet(const SurfaceMesh& surface, const MetricField& metric, const AdaptRules& rules,
                         std::span<const VertexIndex> fixed, const Stage& stage) {
  return SheetAdapter(surface, rules, fixed).run(metric, rules, stage);
}

}  // namespace octafront::adapt
