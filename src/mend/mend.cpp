#include "mend/mend.h"

#include <octafront/error.h>
#include <octafront/repair.h>

#include "arrangement/arrange.h"
#include "cells/find_cells.h"
#include "core/disjoint_sets.h"
#include "core/wording.h"
#include "geometry/measures.h"
#include "mend/holes.h"
#include "mend/label.h"
#include "mend/report.h"
#include "mend/separate.h"
#include "mend/weld.h"
#include "surface/repair/steps.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/core.h>

namespace octafront {
namespace {

using namespace mend;
using repair::Draft;
using Kind = MendChange::Kind;

/// Of the diagonal.
constexpr double kTolerance = 1e-3;

double tolerance_of(const MendOptions& options, double diagonal) {
  if (!options.tolerance) return kTolerance * diagonal;
  if (!(*options.tolerance >= 0) || !std::isfinite(*options.tolerance))
    throw OptionError(fmt::format("`tolerance` is {}: it is a length of 0 or more", *options.tolerance));
  return *options.tolerance;
}

/// Whether the surface can be meshed as it is.
bool is_clean(const SurfaceMesh& soup, const RunContext& context) {
  return find_defects(repair_surface(soup, context), context).clean();
}

void clean_faces(Draft& draft) {
  repair::merge_vertices(draft);
  repair::drop_degenerate(draft);
  repair::drop_duplicates(draft);
  repair::drop_unused_vertices(draft);
}

/// The soup on its way to the result.
class Mending {
 public:
  Mending(const SurfaceMesh& soup, const MendOptions& options, const RunContext& context, MendReport& report)
      : soup_(soup),
        options_(options),
        context_(context),
        report_(report),
        draft_(repair::make_draft({soup.points, soup.triangles, {}, {}, {}}, context)) {}

  SurfaceMesh result() {
    context_.report("mending", -1);
    weld();
    orient();
    close();
    const Arrangement arranged = arrange(draft_.mesh.points, all_triangles(), context_);
    report_.crossing_pairs = arranged.crossing_pairs;
    report_.largest_move = std::max(report_.largest_move, arranged.largest_move);
    note_cuts(report_, arranged, draft_.face);
    const Cells cells(arranged.points, arranged.triangles, context_);
    const Labels labels = label_cells(arranged, cells, pieces_, report_.tolerance, context_);
    SurfaceMesh surface = boundary_of(arranged, cells, labels);
    separate(surface);
    return surface;
  }

 private:
  void weld() {
    clean_faces(draft_);
    const Welded welded = weld_open_edges(draft_, report_.tolerance);
    report_.joined_vertices = welded.joined;
    report_.divided_edges = welded.divided;
    report_.largest_move = std::max(report_.largest_move, welded.largest_move);
    for (const Vec3 p : welded.places) report_.changes.push_back({Kind::kJoined, p, welded.largest_move});
    if (welded.joined + welded.divided > 0) clean_faces(draft_);
  }

  void orient() {
    const repair::Pieces found = repair::orient_pieces(draft_);
    pieces_ = {found.piece_of_triangle, found.count()};
    turned_ = found.turned_faces;
  }

  void close() {
    holes_ = close_holes(draft_, report_.tolerance);
    for (std::uint32_t h = 0; h < holes_.size(); ++h)
      for (std::size_t i = 0; i < holes_[h].cap.size(); ++i) {
        hole_of_cap_.push_back(h);
        pieces_.piece.push_back(pieces_.piece[holes_[h].rim_triangle]);
      }
  }

  std::vector<Triangle> all_triangles() const {
    std::vector<Triangle> all = draft_.mesh.triangles;
    for (const Hole& hole : holes_) all.insert(all.end(), hole.cap.begin(), hole.cap.end());
    return all;
  }

  bool is_cap(std::uint32_t triangle) const { return triangle >= draft_.mesh.triangles.size(); }
  const Hole& hole_of(std::uint32_t cap) const { return holes_[hole_of_cap_[cap - draft_.mesh.triangles.size()]]; }
  bool is_within_tolerance(const Hole& hole) const { return hole.width <= report_.tolerance; }

  /// What a triangle of the result is a part of: of the input where it lies on it.
  std::uint32_t origin_of(const Arrangement& arranged, std::size_t t) const {
    for (const Origin& o : arranged.origins_of(t))
      if (!is_cap(o.triangle)) return o.triangle;
    return arranged.origins_of(t)[0].triangle;
  }

