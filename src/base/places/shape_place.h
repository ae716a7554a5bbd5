#pragma once

// Places by what something is like, "largest plane at z min", as far as the words go: what is meant by them is for who
// knows the geometry (base/geometry/true_geometry.h).

#include <optional>
#include <string>

namespace octafront {

/// [largest|smallest] KIND [of radius R] [of NAME] [at x|y|z min|max], each kind in the singular or the plural.
struct ShapePlace {
  enum class Kind {
    kFaces,
    kPlanes,
    kCylinders,
    kCones,
    kSpheres,
    kTori,
    kFreeFaces,
    kEdges,
    kLines,
    kCircles,
    kPoints
  };
  enum class Which { kAll, kLargest, kSmallest };

  Kind kind = Kind::kFaces;
  Which which = Which::kAll;
  std::optional<double> radius;  ///< of cylinders, spheres and circles; of tori that of the ring's cross section
  std::string of;                ///< the name of what it lies on; empty: anywhere
  std::optional<int> axis;       ///< at one end of this axis
  bool at_max = false;

  bool is_of_faces() const { return kind <= Kind::kFreeFaces; }
};

/// Nothing for a text that is no such place.
std::optional<ShapePlace> shape_place_of(const std::string& text);

}  // namespace octafront
