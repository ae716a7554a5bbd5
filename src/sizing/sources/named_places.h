#pragma once

#include "base/mesh/known_surface.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace octafront {

/// The regions, patches and curves of a surface by their names. Refers to the surface.
class NamedPlaces {
 public:
  explicit NamedPlaces(const KnownSurface& surface);

  std::optional<std::uint32_t> region(const std::string& name) const;
  /// Its triangles; empty: there is no such patch.
  std::vector<std::uint32_t> patch(const std::string& name) const;
  /// Its edges; empty: there is no such curve.
  std::vector<Edge> curve(const std::string& name);
  /// Throws OptionError that lists names that there are.
  [[noreturn]] void refuse(const std::string& name) const;

 private:
  const KnownSurface& known_;
  const SurfaceMesh& surface_;
  std::set<std::string> names_;  ///< of curves those that were seen
};

}  // namespace octafront
