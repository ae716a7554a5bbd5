#pragma once

// What is folded, crosses or deviates, made good place by place: folds taken off the input before
// the front (unfold), places mended at the end (mend_folds), triangles drawn to the input where they deviate
// (draw_to_input).

#include <octafront/run_context.h>

#include "base/geometry/leeway.h"
#include "base/geometry/triangle_tree.h"
#include "surface/edits/working_mesh.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace octafront::surface {

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

}  // namespace octafront::surface
