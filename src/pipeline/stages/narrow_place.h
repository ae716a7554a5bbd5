#pragma once

// What of the input is narrow at a place: it forces the elements there.

#include <octafront/surface_mesh.h>

#include <array>
#include <optional>
#include <string>

namespace octafront {

struct NarrowPlace {
  double degrees = 0;  ///< of the wedge, or of the narrow thing as seen from one end of the element
  std::string words;   ///< what it is, and of which bodies: "walls of the input meet at 3 degrees, ..."
};

/// The narrowest wedge between walls, gap between them through a body, or line of the input within the size of an
/// element, where it is below 20 degrees; if triangles were `kept`, also their own angles. Looks at all triangles.
std::optional<NarrowPlace> narrow_place_at(const SurfaceMesh& input, const std::array<Vec3, 4>& element, bool kept);

}  // namespace octafront
