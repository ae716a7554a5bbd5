#pragma once

#include <octafront/size_field.h>

#include "base/core/function_ref.h"
#include "sizing/field/change_size_field.h"
#include "surface/ground/kept_places.h"

#include <optional>
#include <vector>

namespace octafront::remeshing {

/// What becomes of a place where triangles cross: the input's own triangles return there, or they do not yet.
using ReturnAt = FunctionRef<std::optional<Ball>(Vec3)>;

/// The sizes from round to round: as they were asked, and smaller at places where that did not do.
class RoundSizes {
 public:
  /// Balls in which triangles of the input cross still become so many times as large.
  static constexpr double kGrowthOfBalls = 1.6;

  RoundSizes(const SizeField& first, const RunContext& context) : first_(first), now_(first), context_(context) {}

  const SizeField& first() const { return first_; }
  const SizeField& now() const { return now_; }
  /// Where the input's own triangles stay.
  const std::vector<Ball>& restored() const { return restored_; }

  /// Others in the place of those that were asked.
  void start_with(const SizeField& sizes) { first_ = now_ = sizes; }
  /// Smaller around the places by this factor.
  void cap(const std::vector<Vec3>& places, double factor);
  /// These sizes at most.
  void add(std::vector<PointSize> wanted, const CapShape& shape);
  /// All of them by this factor.
  void scale(double factor) { now_ = scaled(now_, factor, context_); }

  /// Smaller by `factor` around places that cross; where `returned` says that size is not the reason the input's own
  /// triangles return, in balls that grow where that does not help either: once for each place, or once in all.
  /// Where sizes were made smaller in vain the first ones hold again. Returns whether the input's triangles had
  /// returned at all places before.
  bool cap_or_restore(const std::vector<Vec3>& places, double factor, bool grow_once, ReturnAt returned);
  /// Whether a ball reaches within so many radii of p.
  bool is_restored_near(Vec3 p, double radii) const;

 private:
  /// Sizes made smaller at places.
  struct Caps {
    std::vector<PointSize> places;
    CapShape shape;
  };

  std::vector<Ball>::iterator restored_around(Vec3 p);
  void forget_caps();

  SizeField first_, now_;
  const RunContext& context_;
  std::vector<Caps> caps_;  ///< between the two
  std::vector<Ball> restored_;
};

}  // namespace octafront::remeshing
