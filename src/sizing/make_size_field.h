#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>

#include "base/core/stage.h"
#include "base/mesh/known_surface.h"

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace octafront {

/// What holds of single triangles of a surface, on top of SizeOptions.
struct FaceRules {
  std::span<const double> chord_errors = {};  ///< SizeOptions::chord_error; infinity: nothing; empty: so everywhere
  /// Not 0: nobody knows how the surface bends there, so it asks for no size. Empty: so nowhere.
  std::span<const std::uint8_t> is_invented = {};
};

/// Builds the octree background grid from the sources of `options` on a clean surface: 2:1 balanced, sizes at leaf
/// corners, graded, continuous inside leaves. Throws OptionError for contradictions and values out of range.
/// With options.elements the sizes are scaled until expected_tets() meets it. `budget`: elements that
/// sizes of our own choice come to at most.
SizeField make_size_field(const KnownSurface& surface, const SizeOptions& options, const Stage& stage,
                          const FaceRules& rules = {}, double budget = HUGE_VAL);

/// Says which regions and points of `options` lie outside of the model's box, and how much of the surface a field does
/// not cover. Throws OptionError for a field that covers none of it.
void note_misplaced_sizes(const SurfaceMesh& surface, const SizeOptions& options, const Stage& stage);

/// How many elements sizes of our own choice come to at most, about: kBudget and kBudgetPerTriangle for each triangle
/// of the surface, kMostBudget at most, and what `max_size` makes by itself; known before anything is made. HUGE_VAL if
/// the user chose sizes.
double automatic_budget(const SurfaceMesh& surface, const SizeOptions& options);

/// The part of its volume that a surface made by these sizes loses, by its curvature: chords cut it off.
double predicted_volume_loss(const KnownSurface& surface, const SizeField& sizes, const RunContext& context);

/// Throws OptionError if triangles that turn by no more than so many degrees against the surface would give more
/// elements than a mesh can hold.
void refuse_huge_turning(const KnownSurface& surface, const SizeOptions& options, double degrees,
                         const RunContext& context);

/// For a surface that is kept: sizes from its own triangles (robust against needles and jumps), graded, combined with
/// the sources of `options` inside.
SizeField size_field_of_surface(const KnownSurface& surface, const SizeOptions& options, const Stage& stage);

struct OctreeField;
class ThinWalls;
class TetPrediction;

/// `finer` where it has no more than `most` elements, else with its smallest sizes raised to one floor, which it has
/// too, but nowhere above `first`: what is asked for on top of `first` is met as far as the elements go.
struct WithinCount {
  SizeField sizes;
  double asked = 0;  ///< elements by `finer`
  double floor = 0;  ///< 0: nothing was raised
};
WithinCount within_count(const SizeField& finer, const SizeField& first, const TetPrediction& expected, double most,
                         const RunContext& context);

/// How many tetrahedra a mesh of the inside of a surface by given sizes will have: the integral of c / h^3, c measured;
/// in walls of few layers as many as the triangles of their surface ask for. Refers to `surface`, which must outlive
/// it.
class TetPrediction {
 public:
  explicit TetPrediction(const SurfaceMesh& surface);
  ~TetPrediction();
  /// `triangles`: how many the surface has, if it is made by these sizes already.
  double operator()(const SizeField& sizes, std::optional<std::size_t> triangles = {}) const;

  /// The same for other sizes on the leaves of a grid, which must outlive it, as must this.
  std::function<double(const OctreeField&)> on_leaves_of(const OctreeField& grid) const;

  /// Triangles between the inside and the outside.
  std::size_t triangles() const { return surface_.triangles.size(); }

 private:
  const SurfaceMesh hull_;  ///< of a complex
  const SurfaceMesh& surface_;
  std::unique_ptr<const ThinWalls> walls_;
};

/// The same for one size field.
double expected_tets(const SizeField& sizes, const SurfaceMesh& surface);
/// The same within a surface that was made by these sizes, or is kept: its triangles are known.
double expected_tets_within(const SizeField& sizes, const SurfaceMesh& made);

/// The mean edge length of one level of a lattice whose cells come in powers of two of it, each divided while its edges
/// are longer than kLatticeTooLong times the wanted ones: chosen so that the lattice inside `surface` has as many
/// elements as the sizes ask for, and near the sizes of the surface.
double lattice_cell_size(const SizeField& sizes, const SurfaceMesh& surface);
inline constexpr double kLatticeTooLong = 1.5;

/// The size field capped to `factor` of its own value within 1.5 of these values around each point. Sizes grow from
/// there at the field's own gradation; so below.
SizeField capped_near(const SizeField& sizes, const std::vector<Vec3>& points, double factor,
                      const RunContext& context);

struct CapShape {
  double reach = 1.5;    ///< in sizes of a place: so far they hold unchanged
  double gradation = 0;  ///< more than the field's: sizes may rise as fast from the places, and anywhere from then on
};

/// The size field capped to the sizes at the places.
SizeField capped_at(const SizeField& sizes, const std::vector<PointSize>& places, const RunContext& context,
                    const CapShape& shape = {});

/// All sizes multiplied by `factor`; where they then rise faster than the gradation they are cut.
SizeField scaled(const SizeField& sizes, double factor, const RunContext& context);

}  // namespace octafront
