#include <octafront/complex.h>
#include <octafront/repair.h>

#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/geometry/predicates.h"
#include "base/mesh/complex.h"
#include "base/mesh/surface_topology.h"
#include "soup/cells/bodies.h"
#include "soup/cells/cell_steps.h"
#include "soup/cells/labelled.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {
namespace {

using cells::Labelled;

/// As repair checks its input.
void check_input(const SurfaceMesh& surface) {
  constexpr double kLargest = 1e50;
  for (const Vec3 p : surface.points)
    for (int i = 0; i < 3; ++i)
      if (!(std::abs(p[i]) <= kLargest))
        throw InputError(fmt::format("the vertex {} is not finite, or beyond {:g}; repair the model where it was made",
                                     at_point(p), kLargest));
  for (const Triangle& t : surface.triangles)
    for (const VertexIndex v : t)
      if (v >= surface.points.size())
        throw InputError(
            fmt::format("a triangle names the vertex {}, but there are only {}", v, surface.points.size()));
  const std::size_t n = surface.triangles.size();
  if ((!surface.patch.empty() && surface.patch.size() != n) || (!surface.sides.empty() && surface.sides.size() != n))
    throw InputError(fmt::format("{} patches and {} sides are given for {} triangles", surface.patch.size(),
                                 surface.sides.size(), n));
}

bool is_asked_for(const ComplexOptions& options) {
  return options.cells != ComplexOptions::Cells::kAuto || options.nested != ComplexOptions::Nested::kByDirection ||
         !options.regions.empty() || !options.voids.empty();
}

/// Whether solids with names of their own say all that is asked.
bool is_for_solids(const ComplexOptions& options) {
  return options.cells != ComplexOptions::Cells::kMerge && options.nested == ComplexOptions::Nested::kByDirection &&
         options.regions.empty() && options.voids.empty();
}

/// Whether the surface is to be meshed as it is, or refused by those who mesh it: not the walls of several cells.
bool is_plain(const SurfaceMesh& surface, const RunContext& context) {
  const RepairedSurface repaired = repair_surface(surface, context);
  const bool closed = is_closed_manifold(repaired.surface.triangles, repaired.surface.points.size());
  if (closed && repaired.turned_cavities == 0) return true;
  const SurfaceDefects defects = find_defects(repaired, context);
  return defects.self_intersections.count > 0 ||
         (repaired.turned_cavities == 0 && defects.non_manifold_edges.count == 0 &&
          defects.non_manifold_vertices.count == 0 && defects.open_edges.count == 0);
}

/// Whether, but for vertices that are to be joined, this is one closed sheet without a flaw in any face or edge. Of it
/// no part is closed by itself, so it has neither shells nor walls between cells, and nobody need look for them.
bool is_one_closed_sheet(const SurfaceMesh& surface, const RunContext& context) {
  constexpr std::size_t kBackToBack = 2;
  tidy::Draft draft = tidy::make_draft(surface, context);
  tidy::merge_vertices(draft);
  const std::vector<Vec3>& points = draft.mesh.points;
  const std::vector<Triangle>& triangles = draft.mesh.triangles;
  if (triangles.size() <= kBackToBack) return false;
  DisjointSets sets(points.size());
  for (const auto& [a, b, c] : triangles) sets.join(a, b), sets.join(a, c);
  for (VertexIndex v = 0; v < points.size(); ++v)
    if (sets.find(v) != 0) return false;
  return std::ranges::none_of(triangles,
                              [&](const Triangle& t) { return collinear(points[t[0]], points[t[1]], points[t[2]]); }) &&
         is_closed_manifold(triangles, points.size());
}

/// Empties the cells that the walls do not mean to be filled; says which shells inside others were taken for what.
void empty_cavities(Labelled& labelled, const cells::FilledCells& filled, const ComplexOptions& options,
                    std::vector<std::string>& notes) {
  for (std::size_t c = 0; c < filled.times.size(); ++c)
    if (filled.times[c] == 0) labelled.region[c] = kNone;
  const bool by_direction = options.nested == ComplexOptions::Nested::kByDirection;
  const auto stay_empty = [&](std::uint64_t cavities, const char* why) {
    if (cavities > 0)
      notes.push_back(fmt::format("{} {} empty{}", counted(cavities, "cavity", "cavities"),
                                  cavities == 1 ? "stays" : "stay", by_direction ? why : ""));
  };
  stay_empty(filled.cavities_by_winding, ": walls face into what they enclose there (`nested` region fills that)");
  stay_empty(filled.cavities_by_nesting,
             ": faces do not agree on their outer side, so what lies behind an even number of walls is outside "
             "(`nested` region fills that)");
  if (filled.filled_shells > 0)
    notes.push_back(fmt::format("{} inside {} taken as {} of {} own{}", counted(filled.filled_shells, "shell"),
                                filled.filled_shells == 1 ? "another" : "others",
                                filled.filled_shells == 1 ? "a region" : "regions",
                                filled.filled_shells == 1 ? "its" : "their",
                                by_direction ? ": facing outward (`nested` cavity empties them)" : ""));
}

/// Throws InputError for walls with nothing on either side.
void refuse_loose_walls(const Labelled& labelled, const SurfaceMesh& surface) {
  std::vector<std::uint32_t> faces;
  std::string places;
  for (std::size_t t = 0; t < labelled.arranged.triangles.size(); ++t) {
    if (labelled.cells.sides_of(t) != std::array{0u, 0u}) continue;
    faces.push_back(surface.source_of(labelled.arranged.origins_of(t)[0].triangle));
    if (faces.size() <= 3)
      places += fmt::format("\n  face {} near {}", faces.back(),
                            at_point(labelled.arranged.points[labelled.arranged.triangles[t][0]]));
  }
  if (faces.empty()) return;
  throw InputError(
      fmt::format("{} bound nothing: outside lies on both sides, so a wall there has a hole or ends in "
                  "the open. A point inside (`region`) shows where it leaks:{}",
                  counted(faces.size(), "face"), places));
}

/// Whether a wall lies between two cells that are filled.
bool has_inner_walls(const Arrangement& arranged, const Cells& cells, const cells::FilledCells& filled) {
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t)
    if (const auto [front, back] = cells.sides_of(t);
        front != back && filled.times[front] != 0 && filled.times[back] != 0)
      return true;
  return false;
}

