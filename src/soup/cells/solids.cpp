// Solids by name in one file, such as those of an STL file with several.

#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/mesh/surface_topology.h"
#include "soup/cells/bodies.h"
#include "soup/cells/misfit.h"

#include <algorithm>
#include <map>
#include <string>
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

/// Shells by the vertices that they share if there are several, each closed by itself and facing outward; else none.
/// Their faces know by `source` which of the surface they are.
std::vector<Body> outward_shells(const SurfaceMesh& surface) {
  // More of them are dust, or a scene that nobody means as regions.
  constexpr std::size_t kMostShells = 1000;
  DisjointSets sets(surface.points.size());
  for (const auto& [a, b, c] : surface.triangles) {
    sets.join(a, b);
    sets.join(a, c);
  }
  std::map<VertexIndex, std::size_t> number;
  std::vector<Body> shells;
  std::vector<VertexIndex> vertex(surface.points.size(), kNone);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [at, is_new] = number.try_emplace(sets.find(surface.triangles[t][0]), shells.size());
    if (is_new && shells.size() == kMostShells) return {};
    if (is_new) shells.emplace_back();
    SurfaceMesh& shell = shells[at->second].surface;
    Triangle triangle = surface.triangles[t];
    for (VertexIndex& v : triangle) {
      if (vertex[v] == kNone) {
        vertex[v] = static_cast<VertexIndex>(shell.points.size());
        shell.points.push_back(surface.points[v]);
      }
      v = vertex[v];
    }
    shell.triangles.push_back(triangle);
    shell.source.push_back(t);
  }
  const bool sound = shells.size() > 1 && std::all_of(shells.begin(), shells.end(), [](const Body& shell) {
                       const SurfaceMesh& s = shell.surface;
                       return is_closed_manifold(s.triangles, s.points.size()) && enclosed_volume(s) > 0;
                     });
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
  for (Box3& box : boxes) box = {box.lo - Vec3{margin, margin, margin}, box.hi + Vec3{margin, margin, margin}};
  std::sort(boxes.begin(), boxes.end(), [](const Box3& a, const Box3& b) { return a.lo.x < b.lo.x; });
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].lo.x <= boxes[i].hi.x; ++j)
      if (boxes[i].overlaps(boxes[j])) return true;
  return false;
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
    Joined joined = joined_bodies(bodies, inner_first, elements, context);
    if (!joined.nested || (!asked && !has_interfaces(joined.complex.surface))) return std::nullopt;
    return std::move(joined.complex);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<Complex> complex_of_shells(const SurfaceMesh& surface, const ComplexOptions& options,
                                         const ElementsToCome& elements, const RunContext& context) {
  std::vector<Body> shells = outward_shells(surface);
  const MisfitLimits limits = limits_for(options, elements, shells);
  if (shells.empty() || !boxes_meet(shells, limits)) return std::nullopt;
  std::vector<std::uint32_t> shell_of(surface.triangles.size());
  for (std::uint32_t b = 0; b < shells.size(); ++b)
    for (const std::uint32_t t : shells[b].surface.source) shell_of[t] = b;
  const Misfits misfits({surface.points, surface.triangles, shell_of}, limits, context);
  // Walls that touch exactly, or are apart, make cells by themselves.
  if (!(misfits.largest() > 0)) return std::nullopt;
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
