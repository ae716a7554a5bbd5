#pragma once

#include "base/geometry/true_geometry.h"
#include "images/formulas/formulas.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace octafront::formulas {

/// The patches of a body by a function, in a box: the surface where it is 0, and the faces of the box.
enum Patch : std::uint32_t { kZeroSurface, kXMin, kXMax, kYMin, kYMax, kZMin, kZMax, kPatches };

/// The true geometry of that body.
class FunctionGeometry : public TrueGeometry {
 public:
  /// No place of the zero surface is farther than `reach` from where it is looked for.
  FunctionGeometry(std::shared_ptr<const SpaceFunction> function, Box3 box, double reach);

  std::optional<Vec3> on_face(std::uint32_t patch, Vec3 p) const override;
  std::optional<Vec3> on_edge(std::span<const std::uint32_t> patches, Vec3 p) const override;
  bool is_vertex(Vec3 p) const override;
  const std::vector<std::string>& patch_names() const override { return names_; }
  std::uint32_t part_at(std::uint32_t patch, Vec3) const override { return patch; }
  const std::vector<std::string>& part_names() const override { return names_; }
  std::uint32_t patch_of_part(std::uint32_t part) const override { return part; }
  const std::vector<PartGroup>& groups() const override { return groups_; }

  /// Per triangle the patch: a face of the box where all corners lie on it.
  std::uint32_t patch_of(const std::array<Vec3, 3>& corners) const;

 private:
  double face_of(std::uint32_t patch) const;
  static int axis_of(std::uint32_t patch) { return static_cast<int>((patch - 1) / 2); }

  std::shared_ptr<const SpaceFunction> function_;
  Box3 box_;
  double reach_;
  std::vector<std::string> names_;
  std::vector<PartGroup> groups_;
};

}  // namespace octafront::formulas
