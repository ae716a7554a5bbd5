#include "images/formulas/geometry.h"

#include <algorithm>
#include <utility>

namespace octafront::formulas {

FunctionGeometry::FunctionGeometry(std::shared_ptr<const SpaceFunction> function, Box3 box, double reach)
    : function_(std::move(function)), box_(box), reach_(reach), names_{"surface", "x_min", "x_max", "y_min",
                                                                       "y_max",   "z_min", "z_max"} {}

double FunctionGeometry::face_of(std::uint32_t patch) const {
  return (patch % 2 == 1 ? box_.lo : box_.hi)[axis_of(patch)];
}

std::optional<Vec3> FunctionGeometry::on_face(std::uint32_t patch, Vec3 p) const {
  if (patch >= kPatches) return std::nullopt;
  if (patch == kZeroSurface) return nearest_zero(*function_, p, 0, reach_);
  p[axis_of(patch)] = face_of(patch);
  return p;
}

std::optional<Vec3> FunctionGeometry::on_edge(std::span<const std::uint32_t> patches, Vec3 p) const {
  unsigned fixed = 0;
  bool is_on_zero = false;
  for (const std::uint32_t patch : patches) {
    if (patch >= kPatches) return std::nullopt;
    if (patch == kZeroSurface) {
      is_on_zero = true;
      continue;
    }
    const unsigned axis = 1u << axis_of(patch);
    if ((fixed & axis) != 0) return std::nullopt;  // opposite faces do not meet
    fixed |= axis;
    p[axis_of(patch)] = face_of(patch);
  }
  if (fixed == 0) return std::nullopt;
  return is_on_zero && fixed != 7 ? nearest_zero(*function_, p, fixed, reach_) : p;
}

bool FunctionGeometry::is_vertex(Vec3 p) const {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] != box_.lo[axis] && p[axis] != box_.hi[axis]) return false;
  return true;
}

std::uint32_t FunctionGeometry::patch_of(const std::array<Vec3, 3>& corners) const {
  for (std::uint32_t patch = kXMin; patch < kPatches; ++patch)
    if (std::ranges::all_of(corners, [&](Vec3 p) { return p[axis_of(patch)] == face_of(patch); })) return patch;
  return kZeroSurface;
}

}  // namespace octafront::formulas
