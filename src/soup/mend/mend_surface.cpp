#include <octafront/error.h>
#include <octafront/mend.h>
#include <octafront/repair.h>

#include "base/core/disjoint_sets.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/triangle_tree.h"
#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"
#include "soup/mend/mend_steps.h"
#include "soup/tidy/examine.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

using namespace mend;
using tidy::Draft;
using Kind = MendChange::Kind;

/// Of the diagonal.
constexpr double kTolerance = 1e-3;

[[noreturn]] void refuse_open() {
  throw InputError(
      "the surface encloses nothing: it is a sheet, or more open than closed. Give it a thickness or close it; "
      "`repair` wrap makes a closed skin around it");
}

/// Where more than this part of all corners had to be joined the triangles were loose.
constexpr double kLoose = 0.5;

[[noreturn]] void refuse_loose(const MendReport& report, std::size_t corners) {
  throw InputError(fmt::format(
      "the triangles do not hang together: {} of their {} corners were brought together, over gaps of up to "
      "{:.4g}, and enclose nothing still. Where edges are shorter than gaps nobody can tell which belong "
      "together: give the triangles common corners; `repair` wrap makes a closed skin around them",
      report.joined_vertices, corners, 2 * report.largest_move));
}

/// Exactly; what has no area at all does not count as a plane.
bool lies_in_a_plane(const SurfaceMesh& soup) {
  const auto corners = [&](const Triangle& t) {
    return TriangleCorners{soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]};
  };
  const auto first = std::ranges::find_if(soup.triangles, [&](const Triangle& t) {
    const TriangleCorners c = corners(t);
    return !collinear(c[0], c[1], c[2]);
  });
  if (first == soup.triangles.end()) return false;
  const TriangleCorners plane = corners(*first);
  return std::ranges::all_of(soup.triangles, [&](const Triangle& t) {
    return std::ranges::all_of(corners(t), [&](Vec3 p) { return orient3d(plane[0], plane[1], plane[2], p) == 0; });
  });
}

double tolerance_of(const MendOptions& options, double diagonal) {
  if (!options.tolerance) return kTolerance * diagonal;
  if (!(*options.tolerance >= 0) || !std::isfinite(*options.tolerance))
    throw OptionError(fmt::format("`tolerance` is {}: it is a length of 0 or more", *options.tolerance));
  return *options.tolerance;
}

bool is_clean(const SurfaceMesh& surface, const RunContext& context) {
  return examine_surface(surface, false, context).defects.clean();
}

/// Whether repair did more than to join corners at the same place, which many files have apart.
bool has_changed(const RepairedSurface& r) {
  return r.duplicate_faces + r.degenerate_faces + r.turned_faces + r.turned_shells > 0;
}

void clean_draft(Draft& draft) {
  tidy::merge_vertices(draft);
  tidy::drop_degenerate(draft);
  tidy::drop_duplicates(draft);
  tidy::drop_unused_vertices(draft);
}

/// The soup on its way to the result.
class Mending {
 public:
  Mending(const SurfaceMesh& soup, const RunContext& context, MendReport& report)
      : soup_(soup),
        context_(context),
        report_(report),
        draft_(tidy::make_draft({soup.points, soup.triangles, {}, {}, {}}, context)) {}

  /// By steps that keep what is not broken; nullopt where they fail.
  std::optional<SurfaceMesh> exact_result(double weld_reach) {
    weld(weld_reach);
    orient();
    lay_flat();
    close();
    try {
      SurfaceMesh surface = arranged_result();
      if (is_clean(surface, context_)) return without_dust(std::move(surface));
      report_.notes.push_back("what touches could not be drawn apart");
    } catch (const InputError& error) {
      // Rounding found no end, or a piece has no inside in doubles.
      report_.notes.push_back(error.what());
    } catch (const MeshingError& error) {
      report_.notes.push_back(error.what());
    }
    return std::nullopt;
  }

