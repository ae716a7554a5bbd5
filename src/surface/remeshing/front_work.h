#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "base/core/stage.h"
#include "base/geometry/leeway.h"
#include "base/mesh/known_surface.h"
#include "periodic/periodic_cell.h"
#include "sizing/sources/budget.h"
#include "surface/edits/coarsen.h"
#include "surface/front/front_steps.h"
#include "surface/lines/curves.h"
#include "surface/remeshing/remesh.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace octafront::surface {

/// The elements that sizes may come to, by the prediction, and what was given up for it. Refers to the surface.
class ElementBudget {
 public:
  /// `most`: HUGE_VAL: there is no budget.
  ElementBudget(const SurfaceMesh& surface, double most, const Stage& stage)
      : surface_(surface), most_(most), stage_(stage) {}

  bool is_limited() const { return std::isfinite(most_); }
  double most() const { return most_; }
  /// Elements by these sizes. The first call takes the time of a walk through the surface.
  double expected(const SizeField& sizes);
  /// `finer` as far as the budget goes, nowhere above `first`; in this round.
  SizeField affordable(const SizeField& finer, const SizeField& first, int round);

  bool is_spent() const { return floor_ > 0; }
  int spent_in_round() const { return spent_in_round_; }
  /// Says what was given up: `far` places lie farther from the input than `deviation`.
  void note(std::size_t far, double farthest, double deviation) const;

 private:
  const SurfaceMesh& surface_;
  double most_;
  const Stage& stage_;
  std::optional<TetPrediction> expected_;  ///< made when it is needed
  double asked_ = 0, floor_ = 0;           ///< elements, and the least size that is left; 0: nothing was given up
  int spent_in_round_ = 0;
};

// What all rounds of the surface front work on, what one of them makes, and what they did.

struct FrontCounts {
  static constexpr std::uint64_t kJudgedAnyway = 20'000, kJudgedPerTriangle = 2;
  std::uint64_t placed = 0, tried = 0;
  InsertionCounts insertion;
  CoarsenCounts coarsen;
  ImproveCounts improve;
  std::uint64_t divided_edges = 0, merged_lines = 0, places_mended = 0, approached = 0, kept_places = 0;
  std::uint64_t crossings = 0, triangles = 0, changes_judged = 0;  ///< of all rounds
  int rounds = 0, deviation_rounds = 0;
  std::size_t last_triangles = 0;  ///< of the last round

  /// Whether all rounds together have made more than so many times the triangles of the last one.
  bool exceed(double times) const {
    return static_cast<double>(triangles) > times * static_cast<double>(last_triangles);
  }
  /// How many changes may be judged still where a mesh of so many triangles is mended, so that mending all rounds takes
  /// no more than a part of the time that the mesh takes. Tips of needles and sheets that touch would take all.
  std::uint64_t judged_left(std::size_t mesh_triangles) const {
    const std::uint64_t most = kJudgedAnyway + kJudgedPerTriangle * mesh_triangles;
    return changes_judged < most ? most - changes_judged : 0;
  }
  /// What counts the last round alone is 0 again.
  void start_round(std::uint64_t points_placed, std::uint64_t places_tried);
  void report(const Stage& stage) const;
};

/// What is given, but for the sizes, and what was done and spent. Refers to what it is made of.
struct FrontWork {
  FrontWork(const KnownSurface& surface, const SurfaceOptions& given, const Stage& by, std::span<const double> bounds,
            const FrontLimits& limited, const PeriodicCell& cell)
      : known(surface),
        options(given),
        stage(by),
        bound(bounds),
        limits(limited),
        leeway(surface.mesh(), surface.tree(), bounds),
        tolerance(given.max_deviation.value_or(HUGE_VAL)),
        budget(surface.mesh(), limited.budget, by),
        periods(find_periodic_faces(surface.mesh(), cell)) {}

  bool limits_deviation() const { return options.max_deviation.value_or(0) > 0; }
  const SurfaceMesh& surface() const { return known.mesh(); }
  /// Nobody knows how many rounds there will be: each takes half of what is left.
  void progress(double part_of_round) const;

  const KnownSurface& known;
  const SurfaceOptions& options;
  const Stage& stage;
  std::span<const double> bound;  ///< see remesh_surface()
  FrontLimits limits;
  Leeway leeway;
  double tolerance;  ///< for details of the input: none moves farther
  ElementBudget budget;
  PeriodicFaces periods;
  FrontCounts counts;
};

/// How near the new surface lies to the input.
struct Nearness {
  std::vector<Vec3> approached;    ///< where points of the input were put in
  std::vector<Vec3> far, farther;  ///< where it deviates still: too far, and much too far
  double farthest = 0;
  bool is_near_enough = false;          ///< though there are such places
  std::vector<PointSize> wanted;        ///< sizes by which it would deviate less there
  std::vector<VertexIndex> near_limit;  ///< corners of triangles that nearly do, in the working mesh
};

/// What a round makes.
struct Draft {
  SizeField sizes;                     ///< that it was made by
  std::vector<std::uint8_t> is_fixed;  ///< per vertex: it stays where it is; those beyond its end do not
  std::vector<Curve> curves;           ///< divided
  WorkingMesh mesh;
  Nearness nearness;
  bool is_clear = false;  ///< it is known that nothing crosses
};

}  // namespace octafront::surface
