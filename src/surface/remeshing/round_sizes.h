#pragma once

#include <octafront/size_field.h>

#include "base/core/function_ref.h"
#include "sizing/field/change_size_field.h"
#include "surface/edits/kept_places.h"

#include <optional>
#include <vector>

namespace octafront::surface {

/// Asked of a place where triangles cross: the ball around it in which the input's own triangles return, or nothing
/// while smaller sizes may still help.
using KeepAt = FunctionRef<std::optional<KeptPlace>(Vec3)>;

/// The sizes from round to round: as they were asked, and smaller at places where that did not do.
class RoundSizes {
 public:
  /// A ball in which triangles still cross becomes so many times as large.
  static constexpr double kGrowthOfKeptPlaces = 1.6;

  RoundSizes(const SizeField& first, const RunContext& context) : first_(first), now_(first), context_(context) {}

  const SizeField& first() const { return first_; }
  const SizeField& now() const { return now_; }
  /// Where the input's own triangles stay.
  const std::vector<KeptPlace>& kept_places() const { return kept_places_; }

  /// These sizes take the place of those that were asked for.
  void start_with(const SizeField& sizes) { first_ = now_ = sizes; }
  /// Smaller around the places by this factor.
  void cap(const std::vector<Vec3>& places, double factor);
  /// These sizes at most.
  void add(std::vector<PointSize> wanted, const CapShape& shape);
  /// All of them by this factor.
  void scale(double factor) { now_ = scaled(now_, factor, context_); }

  /// Makes sizes smaller by `factor` around places where triangles cross. Where `returned` gives a ball, the input's
  /// own triangles return in it instead, and sizes that were made smaller there in vain are as they first were. A place
  /// inside a ball of an earlier round makes that ball grow: for each such place, or once a round with `grow_once`.
  /// Returns whether all places were inside balls of earlier rounds.
  bool cap_or_keep(const std::vector<Vec3>& places, double factor, bool grow_once, KeepAt returned);
  /// Whether a ball reaches within so many radii of p.
  bool is_kept_near(Vec3 p, double radii) const;

 private:
  /// Sizes made smaller at places.
  struct Caps {
    std::vector<PointSize> places;
    CapShape shape;
  };

  std::vector<KeptPlace>::iterator kept_place_around(Vec3 p);
  void forget_caps();

  SizeField first_, now_;
  const RunContext& context_;
  std::vector<Caps> caps_;  ///< between the two
  std::vector<KeptPlace> kept_places_;
};

}  // namespace octafront::surface