/// Cells that nobody named are regions by number, or one: where they are to be merged, and where bodies of one file
/// meet in edges and vertices at most.
Labelled label_cells(const Arrangement& arranged, const Cells& cells, const ComplexOptions& options,
                     std::vector<std::string>& notes, const RunContext& context) {
  using Ways = ComplexOptions::Cells;
  Labelled labelled{arranged, cells, std::vector<std::uint32_t>(cells.count(), kNone), {}};
  const cells::FilledCells filled = cells::filled_cells(arranged, cells, options.nested, context);
  const bool merge = options.cells == Ways::kMerge || (options.cells == Ways::kAuto && options.regions.empty() &&
                                                       !has_inner_walls(arranged, cells, filled));
  for (std::uint32_t c = 1; c < cells.count(); ++c) {
    labelled.region[c] = merge ? 0 : c - 1;
    if (labelled.names.empty() || !merge) labelled.names.emplace_back(merge ? "body" : "");
  }
  empty_cavities(labelled, filled, options, notes);
  cells::apply_seeds(labelled, options);
  return labelled;
}

/// What a complex says of one region and outside alone need not be said, unless it touches itself.
void forget_sides_of_one(SurfaceMesh& surface) {
  if (surface.region_names.size() != 1 || is_complex(surface)) return;
  if (!is_closed_manifold(surface.triangles, surface.points.size())) return;
  surface.sides.clear();
  surface.region_names.clear();
}

void forget_zeros(std::vector<std::uint32_t>& patch) {
  if (std::all_of(patch.begin(), patch.end(), [](std::uint32_t p) { return p == 0; })) patch.clear();
}

/// A complex as it came, its regions named and emptied by points in them.
Complex relabelled(const SurfaceMesh& surface, const ComplexOptions& options, const RunContext& context) {
  Complex complex;
  complex.surface = surface;
  if (options.regions.empty() && options.voids.empty()) return complex;
  const Arrangement arranged = arrange(surface.points, surface.triangles, context);
  if (arranged.crossing_pairs > 0)
    throw InputError(
        "the faces of this complex cross: no point says which region it lies in; `octafront check` lists "
        "the places");
  const Cells cells(arranged.points, arranged.triangles, context);
  Labelled labelled{arranged, cells, std::vector<std::uint32_t>(cells.count(), kNone), surface.region_names};
  labelled.labels = surface.region_labels;
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const Sides sides = surface.sides_of(arranged.origins_of(t)[0].triangle);
    for (const std::size_t side : {0, 1}) labelled.region[cells.sides_of(t)[side]] = sides[side];
  }
  for (const std::uint32_t r : labelled.region)
    for (auto n = static_cast<std::uint32_t>(labelled.names.size()); r != kNone && n <= r; ++n)
      labelled.names.emplace_back();
  cells::apply_seeds(labelled, options);
  Complex made = cells::complex_of(labelled, [&](std::size_t t, Sides) {
    const std::uint32_t face = arranged.origins_of(t)[0].triangle;
    return cells::Face{surface.patch_of(face), surface.source_of(face)};
  });
  made.surface.patch_names = surface.patch_names;
  made.surface.patch_labels = surface.patch_labels;
  forget_zeros(made.surface.patch);
  return made;
}

}  // namespace

