#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

#include "base/core/stage.h"
#include "sizing/field/expected_tets.h"
#include "sizing/sources/wanted_sizes.h"

namespace octafront {

struct SurfaceMesh;

/// How many elements sizes of our own choice come to at most, about: kBudget and kBudgetPerTriangle for each triangle
/// of the surface, kMostBudget at most, and what `max_size` makes by itself; known before anything is made. HUGE_VAL if
/// the user chose sizes.
double automatic_budget(const SurfaceMesh& surface, const SizeOptions& options);

/// The most that it may be, whatever the surface.
double most_automatic_budget(const SizeOptions& options);

/// A background grid of sizes of our own choice, which must not make a large mesh that nobody asked for, as the noise
/// of a scan does, or a thousand small holes: then the smallest sizes are raised until the number of elements is within
/// the budget.
SizeField within_budget(const SurfaceMesh& surface, const WantedSizes& wanted, const SizeOptions& options,
                        double budget, const Stage& stage);

/// Sizes that keep within a number of elements.
struct WithinCount {
  SizeField sizes;
  double asked = 0;  ///< elements by the sizes that were asked for
  double floor = 0;  ///< no size is below this; 0: nothing was raised
};

/// The sizes `finer` if they come to no more than `most` elements. Else its smallest sizes are raised to one floor, the
/// lowest that keeps to `most`, and nowhere above `first`: so what `finer` asks beyond `first` is granted as far as the
/// budget goes.
WithinCount within_count(const SizeField& finer, const SizeField& first, const TetPrediction& expected, double most,
                         const RunContext& context);

}  // namespace octafront
