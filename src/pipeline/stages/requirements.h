#pragma once

#include <octafront/adapt.h>
#include <octafront/options.h>
#include <octafront/report.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace octafront {

// What of the input is narrow at a place: it forces the elements there.

struct NarrowPlace {
  double degrees = 0;  ///< of the wedge, or of the narrow thing as seen from one end of the element
  std::string words;   ///< what it is, and of which bodies: "walls of the input meet at 3 degrees, ..."
};

/// The narrowest wedge between walls, gap between them through a body, or line of the input within the size of an
/// element, where it is below 20 degrees; if triangles were `kept`, also their own angles. Looks at all triangles.
std::optional<NarrowPlace> narrow_place_at(const SurfaceMesh& input, const std::array<Vec3, 4>& element, bool kept);

// What a finished mesh must keep (Options::require), and what is least in it: looked at on the elements that are handed
// out, and said with the place.

bool requires_something(const RequireOptions& options);
/// Throws OptionError, with the reason, where a size is required that nobody asks for.
void refuse_sizes_required(const RequireOptions& options, const char* why);

/// Of all edges the one that is longest for the size wanted there.
struct LongestEdge {
  double ratio = 0;  ///< its length over the size at its middle
  Vec3 at;           ///< its middle
};
/// Nullopt where no size is required. Costs a look at the sizes for each edge of each element.
std::optional<LongestEdge> longest_edge(const TetMesh& mesh, const SizeField& sizes, const RequireOptions& options);
std::optional<LongestEdge> longest_edge(const MetricSummary& fit);

/// Throws RequirementError with all that the mesh does not keep, by a report that is complete.
void require_of(const TetMesh& mesh, const std::optional<LongestEdge>& longest, const RequireOptions& options,
                const Report& report);

/// Says how poor the least element is if no solver would like it: beta below .2, or a dihedral angle below 10 degrees.
/// `place`: what of the input is narrow at an element, by its number, if that is known.
using PlaceOfElement = std::function<std::optional<NarrowPlace>(std::uint64_t tet)>;
void note_least(const Report& report, const Stage& stage, const PlaceOfElement& place = {});

}  // namespace octafront