std::optional<Complex> complex_of_walls(const SurfaceMesh& surface, const ComplexOptions& options,
                                        const RunContext& context) {
  return cells::complex_of_walls(surface, options, {}, context);
}

namespace cells {

std::optional<Complex> complex_of_walls(const SurfaceMesh& surface, const ComplexOptions& options,
                                        const ElementsToCome& elements, const RunContext& context) {
  check_input(surface);
  if (!surface.sides.empty()) return relabelled(surface, options, context);
  const bool asked = is_asked_for(options);
  if (is_for_solids(options)) {
    if (std::optional<Complex> solids = complex_of_solids(surface, options, elements, context)) return solids;
    if (!asked && is_one_closed_sheet(surface, context)) return std::nullopt;
    if (std::optional<Complex> shells = complex_of_shells(surface, options, elements, context)) {
      forget_zeros(shells->surface.patch);
      return shells;
    }
  }
  if (!asked && is_plain(surface, context)) return std::nullopt;
  const Arrangement arranged = arrange(surface.points, surface.triangles, context);
  const Cells cells(arranged.points, arranged.triangles, context);
  std::vector<std::string> notes;
  if (arranged.crossing_pairs > 0 && arranged.new_points > 0)
    notes.push_back(fmt::format("faces divided where they cross, at {}", counted(arranged.new_points, "new point")));
  const bool encloses = cells.count() > 1;
  if (!asked && !encloses) return std::nullopt;
  const Labelled labelled = label_cells(arranged, cells, options, notes, context);
  try {
    refuse_loose_walls(labelled, surface);
  } catch (const InputError&) {
    if (asked) throw;
    return std::nullopt;
  }
  Complex complex = cells::complex_of(labelled, [&](std::size_t t, Sides) {
    const std::uint32_t face = arranged.origins_of(t)[0].triangle;
    return cells::Face{surface.patch_of(face), surface.source_of(face)};
  });
  if (complex.surface.triangles.empty()) throw InputError("every enclosed cell is a void: there is nothing to mesh");
  complex.surface.patch_names = surface.patch_names;
  complex.surface.patch_labels = surface.patch_labels;
  forget_zeros(complex.surface.patch);
  // A name that was given stays.
  if (options.regions.empty()) forget_sides_of_one(complex.surface);
  notes.insert(notes.begin(), fmt::format("{} enclosed: {}", counted(cells.count() - 1, "cell"),
                                          counted(complex.volumes.size(), "region")));
  notes.insert(notes.end(), complex.notes.begin(), complex.notes.end());
  complex.notes = std::move(notes);
  return complex;
}

}  // namespace cells

BoundedSpaces bounded_spaces(const SurfaceMesh& clean, const RunContext& context) {
  const Cells cells(clean.points, clean.triangles, context);
  std::vector<char> is_filled(cells.count(), 0);
  for (std::size_t t = 0; t < clean.triangles.size(); ++t)
    for (const std::size_t side : {0, 1})
      if (clean.sides_of(t)[side] != kNone) is_filled[cells.sides_of(t)[side]] = 1;
  const auto filled = static_cast<std::uint32_t>(std::count(is_filled.begin(), is_filled.end(), 1));
  return {filled, cells.count() - 1 - filled};
}

SurfaceMesh tube_along(const std::vector<Vec3>& way) {
  SurfaceMesh tube;
  Box3 box;
  for (const Vec3 p : way) box.add(p);
  constexpr double kThin = 0.004;
  const double radius = kThin * box.diagonal();
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const Vec3 along = normalized(way[i + 1] - way[i]);
    const Vec3 u = normalized(cross(along, std::abs(along.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
               v = cross(along, u);
    const auto first = static_cast<VertexIndex>(tube.points.size());
    for (const Vec3 p : {way[i], way[i + 1]})
      for (const Vec3 off : {u, -0.5 * u + 0.866 * v, -0.5 * u - 0.866 * v}) tube.points.push_back(p + radius * off);
    for (VertexIndex k = 0; k < 3; ++k) {
      const VertexIndex a = first + k, b = first + (k + 1) % 3;
      tube.triangles.push_back({a, b, b + 3});
      tube.triangles.push_back({a, b + 3, a + 3});
    }
  }
  return tube;
}

}  // namespace octafront