  /// The last rung: by the winding number alone, on a lattice.
  SurfaceMesh rebuilt_result() {
    weld(report_.tolerance);
    orient();
    close();
    SurfaceMesh walls{draft_.mesh.points, all_triangles(), {}, {}, {}};
    LatticeSkin skin;
    try {
      skin = skin_of_lattice(walls, kLatticeEdge * report_.diagonal, context_);
    } catch (const MeshingError&) {
      refuse();
    }
    double all = 0, far = 0;
    for (std::size_t t = 0; t < skin.surface.triangles.size(); ++t) {
      const auto [a, b, c] = skin.surface.triangles[t];
      const double size = triangle_area(skin.surface.points[a], skin.surface.points[b], skin.surface.points[c]);
      all += size;
      if (skin.is_far[t]) far += size;
    }
    const bool is_flake = 2 * std::abs(enclosed_volume(skin.surface)) < 2 * kLatticeEdge * report_.diagonal * all;
    if (far > kMostInvented * all || is_flake || part_left_out(walls, skin.surface) > kMostIdle) refuse();
    report_.changes.push_back({Kind::kRebuilt, skin.surface.points.front(), all, skin.surface.triangles.size()});
    return named(std::move(skin));
  }

 private:
  [[noreturn]] void refuse() const {
    if (static_cast<double>(report_.joined_vertices) > kLoose * static_cast<double>(soup_.points.size()))
      refuse_loose(report_, soup_.points.size());
    refuse_open();
  }

  SurfaceMesh arranged_result() {
    const Arrangement arranged = arrange(draft_.mesh.points, all_triangles(), context_);
    report_.crossing_pairs = arranged.crossing_pairs;
    report_.largest_move = std::max(report_.largest_move, arranged.largest_move);
    SurfaceMesh surface = surface_of(arranged, best_skin(arranged));
    separate(surface);
    return surface;
  }

  /// Where that would make crossings only the finest dust is taken out, or none.
  SurfaceMesh without_dust(SurfaceMesh surface) {
    for (const double part : kDust) {
      SurfaceMesh tidy = surface;
      const double reach = part * report_.tolerance;
      if (drop_dust(tidy, reach) == 0) break;
      if (!is_clean(tidy, context_)) continue;
      report_.largest_move = std::max(report_.largest_move, reach);
      return tidy;
    }
    return surface;
  }

  /// Of the area of the input, what lies outside of a surface and away from it: a terrain around a house.
  double part_left_out(const SurfaceMesh& walls, const SurfaceMesh& skin) const {
    const TriangleTree tree(skin);
    double all = 0, left_out = 0;
    for (std::size_t t = 0; t < draft_.mesh.triangles.size(); ++t) {
      const auto [a, b, c] = walls.triangles[t];
      const double size = triangle_area(walls.points[a], walls.points[b], walls.points[c]);
      const Vec3 middle = centroid(walls.points[a], walls.points[b], walls.points[c]);
      all += size;
      if (!tree.is_within(middle, kLatticeEdge * report_.diagonal) && !tree.contains(middle)) left_out += size;
    }
    return all > 0 ? left_out / all : 0;
  }

  /// Patches and faces of the input, by the nearest walls.
  SurfaceMesh named(LatticeSkin skin) const {
    const std::uint32_t patch_of_caps = first_free_patch();
    for (std::size_t t = 0; t < skin.is_far.size(); ++t)
      if (is_cap(skin.surface.source[t])) skin.is_far[t] = 1;
    const bool has_far = std::find(skin.is_far.begin(), skin.is_far.end(), 1) != skin.is_far.end();
    for (std::size_t t = 0; t < skin.surface.triangles.size(); ++t) {
      std::uint32_t& wall = skin.surface.source[t];
      const std::uint32_t face = is_cap(wall) ? 0 : draft_.face[wall];
      if (has_far || !soup_.patch.empty())
        skin.surface.patch.push_back(skin.is_far[t] ? patch_of_caps : soup_.patch_of(face));
      wall = soup_.source_of(face);
    }
    skin.surface.patch_names = soup_.patch_names;
    skin.surface.patch_labels = soup_.patch_labels;
    if (has_far) {
      skin.surface.patch_names.resize(patch_of_caps);
      skin.surface.patch_names.emplace_back(kClosedByRepair);
    }
    return std::move(skin.surface);
  }

  void weld(double reach) {
    clean_draft(draft_);
    const Welded welded = weld_open_edges(draft_, reach);
    report_.joined_vertices = welded.joined;
    report_.divided_edges = welded.divided;
    report_.largest_move = std::max(report_.largest_move, welded.largest_move);
    for (const Vec3 p : welded.places) report_.changes.push_back({Kind::kJoined, p, welded.largest_move});
    if (welded.joined + welded.divided > 0) clean_draft(draft_);
  }

  void orient() {
    const tidy::Pieces found = tidy::orient_pieces(draft_);
    pieces_ = {found.piece_of_triangle, found.count()};
    turned_ = found.turned_faces;
  }

