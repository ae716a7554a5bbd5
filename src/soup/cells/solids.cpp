// Solids by name in one file, such as those of an STL file with several.

#include "base/core/disjoint_sets.h"
#include "base/core/groups.h"
#include "base/core/wording.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/surface_topology.h"
#include "soup/cells/bodies.h"
#include "soup/cells/misfit.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/core.h>

namespace octafront::cells {
namespace {

/// Faces of neighbours that differ by less, in parts of the diagonal, are one wall: single precision keeps seven
/// digits.
constexpr double kTouching = 1e-6;

bool have_names(const SurfaceMesh& surface) {
  const auto named =
      std::count_if(surface.patch_names.begin(), surface.patch_names.end(), [](const auto& n) { return !n.empty(); });
  return !surface.patch.empty() && named >= 2;
}

/// What lies in another one comes behind it, and cuts it out.
std::vector<Body> larger_first(const std::vector<Body>& bodies) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t b = 0; b < bodies.size(); ++b) order.emplace_back(-enclosed_volume(bodies[b].surface), b);
  std::sort(order.begin(), order.end());
  std::vector<Body> sorted;
  for (const auto& [volume, b] : order) sorted.push_back(bodies[b]);
  return sorted;
}

/// The bodies by name if each is a single patch with a name, facing outward; else none. The larger ones first.
std::vector<Body> solids_of(const SurfaceMesh& surface) {
  if (!have_names(surface)) return {};
  const std::vector<Body> bodies = bodies_by_name(surface);
  const auto& names = surface.patch_names;
  for (const Body& body : bodies) {
    const bool is_named = std::find(names.begin(), names.end(), body.name) != names.end();
    if (!is_named || !body.surface.patch.empty() || !(enclosed_volume(body.surface) > 0)) return {};
  }
  return larger_first(bodies);
}

/// Triangles of one surface as bodies: each by the number of its body. Their faces know by `source` which they are.
std::vector<Body> shells_of(const SurfaceMesh& surface, const std::vector<std::uint32_t>& shell, std::size_t count) {
  std::vector<Body> shells(count);
  std::vector<std::uint32_t> last(surface.points.size(), kNone);
  std::vector<VertexIndex> vertex(surface.points.size(), kNone);
  Groups<> of_shell(count, [&](const auto& add) {
    for (std::uint32_t t = 0; t < shell.size(); ++t) add(shell[t], t);
  });
  for (std::uint32_t s = 0; s < count; ++s)
    for (const std::uint32_t t : of_shell[s]) {
      SurfaceMesh& made = shells[s].surface;
      Triangle triangle = surface.triangles[t];
      for (VertexIndex& v : triangle) {
        if (last[v] != s) {
          last[v] = s;
          vertex[v] = static_cast<VertexIndex>(made.points.size());
          made.points.push_back(surface.points[v]);
        }
        v = vertex[v];
      }
      made.triangles.push_back(triangle);
      made.source.push_back(t);
    }
  return shells;
}

/// More shells are dust, or a scene that nobody means as regions.
constexpr std::size_t kMostShells = 1000;

/// Shells by the vertices that they share; none if there are too many.
std::vector<Body> shells_by_vertices(const SurfaceMesh& surface) {
  DisjointSets sets(surface.points.size());
  for (const auto& [a, b, c] : surface.triangles) {
    sets.join(a, b);
    sets.join(a, c);
  }
  std::map<VertexIndex, std::uint32_t> number;
  std::vector<std::uint32_t> shell;
  for (const Triangle& t : surface.triangles) {
    shell.push_back(number.try_emplace(sets.find(t[0]), static_cast<std::uint32_t>(number.size())).first->second);
    if (number.size() > kMostShells) return {};
  }
  return shells_of(surface, shell, number.size());
}

/// Shells one after the other in the file, each closed before the next one begins, whatever vertices they share; none
/// if the last one stays open, or there are too many.
std::vector<Body> shells_in_order(const SurfaceMesh& surface) {
  std::unordered_map<std::uint64_t, int> ways;  // of each edge, by which it is open
  std::vector<std::uint32_t> shell;
  std::uint32_t count = 0;
  double volume = 0;
  for (const Triangle& t : surface.triangles) {
    shell.push_back(count);
    const auto& [a, b, c] = t;
    volume += dot(surface.points[a], cross(surface.points[b], surface.points[c]));
    for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}}) {
      const std::uint64_t key = static_cast<std::uint64_t>(std::min(p, q)) << 32 | std::max(p, q);
      if (const auto at = ways.try_emplace(key).first; (at->second += p < q ? 1 : -1) == 0) ways.erase(at);
    }
    // Two triangles back to back enclose nothing; what encloses a cavity comes behind it.
    if (!ways.empty() || !(volume > 0)) continue;
    volume = 0;
    if (++count > kMostShells) return {};
  }
  return volume == 0 && ways.empty() ? shells_of(surface, shell, count) : std::vector<Body>{};
}

/// Several, and none touches another.
bool are_apart(const std::vector<Body>& shells) {
  return shells.size() > 1 && std::ranges::all_of(shells, [](const Body& shell) {
           return is_closed_manifold(shell.surface.triangles, shell.surface.points.size());
         });
}

