#include "periodic/periodic_cell.h"

#include <octafront/error.h>

#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "periodic/face_names.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Coordinates of low faces have so many bits behind those of the largest one; rounding spoils some of the last seven.
constexpr int kBitsOfGrid = 44;
/// Vertices of a face lie no farther from it than this part of the largest coordinate.
constexpr double kNearFace = 1e-10;

/// A place is carried to a copy by so many periods at most: to the opposite corner of a cell.
constexpr int kMostSteps = 3;
constexpr Vec3 kNowhere{HUGE_VAL, HUGE_VAL, HUGE_VAL};

std::array<Vec3, 3> corners_at(const SurfaceMesh& surface, std::size_t t) {
  const auto [a, b, c] = surface.triangles[t];
  return {surface.points[a], surface.points[b], surface.points[c]};
}

}  // namespace

std::array<bool, 3> axes_named(std::string_view option, std::string_view axes) {
  std::array<bool, 3> named{};
  for (const char c : axes) {
    const auto at = std::find(kAxisNames.begin(), kAxisNames.end(), c) - kAxisNames.begin();
    if (at == 3 || named[at])
      throw OptionError(
          fmt::format("`{}` is \"{}\": name axes by x, y and z, each once, such as x or xyz", option, axes));
    named[at] = true;
  }
  return named;
}

PeriodicCell cell_of(Box3 box, const std::array<bool, 3>& along) {
  for (int axis = 0; axis < 3; ++axis) {
    // Settles at once: the period that is rounded leads to a high end that gives the same period again.
    for (int k = 0; k < 4 && along[axis]; ++k) box.hi[axis] = box.lo[axis] + (box.hi[axis] - box.lo[axis]);
  }
  return {box, along};
}

Vec3 put_on_faces(Vec3 p, const Box3& box, const std::array<bool, 3>& along, Vec3 within) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double face : {box.lo[axis], box.hi[axis]})
      if (along[axis] && std::abs(p[axis] - face) <= within[axis]) p[axis] = face;
  return p;
}

PeriodicCell mapped_cell(const std::vector<PeriodicMap>& maps, double largest) {
  PeriodicCell cell;
  cell.grid = std::ldexp(1.0, std::ilogb(largest) + 1 - kBitsOfGrid);
  for (const PeriodicMap& map : maps)
    // A translation from grid to grid is exact, and several lead to the same place in any order.
    cell.mapped.push_back({map.turns() ? map : PeriodicMap::translation(cell.on_grid(map.shift()))});
  return cell;
}

Vec3 PeriodicCell::on_grid(Vec3 p) const {
  if (grid == 0) return p;
  return {std::round(p.x / grid) * grid, std::round(p.y / grid) * grid, std::round(p.z / grid) * grid};
}

Vec3 PeriodicCell::to_high(Vec3 p, int period) const {
  if (!is_box()) return mapped[static_cast<std::size_t>(period)].map.apply(p);
  p[period] = box.hi[period];
  return p;
}

Vec3 PeriodicCell::to_low(Vec3 p, int period) const {
  if (!is_box()) return on_grid(mapped[static_cast<std::size_t>(period)].map.undo(p));
  p[period] = box.lo[period];
  return p;
}

bool PeriodicCell::is_mapped(Vec3 p, int period) const {
  return to_high(to_low(p, period), period) == p;
}

bool PeriodicCell::is_near_face(Vec3 p, int period, int end) const {
  const auto& tree = mapped[static_cast<std::size_t>(period)].on[static_cast<std::size_t>(end)];
  return tree && tree->is_within(p, std::ldexp(grid, kBitsOfGrid) * kNearFace);
}

Vec3 PeriodicCell::carried(Vec3 p, Vec3 from, Vec3 to) const {
  if (!is_box()) {
    for (int steps = 0; steps <= kMostSteps; ++steps)
      if (const std::optional<Vec3> found = carried_by(p, from, to, steps)) return *found;
    return kNowhere;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (from[axis] == to[axis]) continue;
    if (p[axis] != from[axis]) return kNowhere;
    p[axis] = to[axis];
  }
  return p;
}

std::optional<Vec3> PeriodicCell::carried_by(Vec3 p, Vec3 from, Vec3 to, int steps) const {
  if (steps == 0) return from == to ? std::optional(p) : std::nullopt;
  for (int k = 0; k < periods(); ++k) {
    std::optional<Vec3> found;
    if (is_high(p, k) && is_high(from, k)) found = carried_by(to_low(p, k), to_low(from, k), to, steps - 1);
    if (!found && is_low(p, k) && is_low(from, k)) found = carried_by(to_high(p, k), to_high(from, k), to, steps - 1);
    if (found) return found;
  }
  return std::nullopt;
}