  void lay_flat() {
    const LaidFlat done = lay_crumples_flat(draft_, report_.tolerance);
    if (done.faces == 0) return;
    report_.largest_move = std::max(report_.largest_move, done.largest_move);
    for (const Vec3 p : done.places) report_.changes.push_back({Kind::kLaidFlat, p, done.largest_move});
    const tidy::InputFaces turned = std::move(turned_);
    orient();
    turned_ = turned;
  }

  void close() {
    ClosedHoles closed = close_holes(draft_, report_.tolerance);
    if (closed.is_one_sheet) refuse();
    holes_ = std::move(closed.holes);
    report_.based_holes = static_cast<std::uint64_t>(std::ranges::count_if(holes_, &Hole::has_base));
    // Where there is nothing but sheets, they together may enclose something.
    const bool all = std::find(closed.is_sheet.begin(), closed.is_sheet.end(), 0) == closed.is_sheet.end();
    pieces_.is_sheet.assign(pieces_.count, 0);
    for (std::size_t t = 0; t < closed.is_sheet.size() && !all; ++t)
      pieces_.is_sheet[pieces_.piece[t]] = closed.is_sheet[t];
    for (const Hole& hole : holes_)
      pieces_.piece.insert(pieces_.piece.end(), hole.cap.size(), pieces_.piece[hole.rim_triangle]);
  }

  std::vector<Triangle> all_triangles() const {
    std::vector<Triangle> all = draft_.mesh.triangles;
    for (const Hole& hole : holes_) all.insert(all.end(), hole.cap.begin(), hole.cap.end());
    return all;
  }

  bool is_cap(std::uint32_t triangle) const { return triangle >= draft_.mesh.triangles.size(); }
  /// By cells. Throws MeshingError where too much would be left out.
  Skin best_skin(const Arrangement& arranged) {
    const Cells cells(arranged.points, arranged.triangles, context_);
    const Labels labels = label_cells(arranged, cells, pieces_, report_.tolerance, context_);
    Skin skin = skin_of_cells(arranged, all_triangles(), cells, labels, context_);
    if (leaves_out_little(skin)) {
      note_turned(report_, draft_, pieces_.piece, labels.turned, turned_);
      note_filled(report_, arranged, cells, labels.filled);
      return skin;
    }
    throw MeshingError("faces with much of the area bound no cell");
  }

  static bool leaves_out_little(const Skin& skin) {
    return !skin.triangles.empty() && skin.idle_area <= kMostIdle * skin.wall_area;
  }

