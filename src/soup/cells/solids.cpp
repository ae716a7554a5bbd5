// Solids by name in one file, such as those of an STL file with several.

#include "base/core/wording.h"
#include "soup/cells/bodies.h"

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

/// The bodies by name if each is a single patch with a name, facing outward; else none. The larger ones first: what
/// lies in another one comes behind it, and cuts it out.
std::vector<Body> solids_of(const SurfaceMesh& surface) {
  if (!have_names(surface)) return {};
  std::vector<Body> bodies = bodies_by_name(surface);
  const auto& names = surface.patch_names;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const bool is_named = std::find(names.begin(), names.end(), bodies[b].name) != names.end();
    const double volume = enclosed_volume(bodies[b].surface);
    if (!is_named || !bodies[b].surface.patch.empty() || !(volume > 0)) return {};
    order.emplace_back(-volume, b);
  }
  std::sort(order.begin(), order.end());
  std::vector<Body> sorted;
  for (const auto& [volume, b] : order) sorted.push_back(std::move(bodies[b]));
  return sorted;
}

/// Bodies whose boxes are apart cannot touch.
bool boxes_meet(const std::vector<Body>& bodies) {
  std::vector<Box3> boxes;
  Box3 all;
  for (const Body& body : bodies) {
    boxes.push_back(bounding_box(body.surface.points));
    all.add(boxes.back());
  }
  const double margin = kTouching * all.diagonal();
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

}  // namespace

std::optional<Complex> complex_of_solids(const SurfaceMesh& surface, const ComplexOptions& options,
                                         const RunContext& context) {
  const bool asked = options.cells == ComplexOptions::Cells::kRegions;
  const std::vector<Body> solids = solids_of(surface);
  if (solids.size() < 2 || (!asked && !boxes_meet(solids))) return std::nullopt;
  try {
    ComplexOptions inner_first = options;
    inner_first.overlap = ComplexOptions::Overlap::kLater;
    Joined joined = joined_bodies(solids, inner_first, context);
    if (!joined.nested || (!asked && !has_interfaces(joined.complex.surface))) return std::nullopt;
    joined.complex.notes.insert(
        joined.complex.notes.begin(),
        fmt::format("{} that touch or lie in each other are regions by their names; `cells` merge makes them one",
                    counted(solids.size(), "solid")));
    return std::move(joined.complex);
  } catch (const InputError&) {
    // A solid that is not clean by itself, or covered by others: what is wrong is for repair to say.
    return std::nullopt;
  }
}

}  // namespace octafront::cells
