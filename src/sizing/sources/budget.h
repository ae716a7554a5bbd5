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

/// Looks for the factor on sizes that makes a wanted number of elements. Whoever looks tries factor(), tells the search
/// what came out, and steps on, until the number is near enough or stands still.
///
/// Counts and factors are logarithms inside. The slope of one over the other is -3 where the volume decides, and nearer
/// to 0 where gradation or details of the surface do.
class CountSearch {
 public:
  /// `scale`: the logarithm of the first factor.
  explicit CountSearch(double wanted, double scale = 0);

  double factor() const;
  void came_out(double count);

  /// To the next factor by the counts so far: by the slope between the last two; once one was above and one below, to
  /// between the nearest such two, or to their middle where the last two were on one side.
  void step();
  /// To the next factor by a slope that the caller knows.
  void step(double slope) { scale_ += missing() / slope; }
  /// The slope from one scale and count to another, within what is plausible.
  static double slope_between(double scale_change, double count_change);

  /// What the last count lacks: negative where it was above.
  double missing() const { return wanted_ - last_.count; }
  /// How far the best count is off.
  double least_miss() const { return least_miss_; }
  /// Whether the last count is nearer than all before.
  bool is_best() const { return is_best_; }
  /// Whether the count would have had to change by the last two steps, and did not: limits and details decide, not the
  /// sizes.
  bool stands_still() const;

 private:
  struct Point {
    double scale = 0, count = 0;
    bool is_known = false;
  };
  void step_beyond();
  bool did_nothing() const;
  bool is_above(const Point& point) const { return point.count > wanted_; }

  double wanted_, scale_, slope_, least_miss_;
  bool is_best_ = false;
  int still_ = 0;  ///< steps in turn that changed nothing
  Point before_, last_, above_, below_;
};

}  // namespace octafront
