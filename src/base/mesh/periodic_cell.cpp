#include "base/mesh/periodic_cell.h"

#include <octafront/error.h>

#include <algorithm>
#include <map>
#include <string>

#include <fmt/core.h>

namespace octafront {

namespace {

using CornerPlaces = std::array<std::array<double, 3>, 3>;

/// The corners of a triangle in an order of their own.
CornerPlaces places_of(std::array<Vec3, 3> corners) {
  CornerPlaces places{};
  for (int i = 0; i < 3; ++i) places[i] = {corners[i].x, corners[i].y, corners[i].z};
  std::sort(places.begin(), places.end());
  return places;
}

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

std::string name_of_face(CellFace face) {
  return fmt::format("{}_{}", kAxisNames[face / 2], face % 2 == 0 ? "min" : "max");
}

CellFace face_of_cell(const PeriodicCell& cell, Vec3 a, Vec3 b, Vec3 c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (cell.is_low(a, axis) && cell.is_low(b, axis) && cell.is_low(c, axis)) return 2 * static_cast<CellFace>(axis);
    if (cell.is_high(a, axis) && cell.is_high(b, axis) && cell.is_high(c, axis))
      return 2 * static_cast<CellFace>(axis) + 1;
  }
  return kNone;
}

PeriodicFaces find_periodic_faces(const SurfaceMesh& surface, const PeriodicCell& cell) {
  PeriodicFaces faces{cell, {}, {}, {}, {}};
  if (!cell.is_periodic()) return faces;
  const std::size_t count = surface.triangles.size();
  faces.face.resize(count), faces.other.assign(count, kNone);
  std::array<std::map<CornerPlaces, std::uint32_t>, 3> low;
  std::uint32_t patches = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::array<Vec3, 3> corners = corners_at(surface, t);
    faces.face[t] = face_of_cell(cell, corners[0], corners[1], corners[2]);
    patches = std::max(patches, surface.patch_of(t) + 1);
    if (faces.face[t] != kNone && faces.face[t] % 2 == 0) low[faces.face[t] / 2].emplace(places_of(corners), t);
  }
  faces.copy_of_patch.assign(patches, kNone), faces.is_copied.assign(patches, 0);
  for (std::uint32_t t = 0; t < count; ++t) {
    if (faces.face[t] == kNone || faces.face[t] % 2 == 0) continue;
    const auto axis = static_cast<int>(faces.face[t] / 2);
    std::array<Vec3, 3> corners = corners_at(surface, t);
    for (Vec3& p : corners) p[axis] = cell.box.lo[axis];
    const auto at = low[axis].find(places_of(corners));
    if (at == low[axis].end()) continue;
    faces.other[t] = at->second, faces.other[at->second] = t;
    faces.copy_of_patch[surface.patch_of(at->second)] = surface.patch_of(t);
    faces.is_copied[surface.patch_of(t)] = 1;
  }
  for (std::uint32_t t = 0; t < count; ++t)
    if (faces.face[t] != kNone && faces.other[t] == kNone) {
      const std::array<Vec3, 3> at = corners_at(surface, t);
      throw MeshingError(
          fmt::format("a triangle of the face {} at ({:.6g}, {:.6g}, {:.6g}) has no copy on the opposite face",
                      name_of_face(faces.face[t]), at[0].x, at[0].y, at[0].z));
    }
  return faces;
}

}  // namespace octafront
