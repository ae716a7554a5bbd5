#pragma once

#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "base/mesh/known_surface.h"
#include "surface/edits/walk.h"
#include "surface/lines/curves.h"
#include "surface/lines/seams.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace octafront::surface {

/// What details of a surface may ask for at least: a size for all of it, and less on shells of a complex (pieces of
/// regions, holes in them) that are too small for elements of that size. Refers to the surface.
class LeastSizes {
 public:
  /// `least` in input units; 0: there is no such limit.
  LeastSizes(const KnownSurface& known, double least);

  double at(Vec3 p) const;
  /// Places on shells that would be lost among elements of these sizes, and the sizes that keep them. None without a
  /// limit.
  std::vector<PointSize> small_shells(const SizeField& sizes) const;

 private:
  const KnownSurface& known_;
  double least_;
  std::vector<double> of_triangle_;  ///< empty: `least_` holds everywhere
};

/// Of places within half a size of each other the first one.
std::vector<Vec3> thinned(const SizeField& sizes, const std::vector<Vec3>& places);

/// At thinned() places this part of the size.
std::vector<PointSize> smaller_at(const std::vector<Vec3>& places, double part, const SizeField& sizes);

/// Of places within their size of each other that of the smallest size, by size.
std::vector<PointSize> smallest_ones(std::vector<PointSize> places);

/// The sizes, made smaller where the curves of a complex ask for that. Around a corner the size is at most the distance
/// to the next corner, and to the nearest curve that does not end at this corner; on a closed curve it is at most a
/// sixth of the curve's length. Where walls leave tiny edges, as in a foam, no vertex may move, and elements of the
/// wanted size would be flat. Away from such places sizes rise steeply. None falls below `least`. `is_fixed` as of
/// chained_curves().
SizeField fitted_to_corners(const InputSurface& input, const SeamedSurface& seamed, std::vector<std::uint8_t> is_fixed,
                            const SizeField& sizes, const LeastSizes& least, const RunContext& context);

/// Places where triangles of the wanted size would deviate from the input by more than `tolerance`, and the size by
/// which they would not: of triangles no larger than the part of the patch around the place that stays between two
/// planes about so far apart, and of edges along a curve no longer than the part of it that stays as near to its chord.
/// Of places within their size of each other that of the smallest one. What is finer than the input's own triangles is
/// not asked for, and nothing where 600 of these are flat together. A place speaks for what is within a quarter of its
/// patch's radius. Cost: O(n), at most 10 us for each triangle of the input.
std::vector<PointSize> sizes_by_flatness(const InputSurface& input, const std::vector<Curve>& curves,
                                         const SizeField& sizes, double tolerance, const RunContext& context);

// Smaller sizes that the surface itself asks for: strips between lines (narrow_strips), corners of
// complexes (corner_sizes), patches that are not as flat as their elements (flat_sizes). Takes the input and its
// curves, leaves sizes.

/// What a strip is, and what becomes of sizes there.
struct StripRules {
  double size_per_width;  ///< size wanted in a strip, in widths of it
  double parallel;        ///< cosine between the lines of a strip: those that part at a corner are none
  double floor;           ///< no size falls below this part of what it was
  double hopeless;        ///< strips narrower than this part of the size stay bad even so
  double gradation = 0;   ///< from strips sizes may rise so fast, or as fast as elsewhere if that is faster
  double least = 0;       ///< no size falls below this, input units
  double narrowest = 0;   ///< strips narrower than this stay as they come, input units
};
/// Triangles of 1.5 widths between the lines have 2r/R of .94. (At 2 widths models full of strips lose .01 of their
/// mean; at 1.2 they gain .005 and have a third more triangles.) The lines differ by 12 degrees at most.
inline constexpr StripRules kStrips{.size_per_width = 1.5, .parallel = 0.978, .floor = 0.3, .hopeless = 0.08};
/// Of single surfaces lines that are nearer may merge; of a complex nothing may move, and walls as narrow as one likes
/// are common: triangles of 2r/R .83 shall do, and 8 degrees.
inline constexpr StripRules kStripsOfWalls{
    .size_per_width = 2, .parallel = 0.99, .floor = 0.1, .hopeless = 0.02, .gradation = 0.7};

/// The sizes made smaller in narrow strips: where two feature lines run side by side, nearer to each other than about
/// half an element, triangles between them can be well shaped only if the lines are divided finer. Needs `input` with
/// feature marks. Empty where there is no such strip.
std::optional<SizeField> fitted_to_strips(const InputSurface& input, const SizeField& sizes, const StripRules& rules,
                                          const RunContext& context);

}  // namespace octafront::surface