  SurfaceMesh surface_of(const Arrangement& arranged, Skin skin) {
    note_cuts(report_, arranged, draft_.face);
    SurfaceMesh surface{std::move(skin.points), std::move(skin.triangles), {}, {}, {}};
    std::vector<char> used(draft_.mesh.triangles.size(), 0);
    const Invented invented = invented_faces(arranged, surface, skin.wall);
    const std::uint32_t patch_of_caps = first_free_patch();
    bool has_patches = !soup_.patch.empty();
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const std::uint32_t h = invented.hole[t];
      const bool is_far = h != kNone && !invented.holes[h].within_tolerance;
      const std::uint32_t face = draft_.face[h == kNone ? given_origin(arranged, skin.wall[t]) : invented.rim[h]];
      surface.source.push_back(soup_.source_of(face));
      surface.patch.push_back(is_far ? patch_of_caps : soup_.patch_of(face));
      has_patches = has_patches || is_far;
      for (const Origin& o : arranged.origins_of(skin.wall[t]))
        if (!is_cap(o.triangle)) used[o.triangle] = 1;
    }
    surface.patch_names = soup_.patch_names;
    surface.patch_labels = soup_.patch_labels;
    if (has_patches) {
      surface.patch_names.resize(patch_of_caps);
      surface.patch_names.emplace_back(kClosedByRepair);
    } else {
      surface.patch.clear();
    }
    for (const MendChange& hole : invented.holes) report_.changes.push_back(hole);
    note_dropped(report_, draft_, used);
    return surface;
  }

  /// The triangle of the input that a wall is a part of; kNone: of a cap only.
  std::uint32_t given_origin(const Arrangement& arranged, std::uint32_t wall) const {
    for (const Origin& o : arranged.origins_of(wall))
      if (!is_cap(o.triangle)) return o.triangle;
    return kNone;
  }

  /// What closes holes, by pieces that hang together.
  struct Invented {
    std::vector<std::uint32_t> hole;  ///< per triangle of the surface; kNone: it was there
    std::vector<MendChange> holes;
    std::vector<std::uint32_t> rim;  ///< of each hole, a triangle of the draft at its rim
  };
  Invented invented_faces(const Arrangement& arranged, const SurfaceMesh& surface,
                          const std::vector<std::uint32_t>& wall) const {
    const std::size_t n = surface.triangles.size();
    const auto is_new = [&](std::uint32_t t) { return given_origin(arranged, wall[t]) == kNone; };
    const EdgeTable table = make_edge_table(surface.points.size(), surface.triangles, context_);
    DisjointSets pieces(n);
    std::vector<std::uint32_t> beside(n, kNone);
    std::vector<double> around(n, 0);
    for (std::size_t e = 0; e < table.size(); ++e) {
      const double length = distance(surface.points[table.edges[e][0]], surface.points[table.edges[e][1]]);
      for (const HalfEdge g : table.uses(e))
        for (const HalfEdge h : table.uses(e)) {
          if (!is_new(g / 3) || g == h) continue;
          if (is_new(h / 3)) {
            pieces.join(g / 3, h / 3);
          } else {
            beside[g / 3] = std::min(beside[g / 3], given_origin(arranged, wall[h / 3]));
            around[g / 3] += length;
          }
        }
    }
    Invented invented;
    invented.hole.assign(n, kNone);
    std::vector<double> rim_length;
    std::vector<std::uint32_t> number(n, kNone);
    for (std::uint32_t t = 0; t < n; ++t) {
      if (!is_new(t)) continue;
      std::uint32_t& h = number[pieces.find(t)];
      const auto [a, b, c] = surface.triangles[t];
      if (h == kNone) {
        h = static_cast<std::uint32_t>(invented.holes.size());
        invented.holes.push_back({Kind::kClosed, centroid(surface.points[a], surface.points[b], surface.points[c])});
        invented.rim.push_back(kNone);
        rim_length.push_back(0);
      }
      invented.hole[t] = h;
      invented.holes[h].size += triangle_area(surface.points[a], surface.points[b], surface.points[c]);
      ++invented.holes[h].faces;
      invented.rim[h] = std::min(invented.rim[h], beside[t]);
      rim_length[h] += around[t];
    }
    for (std::size_t h = 0; h < invented.holes.size(); ++h) {
      MendChange& hole = invented.holes[h];
      // Of a strip this is the width.
      hole.within_tolerance = 2 * hole.size <= report_.tolerance * rim_length[h];
      if (invented.rim[h] == kNone) invented.rim[h] = 0;
      hole.first_face = soup_.source_of(draft_.face[invented.rim[h]]);
    }
    return invented;
  }

  std::uint32_t first_free_patch() const {
    auto free = static_cast<std::uint32_t>(std::max<std::size_t>(soup_.patch_names.size(), 1));
    for (const std::uint32_t p : soup_.patch) free = std::max(free, p + 1);
    return free;
  }

  void separate(SurfaceMesh& surface) {
    const Separated done = separate_contacts(surface, kMostDrawn * report_.tolerance, context_);
    for (std::size_t i = 0; i < done.places.size(); ++i) {
      report_.changes.push_back({Kind::kSeparated, done.places[i], done.moves[i]});
      report_.largest_move = std::max(report_.largest_move, done.moves[i]);
    }
    report_.separated_vertices = done.places.size();
  }

  /// Of the tolerance: triangles as low as this are left by cuts that nearly meet, and by rounding; nobody draws them.
  static constexpr double kDust[] = {1e-3, 1e-6, 1e-10};
  /// Of the tolerance, for what touches.
  static constexpr double kMostDrawn = 0.25;
  /// Of the area of the soup, what may bound nothing.
  static constexpr double kMostIdle = 0.4;
  /// Edges of the lattice of the last rung, of the diagonal, and how much of its boundary may be far from all walls: of
  /// a terrain it is half.
  static constexpr double kLatticeEdge = 0.015, kMostInvented = 0.45;

  const SurfaceMesh& soup_;
  const RunContext& context_;
  MendReport& report_;
  Draft draft_;
  PieceOf pieces_;  ///< of the draft's triangles and of the caps behind them
  tidy::InputFaces turned_;
  std::vector<Hole> holes_;
};

/// Of the tolerance, in turn: what was brought together may have been in the way, so each time less of it is.
constexpr double kParts[] = {1.0, 0.05, 1e-3, 0.0};

