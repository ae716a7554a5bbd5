#pragma once

namespace octafront {

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
