#pragma once

#include <octafront/run_context.h>

#include "base/geometry/leeway.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_table.h"
#include "surface/edits/deviation.h"
#include "surface/edits/working_mesh.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace octafront::surface {

// What is folded, crosses or deviates, made good place by place: folds taken off the input before
// the front (unfold), places mended at the end (mend_folds), triangles drawn to the input where they deviate
// (draw_to_input).

/// What counts as a fold or as a bad triangle, and how far the surface may move to be rid of it.
struct FoldLimits {
  double tolerance = 0;             ///< input units
  double size_part = 0;             ///< of the size at the place: what counts where that is less; 0: whatever the size
  double least_shape = 0;           ///< triangles below this 2r/R are bad too
  double crossing_part = 0;         ///< what crosses may move by this part of the size instead, if that is more
  double crossing_most = HUGE_VAL;  ///< but by no more than this, input units
  const Leeway* leeway = nullptr;   ///< no move is longer than that there; null: whatever it is
  double total = HUGE_VAL;          ///< what moves at one place add up to at most, input units
  bool keep_lines = false;          ///< feature lines are no folds, however sharp
  /// Triangles that cross others, one flag each, are bad too: edges of theirs are also divided; null: none.
  const std::vector<std::uint8_t>* crossing = nullptr;
  const TriangleTree* onto = nullptr;         ///< vertices that move are put on this surface; null: wherever they go
  const std::vector<std::uint8_t>& is_fixed;  ///< by vertex: stays; those beyond its end need not
  /// Of a complex, by triangle of `onto`: vertices stay on their own patch. Its seams must be fixed.
  const std::vector<std::uint32_t>* patch_of = nullptr;
  std::uint64_t most_judged = std::numeric_limits<std::uint64_t>::max();  ///< changes; no place is mended beyond that
};

struct MendedFolds {
  std::uint64_t operations = 0;  ///< flips, collapses and moves
  std::uint64_t judged = 0;      ///< changes that were considered, most of them in vain
  std::uint64_t folds_left = 0;  ///< edges that are as sharp still
  double largest_move = 0;       ///< what the moves at one place add up to at most
  std::vector<double> moved;     ///< that, per triangle of the working mesh
};

/// Takes away folds, flaps and spikes: edges at which the surface turns back on itself, by less than 25 degrees inside
/// or outside where that moves it by a quarter of what is allowed at most, by less than 15 degrees within the whole;
/// and bad triangles. What folds by less than 14 degrees, or crosses, may move by twice the part of the size, within
/// the tolerance. Edges turn and collapse and vertices move where that leaves less of both, exactly without new
/// crossings. Cost: O(n), and about a millisecond for each place.
MendedFolds mend_folds(WorkingMesh& mesh, const FoldLimits& limits, const RunContext& context);

/// A surface without its folds, and what that took.
struct Unfolded {
  SurfaceMesh surface;  ///< clean, of the same topology; patches and sources kept
  MendedFolds mended;   ///< `moved`: per triangle of `surface`
};

/// The input without folds, flaps and spikes that can be taken away within the tolerance in all (input units); see
/// mend_folds(). Patch borders stay. `edges` as make_edge_table() makes them. nullopt if nothing was done. Requires a
/// clean surface.
std::optional<Unfolded> unfold(const SurfaceMesh& surface, const EdgeTable& edges, double tolerance,
                               const RunContext& context);

/// No new triangle is worse than this 2r/R, unless one was: what is mended for its shape deviates again.
inline constexpr double kFairShape = 0.35;

/// Brings the mesh nearer to the input where the mesh deviates. Each place names a triangle of the mesh (by its number
/// there) and a point of the input. A triangle that faces as the input does at the point gets the point as a vertex:
/// inside, on one of its edges, or as the new place of its nearest corner. Where none of these is sound, an edge of the
/// triangle is halved, and its middle put on the input. No change makes new crossings, which is tested exactly.
///
/// Of several places at one triangle only the farthest counts, so the caller must look again for what still deviates.
/// `tree` is over the input's triangles. `is_fixed` says by vertex which ones stay; vertices beyond its end may move.
/// No new triangle has a 2r/R below `least_shape`, unless an old one had. Returns the number of points put in.
std::uint64_t draw_to_input(WorkingMesh& mesh, const InputSurface& input, const TriangleTree& tree,
                            const std::vector<std::uint8_t>& is_fixed, std::span<const FarPlace> places,
                            double least_shape = kFairShape);

}  // namespace octafront::surface
