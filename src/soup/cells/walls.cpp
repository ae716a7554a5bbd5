#include <octafront/complex.h>
#include <octafront/repair.h>

#include "base/core/wording.h"
#include "base/mesh/surface_topology.h"
#include "soup/cells/bodies.h"
#include "soup/cells/labelled.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>

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

/// Steps from outside to each cell, through walls.
std::vector<std::uint32_t> depths(const Arrangement& arranged, const Cells& cells) {
  std::vector<std::set<std::uint32_t>> beside(cells.count());
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    beside[front].insert(back);
    beside[back].insert(front);
  }
  std::vector<std::uint32_t> depth(cells.count(), kNone);
  std::queue<std::uint32_t> queue({0});
  depth[0] = 0;
  while (!queue.empty()) {
    const std::uint32_t c = queue.front();
    queue.pop();
    for (const std::uint32_t n : beside[c])
      if (depth[n] == kNone) {
        depth[n] = depth[c] + 1;
        queue.push(n);
      }
  }
  return depth;
}

/// A piece of the surface as a shell: closed, with one cell inside and one outside of it.
struct Shell {
  std::uint32_t outside = kNone, inside = kNone;
  bool simple = true;
  double facing_in = 0;  ///< area that faces the inside, less area that faces outside
};

std::vector<Shell> shells_of(const Arrangement& arranged, const Cells& cells, const std::vector<std::uint32_t>& depth) {
  std::vector<Shell> shells(cells.pieces());
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    Shell& s = shells[cells.piece()[t]];
    const bool faces_in = depth[front] > depth[back];
    const std::uint32_t in = faces_in ? front : back, out = faces_in ? back : front;
    if (s.outside == kNone) s = {out, in, true, 0};
    s.simple = s.simple && depth[front] != depth[back] && s.outside == out && s.inside == in;
    const auto [a, b, c] = arranged.triangles[t];
    const double area =
        length(cross(arranged.points[b] - arranged.points[a], arranged.points[c] - arranged.points[a])) / 2;
    s.facing_in += faces_in ? area : -area;
  }
  return shells;
}

/// Empties the cavities; says which shells inside others were taken for what.
void choose_nested(Labelled& labelled, const ComplexOptions& options, std::vector<std::string>& notes) {
  using Nested = ComplexOptions::Nested;
  const std::vector<std::uint32_t> depth = depths(labelled.arranged, labelled.cells);
  std::uint64_t cavities = 0, regions = 0;
  for (const Shell& s : shells_of(labelled.arranged, labelled.cells, depth)) {
    if (!s.simple || s.outside == 0) continue;
    const bool is_cavity = options.nested == Nested::kCavity
                               ? depth[s.inside] % 2 == 0
                               : options.nested == Nested::kByDirection && s.facing_in > 0;
    ++(is_cavity ? cavities : regions);
    if (is_cavity) labelled.region[s.inside] = kNone;
  }
  const bool by_direction = options.nested == Nested::kByDirection;
  if (cavities > 0)
    notes.push_back(fmt::format("{} inside {} taken as {}{}", counted(cavities, "shell"),
                                cavities == 1 ? "another" : "others", cavities == 1 ? "a cavity" : "cavities",
                                by_direction ? ": facing inward (`nested` region fills them)" : ""));
  if (regions > 0)
    notes.push_back(fmt::format("{} inside {} taken as {} of {} own{}", counted(regions, "shell"),
                                regions == 1 ? "another" : "others", regions == 1 ? "a region" : "regions",
                                regions == 1 ? "its" : "their",
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

/// Cells that nobody named are regions by number, or one.
Labelled label_cells(const Arrangement& arranged, const Cells& cells, const ComplexOptions& options,
                     std::vector<std::string>& notes) {
  Labelled labelled{arranged, cells, std::vector<std::uint32_t>(cells.count(), kNone), {}};
  const bool merge = options.cells == ComplexOptions::Cells::kMerge;
  for (std::uint32_t c = 1; c < cells.count(); ++c) {
    labelled.region[c] = merge ? 0 : c - 1;
    if (labelled.names.empty() || !merge) labelled.names.emplace_back(merge ? "body" : "");
  }
  choose_nested(labelled, options, notes);
  cells::apply_seeds(labelled, options);
  return labelled;
}

/// What a complex says of one region and outside alone need not be said.
void forget_sides_of_one(SurfaceMesh& surface) {
  if (surface.region_names.size() != 1) return;
  for (const Sides& s : surface.sides)
    if (s != Sides{kNone, 0}) return;
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
  forget_zeros(made.surface.patch);
  return made;
}

}  // namespace

std::optional<Complex> complex_of_walls(const SurfaceMesh& surface, const ComplexOptions& options,
                                        const RunContext& context) {
  check_input(surface);
  if (!surface.sides.empty()) return relabelled(surface, options, context);
  const bool asked = is_asked_for(options);
  if (is_for_solids(options))
    if (std::optional<Complex> solids = cells::complex_of_solids(surface, options, context)) return solids;
  if (!asked && is_plain(surface, context)) return std::nullopt;
  const Arrangement arranged = arrange(surface.points, surface.triangles, context);
  const Cells cells(arranged.points, arranged.triangles, context);
  std::vector<std::string> notes;
  if (arranged.crossing_pairs > 0 && arranged.new_points > 0)
    notes.push_back(fmt::format("faces divided where they cross, at {}", counted(arranged.new_points, "new point")));
  const bool encloses = cells.count() > 1;
  if (!asked && !encloses) return std::nullopt;
  const Labelled labelled = label_cells(arranged, cells, options, notes);
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
  forget_zeros(complex.surface.patch);
  // A name that was given stays.
  if (options.regions.empty()) forget_sides_of_one(complex.surface);
  notes.insert(notes.begin(), fmt::format("{} enclosed: {}", counted(cells.count() - 1, "cell"),
                                          counted(complex.volumes.size(), "region")));
  notes.insert(notes.end(), complex.notes.begin(), complex.notes.end());
  complex.notes = std::move(notes);
  return complex;
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