SurfaceMesh mended_soup(const SurfaceMesh& soup, const RunContext& context, MendReport& report) {
  context.report("mending", -1);
  const MendReport before = report;
  std::optional<MendReport> failed;
  for (const double part : kParts) {
    report = before;
    if (auto surface = Mending(soup, context, report).exact_result(part * report.tolerance)) return std::move(*surface);
    if (!failed) failed = report;
    if (report.joined_vertices + report.divided_edges == 0) break;
  }
  report = *failed;
  return Mending(soup, context, report).rebuilt_result();
}

/// Of the diagonal; nearer skins would have too many triangles.
constexpr double kWrapDistance = 0.01, kLeastWrap = 0.0005;

SurfaceMesh wrapped(const SurfaceMesh& soup, const MendOptions& options, const RunContext& context,
                    MendReport& report) {
  const double distance = options.distance.value_or(kWrapDistance * report.diagonal);
  if (!(distance > kLeastWrap * report.diagonal) || !std::isfinite(distance))
    throw OptionError(fmt::format("`distance` is {}: it is a length of a {:.0f}th of the diagonal or more", distance,
                                  1 / kLeastWrap));
  if (soup.triangles.empty()) throw InputError("there are no triangles to wrap");
  LatticeSkin skin = wrap_of(soup, distance, context);
  for (std::uint32_t& face : skin.surface.source) {
    if (!soup.patch.empty()) skin.surface.patch.push_back(soup.patch_of(face));
    face = soup.source_of(face);
  }
  skin.surface.patch_names = soup.patch_names;
  skin.surface.patch_labels = soup.patch_labels;
  report.largest_move = distance;
  report.changes.push_back(
      {Kind::kRebuilt, skin.surface.points.front(), area(skin.surface), skin.surface.triangles.size()});
  return std::move(skin.surface);
}

/// Points of faces that were divided are rounded, and dust is taken out: what lies no farther from its face than this
/// part of the tolerance was not moved.
constexpr double kUnmoved = 0.01;

/// For what was moved, by no more than the tolerance, the tolerance; what was invented nobody knows any nearer. Empty
/// if nothing was moved.
std::vector<double> bounds_of(const SurfaceMesh& soup, const SurfaceMesh& made, const MendReport& report) {
  if (report.tolerance == 0 || report.count(Kind::kRebuilt) > 0) return {};
  std::unordered_map<std::uint32_t, std::uint32_t> face_of;
  for (std::uint32_t t = 0; t < soup.triangles.size() && !soup.source.empty(); ++t) face_of.emplace(soup.source[t], t);
  std::vector<double> bounds(made.triangles.size(), HUGE_VAL);
  bool any = false;
  for (std::size_t t = 0; t < bounds.size(); ++t) {
    const std::uint32_t source = made.source_of(t);
    const auto& [a, b, c] = soup.triangles[soup.source.empty() ? source : face_of.at(source)];
    double moved = 0;
    for (const VertexIndex v : made.triangles[t]) {
      const Vec3 p = made.points[v];
      moved =
          std::max(moved, distance(p, closest_point_on_triangle(p, soup.points[a], soup.points[b], soup.points[c])));
    }
    if (!(moved > kUnmoved * report.tolerance && moved <= report.tolerance)) continue;
    bounds[t] = report.tolerance;
    any = true;
  }
  return any ? bounds : std::vector<double>{};
}

}  // namespace

Mended mend_surface(const SurfaceMesh& soup, const MendOptions& options, const RunContext& context) {
  Mended mended;
  MendReport& report = mended.report;
  tidy::check_input(soup);
  if (!soup.sides.empty()) throw OptionError("a complex of regions is mended by nobody: give the walls without sides");
  report.diagonal = bounding_box(soup.points).diagonal();
  report.tolerance = tolerance_of(options, report.diagonal);
  report.area_before = area(soup);
  report.volume_before = std::abs(enclosed_volume(soup));
  if (options.way == MendOptions::Way::kWrap) {
    mended.surface = wrapped(soup, options, context, report);
  } else {
    if (lies_in_a_plane(soup)) refuse_open();
    auto [repaired, edges, defects] = examine_surface(soup, false, context);
    const bool is_enough = defects.clean();
    report.clean = is_enough && !has_changed(repaired);
    if (!is_enough) {
      mended.surface = mended_soup(soup, context, report);
      mended.bound = bounds_of(soup, mended.surface, report);
    } else if (report.clean) {
      mended.surface = soup;
    } else {
      mended.surface = std::move(repaired.surface);
    }
    if (is_enough) report.notes = repaired.notes;
  }
  finish_report(report, mended.surface, context);
  return mended;
}

}  // namespace octafront
