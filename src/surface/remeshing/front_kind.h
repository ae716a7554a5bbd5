#pragma once

#include <octafront/size_field.h>

#include "base/core/function_ref.h"
#include "base/mesh/features.h"
#include "sizing/field/change_size_field.h"
#include "surface/edits/kept_places.h"
#include "surface/lines/line_sizes.h"
#include "surface/lines/seams.h"
#include "surface/remeshing/outcome.h"
#include "surface/remeshing/surface_check.h"

#include <memory>
#include <optional>
#include <string>
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

// The steps of a round in which single surfaces and complexes differ. One object is chosen before the first round.

/// Sizes around crossing triangles become this part of what they were ...
inline constexpr double kCap = 0.6;
/// ... but where they have fallen below this part of the first ones, size is not the reason: the input's own triangles
/// return within this many sizes.
inline constexpr double kVain = 0.3, kKeptRadius = 2;
/// Where all rounds together have made so many times the triangles of the last one, what crosses gets the input's
/// triangles at once.
inline constexpr double kPatience = 4;

class FrontKind {
 public:
  explicit FrontKind(FrontWork& work) : work_(work) {}
  virtual ~FrontKind() = default;
  FrontKind(const FrontKind&) = delete;
  FrontKind& operator=(const FrontKind&) = delete;

  /// What the front walks on, and the features of it.
  virtual InputSurface& input() = 0;
  virtual const Features& features() const = 0;
  virtual const StripRules& strips() const = 0;
  /// The sizes that are known before the first round to be needed.
  virtual void foresee(RoundSizes&) {}
  /// Smaller sizes where what is fixed asks for them.
  virtual SizeField fitted(const SizeField& in_strips, const std::vector<std::uint8_t>& is_fixed) const = 0;
  /// Divided; `is_fixed` may get more vertices.
  virtual std::vector<Curve> curves(const SizeField& sizes, std::vector<std::uint8_t>& is_fixed) = 0;
  /// What a mesh into which all points were inserted needs before anything else.
  virtual void settle_input(WorkingMesh&) const {}
  /// Makes good triangles of the draft, near to the input and clear of crossings as far as that goes.
  virtual void adjust(Draft&, const RoundSizes&) = 0;
  /// No triangles but the input's own follow it.
  virtual bool is_noise() const { return false; }

  /// What keeps the surface from being clean and of the input's kind, beside that it `crosses`; and where, if that is
  /// known.
  virtual std::optional<std::string> first_defect(const SurfaceMesh& made, bool crosses, std::vector<Vec3>& at) = 0;
  /// Smaller sizes at these places, or the input's triangles. `crosses`: what was found there.
  virtual void answer(const std::vector<Vec3>& places, const Outcome&, bool crosses, RoundSizes&) = 0;
  /// Makes the draft finer at these places, where it crosses itself or does not agree. False if it has no means to.
  virtual bool refine_at(const std::vector<Vec3>&, Draft&) { return false; }
  /// No other round is made for `far` places that deviate.
  virtual bool leaves_far(std::size_t far, const Outcome&) const = 0;
  /// Smaller sizes where the surface deviated.
  virtual void cap_far(const Nearness&, RoundSizes&) const = 0;
  virtual bool is_stuck() const { return false; }
  /// Whether the input's triangles are so long that none of them may move if all of them stay.
  virtual bool has_needles_kept() const { return false; }
  virtual void finish(Remeshed&, const Nearness&) const {}

 protected:
  /// Divides what is longer than the sizes of the draft ask for, and makes good triangles of it.
  void divide_long(Draft& draft);

  struct PlaceLimits {
    double tolerance = 0;             ///< input units
    double crossing_most = HUGE_VAL;  ///< see FoldLimits
    std::int64_t few_crossing = 0;    ///< sizes are too large where more cross
    const std::vector<std::uint32_t>* patch_of = nullptr;
  };
  /// What is left of bad triangles, of edges too sharp for any element, and of crossings where these are few. True if
  /// it is known that nothing crosses then. `clear`: whether it is known before.
  bool mend_places(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed, const PlaceLimits& limits, bool clear);

  const TriangleCorners& input_triangle_at(Vec3 p) const;
  /// Whether the input's triangle at p is as large as those that are wanted there.
  bool is_as_large(Vec3 p, const SizeField& sizes) const;
  /// In a single surface and in a complex alike.
  bool is_in_vain(Vec3 p, const RoundSizes& sizes) const;

  FrontWork& work_;
};

std::unique_ptr<FrontKind> make_plain_front(FrontWork& work);
std::unique_ptr<FrontKind> make_seamed_front(FrontWork& work);

/// At fewer triangles than this a mesh is mended anyway.
inline constexpr std::int64_t kFewCrossing = 300;

/// The longest edge of a triangle.
double longest_edge_of(const TriangleCorners& t);

}  // namespace octafront::surface