/// Shells if there are several, each closed by itself and facing outward; else none.
std::vector<Body> outward_shells(const SurfaceMesh& surface) {
  std::vector<Body> shells = shells_by_vertices(surface);
  if (!are_apart(shells)) shells = shells_in_order(surface);
  const bool sound = shells.size() > 1 &&
                     std::ranges::all_of(shells, [](const Body& shell) { return enclosed_volume(shell.surface) > 0; });
  return sound ? larger_first(shells) : std::vector<Body>{};
}

/// Bodies whose boxes are apart cannot touch.
bool boxes_meet(const std::vector<Body>& bodies, const MisfitLimits& limits) {
  std::vector<Box3> boxes;
  Box3 all;
  for (const Body& body : bodies) {
    boxes.push_back(bounding_box(body.surface.points));
    all.add(boxes.back());
  }
  const double margin = std::max(kTouching * all.diagonal(), limits.most());
  for (Box3& box : boxes) box = box.grown(margin);
  std::sort(boxes.begin(), boxes.end(), [](const Box3& a, const Box3& b) { return a.lo.x < b.lo.x; });
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].lo.x <= boxes[i].hi.x; ++j)
      if (boxes[i].overlaps(boxes[j])) return true;
  return false;
}

/// What is to be mended is no body yet.
bool cross_themselves(const std::vector<Body>& shells, const RunContext& context) {
  return std::ranges::any_of(shells, [&](const Body& shell) {
    return !self_intersections(shell.surface.points, shell.surface.triangles, 1, context).empty();
  });
}

bool has_interfaces(const SurfaceMesh& complex) {
  return std::any_of(complex.sides.begin(), complex.sides.end(),
                     [](const Sides& s) { return s[0] != kNone && s[1] != kNone; });
}

/// The complex of bodies if they touch or lie in each other, and none overlaps; what one of them says of itself is for
/// repair to hear.
std::optional<Complex> nested_or_touching(const std::vector<Body>& bodies, const ComplexOptions& options,
                                          const ElementsToCome& elements, const RunContext& context) {
  const bool asked = options.cells == ComplexOptions::Cells::kRegions;
  try {
    ComplexOptions inner_first = options;
    inner_first.overlap = ComplexOptions::Overlap::kLater;
    std::optional<Complex> joined = nested_bodies(bodies, inner_first, elements, context);
    if (joined && !asked && !has_interfaces(joined->surface)) return std::nullopt;
    return joined;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<Complex> complex_of_shells(const SurfaceMesh& surface, const ComplexOptions& options,
                                         const ElementsToCome& elements, const RunContext& context) {
  // Some formats have vertices of its own for each triangle.
  tidy::Draft draft{surface, {}, context};
  tidy::merge_vertices(draft);
  std::vector<Body> shells = outward_shells(draft.mesh);
  const MisfitLimits limits = limits_for(options, elements, shells);
  if (shells.empty() || !boxes_meet(shells, limits)) return std::nullopt;
  std::vector<std::uint32_t> shell_of(surface.triangles.size());
  for (std::uint32_t b = 0; b < shells.size(); ++b)
    for (const std::uint32_t t : shells[b].surface.source) shell_of[t] = b;
  const Misfits misfits({draft.mesh.points, draft.mesh.triangles, shell_of}, limits, context);
  // Walls that touch exactly, or are apart, make cells by themselves.
  if (!(misfits.largest() > 0) || cross_themselves(shells, context)) return std::nullopt;
  // A joined complex counts the faces of all bodies through.
  std::vector<std::uint32_t> face;
  for (Body& shell : shells) {
    face.insert(face.end(), shell.surface.source.begin(), shell.surface.source.end());
    shell.surface.source.clear();
  }
  std::optional<Complex> complex = nested_or_touching(shells, options, elements, context);
  if (!complex) return complex;
  SurfaceMesh& made = complex->surface;
  for (std::size_t t = 0; t < made.triangles.size(); ++t) {
    const std::uint32_t of = face[made.source[t]];
    made.patch[t] = surface.patch_of(of);
    made.source[t] = surface.source_of(of);
  }
  made.patch_names = surface.patch_names;
  made.patch_labels = surface.patch_labels;
  complex->notes.insert(complex->notes.begin(),
                        fmt::format("{} that touch or lie in each other are regions; `cells` merge makes them one",
                                    counted(shells.size(), "shell")));
  return complex;
}

std::optional<Complex> complex_of_solids(const SurfaceMesh& surface, const ComplexOptions& options,
                                         const ElementsToCome& elements, const RunContext& context) {
  const bool asked = options.cells == ComplexOptions::Cells::kRegions;
  const std::vector<Body> solids = solids_of(surface);
  if (solids.size() < 2 || (!asked && !boxes_meet(solids, limits_for(options, elements, solids)))) return std::nullopt;
  std::optional<Complex> complex = nested_or_touching(solids, options, elements, context);
  if (complex)
    complex->notes.insert(
        complex->notes.begin(),
        fmt::format("{} that touch or lie in each other are regions by their names; `cells` merge makes them one",
                    counted(solids.size(), "solid")));
  return complex;
}

}  // namespace octafront::cells
