#pragma once

#include "base/geometry/true_geometry.h"

#include <string>
#include <utility>
#include <vector>

namespace octafront::testing {

/// A geometry whose patches are its parts, in no groups.
class PartsByPatch : public TrueGeometry {
 public:
  explicit PartsByPatch(std::vector<std::string> names) : names_(std::move(names)) {}
  const std::vector<std::string>& patch_names() const override { return names_; }
  std::uint32_t part_at(std::uint32_t patch, Vec3) const override { return patch; }
  const std::vector<std::string>& part_names() const override { return names_; }
  std::uint32_t patch_of_part(std::uint32_t part) const override { return part; }
  const std::vector<PartGroup>& groups() const override { return groups_; }

 private:
  std::vector<std::string> names_;
  std::vector<PartGroup> groups_;
};

}  // namespace octafront::testing
