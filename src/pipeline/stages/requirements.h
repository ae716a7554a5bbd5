#pragma once

// What a finished mesh must keep (Options::require), and what is least in it: looked at on the elements that are handed
// out, and said with the place.

#include <octafront/adapt.h>
#include <octafront/options.h>
#include <octafront/report.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "pipeline/stages/narrow_place.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace octafront {

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