  /// The triangles between inside and outside, facing outside.
  SurfaceMesh boundary_of(const Arrangement& arranged, const Cells& cells, const Labels& labels) {
    SurfaceMesh surface;
    std::vector<VertexIndex> vertex(arranged.points.size(), kNone);
    std::vector<char> used(draft_.mesh.triangles.size(), 0);
    std::vector<double> closed(holes_.size(), 0);
    std::vector<std::uint64_t> closing(holes_.size(), 0);
    const std::uint32_t patch_of_caps = first_free_patch();
    bool has_patches = !soup_.patch.empty();
    for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
      const auto [front, back] = cells.sides_of(t);
      if (labels.inside[front] == labels.inside[back]) continue;
      Triangle triangle = arranged.triangles[t];
      if (labels.inside[front]) std::swap(triangle[1], triangle[2]);
      for (VertexIndex& v : triangle) {
        if (vertex[v] == kNone) {
          vertex[v] = static_cast<VertexIndex>(surface.points.size());
          surface.points.push_back(arranged.points[v]);
        }
        v = vertex[v];
      }
      const std::uint32_t origin = origin_of(arranged, t);
      const std::uint32_t given = is_cap(origin) ? hole_of(origin).rim_triangle : origin;
      const std::uint32_t face = draft_.face[given];
      surface.triangles.push_back(triangle);
      surface.source.push_back(soup_.source_of(face));
      const bool is_invented = is_cap(origin) && !is_within_tolerance(hole_of(origin));
      has_patches = has_patches || is_invented;
      surface.patch.push_back(is_invented ? patch_of_caps : soup_.patch_of(face));
      if (is_cap(origin)) {
        const std::uint32_t h = hole_of_cap_[origin - draft_.mesh.triangles.size()];
        closed[h] += triangle_area(surface.points[triangle[0]], surface.points[triangle[1]], surface.points[triangle[2]]);
        ++closing[h];
      }
      for (const Origin& o : arranged.origins_of(t))
        if (!is_cap(o.triangle)) used[o.triangle] = 1;
    }
    if (surface.triangles.empty())
      throw InputError(
          "the surface encloses nothing: it is a sheet, or more open than closed. Give it a thickness or close it; "
          "`repair` wrap makes a closed skin around it");
    surface.patch_names = soup_.patch_names;
    if (has_patches) {
      surface.patch_names.resize(patch_of_caps);
      surface.patch_names.emplace_back(kClosedByRepair);
    } else {
      surface.patch.clear();
    }
    note_holes(closed, closing);
    note_dropped(report_, draft_, used);
    note_turned(report_, draft_, pieces_.piece, labels.turned, turned_);
    note_filled(report_, arranged, cells, labels.filled);
    return surface;
  }

  std::uint32_t first_free_patch() const {
    auto free = static_cast<std::uint32_t>(std::max<std::size_t>(soup_.patch_names.size(), 1));
    for (const std::uint32_t p : soup_.patch) free = std::max(free, p + 1);
    return free;
  }

  void note_holes(const std::vector<double>& closed, const std::vector<std::uint64_t>& closing) {
    for (std::size_t h = 0; h < holes_.size(); ++h) {
      if (closing[h] == 0) continue;
      const std::uint32_t face = soup_.source_of(draft_.face[holes_[h].rim_triangle]);
      report_.changes.push_back(
          {Kind::kClosed, holes_[h].at, closed[h], closing[h], is_within_tolerance(holes_[h]), face});
    }
  }

  void separate(SurfaceMesh& surface) {
    const Separated done = separate_contacts(surface, kMostDrawn * report_.tolerance, context_);
    for (std::size_t i = 0; i < done.places.size(); ++i) {
      report_.changes.push_back({Kind::kSeparated, done.places[i], done.moves[i]});
      report_.largest_move = std::max(report_.largest_move, done.moves[i]);
    }
    report_.separated_vertices = done.places.size();
  }

  /// Of the tolerance, for what touches.
  static constexpr double kMostDrawn = 0.25;

  const SurfaceMesh& soup_;
  const MendOptions& options_;
  const RunContext& context_;
  MendReport& report_;
  Draft draft_;
  PieceOf pieces_;  ///< of the draft's triangles and of the caps behind them
  repair::InputFaces turned_;
  std::vector<Hole> holes_;
  std::vector<std::uint32_t> hole_of_cap_;
};

}  // namespace

Mended mend_surface(const SurfaceMesh& soup, const MendOptions& options, const RunContext& context) {
  Mended mended;
  MendReport& report = mended.report;
  repair::check_input(soup);
  report.diagonal = bounding_box(soup.points).diagonal();
  report.tolerance = tolerance_of(options, report.diagonal);
  report.area_before = area(soup);
  report.volume_before = std::abs(enclosed_volume(soup));
  if (is_clean(soup, context)) {
    report.clean = true;
    mended.surface = soup;
  } else {
    mended.surface = Mending(soup, options, context, report).result();
  }
  finish_report(report, mended.surface);
  return mended;
}

}  // namespace octafront
