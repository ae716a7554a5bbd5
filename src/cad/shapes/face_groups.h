#pragma once

#include "cad/model/cad_model.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront::cad {

/// Faces that are meshed as one patch.
struct FaceGroups {
  std::vector<std::uint32_t> group_of;  ///< per face of the model; kNone for one without triangles
  std::vector<std::string> names;       ///< per group: that of its largest face, made different from all others
};

/// Each face a group of its own, but for narrow ones: faces that an edge joins all along which both have the same
/// tangent plane are one where one of them is narrower than `size` or the edge shorter than a tenth of it, and they lie
/// between the same solids. So no line forces small elements where the surface is smooth. Without a size no width is
/// narrow. So are faces beside such an edge that runs into another one at a sharp angle, as where a fillet ends in a
/// cusp: the line would force flat elements. Faces at one of the places `apart` are one with such at the same place
/// alone; `unit`: of its radii, in the model's.
FaceGroups group_faces(const CadModel& model, std::optional<double> size, std::span<const std::string> apart = {},
                       double unit = 1);
/// Each face a group.
FaceGroups faces_as_they_are(const CadModel& model);

/// The faces at any of these places; ascending.
std::vector<std::uint32_t> faces_at(const CadModel& model, std::span<const std::string> places, double unit = 1);

/// The mean width of each face: twice its area over its perimeter; infinite where it has no edges.
std::vector<double> mean_widths(const CadModel& model);

/// What is smaller than this part of elements is tiny.
inline constexpr double kTinyOfSize = 0.1;

/// Faces and edges that are small against elements of a size: what a user may want to know before meshing.
struct TinyThings {
  std::size_t edges = 0, faces = 0, narrow_faces = 0;
  double shortest_edge = 0;
};
TinyThings tiny_things(const CadModel& model, double size);

}  // namespace octafront::cad