Vec3 PeriodicCell::settled(Vec3 p, Vec3 a, Vec3 b) const {
  if (is_box()) return p;
  std::vector<int> by;
  for (int k = 0; k < periods(); ++k) {
    if (!is_high(a, k) || !is_high(b, k)) continue;
    p = mapped[static_cast<std::size_t>(k)].map.undo(p), a = to_low(a, k), b = to_low(b, k);
    by.push_back(k);
  }
  p = on_grid(p);
  for (auto k = by.rbegin(); k != by.rend(); ++k) p = to_high(p, *k);
  return p;
}

std::vector<int> PeriodicCell::periods_there() const {
  std::vector<int> there;
  for (int k = 0; k < periods(); ++k)
    if (has(k)) there.push_back(k);
  return there;
}

std::string PeriodicCell::name_of_period(int period) const {
  return is_box() ? std::string(1, kAxisNames[static_cast<std::size_t>(period)]) : fmt::format("period {}", period + 1);
}

CellFace face_of_cell(const PeriodicCell& cell, Vec3 a, Vec3 b, Vec3 c) {
  for (int k = 0; k < cell.periods(); ++k)
    for (CellFace end = 0; end < 2; ++end) {
      const auto is_on = [&](Vec3 p) { return end == 0 ? cell.is_low(p, k) : cell.is_high(p, k); };
      if (!is_on(a) || !is_on(b) || !is_on(c)) continue;
      // All corners of a triangle beside a curved face may lie on the line where it ends.
      if (cell.is_box() || cell.is_near_face(centroid(a, b, c), k, static_cast<int>(end)))
        return 2 * static_cast<CellFace>(k) + end;
    }
  return kNone;
}

CellFace face_of_cell(const PeriodicCell& cell, std::uint32_t patch, Vec3 a, Vec3 b, Vec3 c) {
  if (cell.is_box()) return face_of_cell(cell, a, b, c);
  return patch < cell.face_of_patch.size() ? cell.face_of_patch[patch] : kNone;
}

void find_faces_of_patches(const SurfaceMesh& surface, PeriodicCell& cell) {
  if (cell.is_box()) return;
  cell.face_of_patch.clear();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::array<Vec3, 3> at = corners_at(surface, t);
    const std::uint32_t patch = surface.patch_of(t);
    if (patch >= cell.face_of_patch.size()) cell.face_of_patch.resize(patch + 1, kNone);
    if (const CellFace face = face_of_cell(cell, at[0], at[1], at[2]); face != kNone) cell.face_of_patch[patch] = face;
  }
}

std::vector<VertexIndex> vertices_on_faces(const SurfaceMesh& surface, const PeriodicCell& cell) {
  std::vector<VertexIndex> found;
  if (!cell.is_periodic()) return found;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [p, q, r] = corners_at(surface, t);
    const Triangle& on = surface.triangles[t];
    if (face_of_cell(cell, surface.patch_of(t), p, q, r) != kNone) found.insert(found.end(), on.begin(), on.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

PeriodicFaces find_periodic_faces(const SurfaceMesh& surface, const PeriodicCell& cell) {
  PeriodicFaces faces{cell, {}, {}, {}, {}, {}};
  if (!cell.is_periodic()) return faces;
  const std::size_t count = surface.triangles.size();
  faces.face.resize(count), faces.other.assign(count, kNone);
  std::vector<std::map<std::array<PlaceKey, 3>, std::uint32_t>> low(static_cast<std::size_t>(cell.periods()));
  std::uint32_t patches = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::array<Vec3, 3> corners = corners_at(surface, t);
    faces.face[t] = face_of_cell(cell, corners[0], corners[1], corners[2]);
    patches = std::max(patches, surface.patch_of(t) + 1);
    if (faces.face[t] != kNone && faces.face[t] % 2 == 0) low[faces.face[t] / 2].emplace(keys_of(corners), t);
  }
  faces.copy_of_patch.assign(patches, kNone), faces.is_copied.assign(patches, 0);
  faces.face_of_patch.assign(patches, kNone);
  for (std::uint32_t t = 0; t < count; ++t) {
    if (faces.face[t] == kNone) continue;
    faces.face_of_patch[surface.patch_of(t)] = faces.face[t];
    if (faces.face[t] % 2 == 0) continue;
    const std::uint32_t period = faces.face[t] / 2;
    std::array<Vec3, 3> corners = corners_at(surface, t);
    for (Vec3& p : corners) p = cell.to_low(p, static_cast<int>(period));
    const auto at = low[period].find(keys_of(corners));
    if (at == low[period].end()) continue;
    faces.other[t] = at->second, faces.other[at->second] = t;
    faces.copy_of_patch[surface.patch_of(at->second)] = surface.patch_of(t);
    faces.is_copied[surface.patch_of(t)] = 1;
  }
  for (std::uint32_t t = 0; t < count; ++t)
    if (faces.face[t] != kNone && faces.other[t] == kNone) {
      const std::array<Vec3, 3> at = corners_at(surface, t);
      throw MeshingError(fmt::format("a triangle of the face {} at {} has no copy on the opposite face",
                                     name_of_face(cell, faces.face[t]), at_point(at[0])));
    }
  return faces;
}

}  // namespace octafront
