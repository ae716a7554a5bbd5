#include "surface/remeshing/front_kind.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "surface/remeshing/mend_folds.h"

#include <algorithm>

namespace octafront::surface {

namespace {

/// Nor is size the reason where the input's triangles are about as large as those that are wanted: none of their
/// heights is below this part of the size.
constexpr double kAsLarge = 0.5;
/// Triangles below this 2r/R are mended at the end, by moving the surface no farther than this part of the size.
constexpr double kBadShape = 0.25, kMovedPart = 0.25;
/// Mending one crossing may uncover another.
constexpr int kMendingRounds = 4;
/// What crosses may move by this part of the size.
constexpr double kCrossingPart = 0.5;

}  // namespace

void FrontKind::divide_long(Draft& draft) {
  WorkingMesh& mesh = draft.mesh;
  parallel_for(mesh.points.size(), [&](std::size_t v) {
    if (mesh.outgoing[v] != kNone) mesh.size[v] = draft.sizes.at(mesh.points[v]);
  });
  improve_surface(mesh, input(), draft.curves, draft.sizes, work_.stage.context(), work_.counts.improve);
}

bool FrontKind::mend_places(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed, const PlaceLimits& of,
                            bool clear) {
  FoldLimits limits{.tolerance = of.tolerance,
                    .size_part = kMovedPart,
                    .least_shape = kBadShape,
                    .crossing_part = kCrossingPart,
                    .crossing_most = of.crossing_most,
                    .leeway = &work_.leeway,
                    .keep_lines = true,
                    .onto = &work_.known.tree(),
                    .is_fixed = is_fixed,
                    .patch_of = of.patch_of};
  for (int round = 0; round < kMendingRounds; ++round) {
    const std::vector<std::uint8_t> crossing =
        clear ? std::vector<std::uint8_t>(mesh.triangle_count()) : crossing_triangles(mesh);
    const auto count = std::count(crossing.begin(), crossing.end(), 1);
    if (round > 0 && count == 0) return true;
    limits.crossing = count <= of.few_crossing ? &crossing : nullptr;
    limits.most_judged = work_.counts.judged_left(mesh.triangle_count());
    const MendedFolds mended = mend_folds(mesh, limits, work_.stage.context());
    const std::uint64_t done = mended.operations;
    work_.counts.places_mended += done;
    work_.counts.changes_judged += mended.judged;
    if (count == 0) return true;  // mending makes no crossings
    if (done == 0 || count > of.few_crossing) return false;
  }
  return false;
}

const TriangleCorners& FrontKind::input_triangle_at(Vec3 p) const {
  return work_.known.tree().corners(work_.known.tree().nearest(p).triangle);
}

bool FrontKind::is_as_large(Vec3 p, const SizeField& sizes) const {
  const TriangleCorners& t = input_triangle_at(p);
  return length(double_area_normal(t[0], t[1], t[2])) >= kAsLarge * sizes.at(p) * longest_edge_of(t);
}

bool FrontKind::is_in_vain(Vec3 p, const RoundSizes& sizes) const {
  return sizes.now().at(p) < kVain * sizes.first().at(p) || work_.counts.exceed(kPatience) ||
         sizes.is_kept_near(p, RoundSizes::kGrowthOfKeptPlaces);
}

double longest_edge_of(const TriangleCorners& t) {
  return std::max({distance(t[0], t[1]), distance(t[1], t[2]), distance(t[2], t[0])});
}

}  // namespace octafront::surface
