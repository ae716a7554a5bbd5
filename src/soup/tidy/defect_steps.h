#pragma once

// The searches of find_defects.

#include <octafront/repair.h>
#include <octafront/run_context.h>

#include "base/mesh/edge_table.h"

#include <vector>

namespace octafront::tidy {

/// Open, non-manifold and misoriented edges.
void find_bad_edges(const RepairedSurface& repaired, const EdgeTable& table, SurfaceDefects& defects);

/// Holes, and vertices with more than one fan.
void find_bad_vertices(const RepairedSurface& repaired, const EdgeTable& table, SurfaceDefects& defects);

/// Faces without area.
void find_degenerate_faces(const RepairedSurface& repaired, SurfaceDefects& defects);

/// All of the above.
SurfaceDefects find_defects_but_crossings(const RepairedSurface& repaired, const EdgeTable& table,
                                          const RunContext& context);

/// find_defects() with the edges at hand.
SurfaceDefects find_defects(const RepairedSurface& repaired, const EdgeTable& table, const RunContext& context);

/// The defects of a complex: faces without area, crossings; where there are none of those, edges around which the
/// regions do not agree; where there are none of those either, parts that lie in another region than they say.
SurfaceDefects find_complex_defects(const RepairedSurface& repaired, const EdgeTable& table, const RunContext& context);
/// What it finds of regions, where nothing crosses. `places`, if it is not null, gets the middles of all edges at fault
/// and a place on each part.
SurfaceDefects find_region_defects(const RepairedSurface& repaired, const EdgeTable& table, const RunContext& context,
                                   std::vector<Vec3>* places = nullptr);

/// Pairs of faces that meet elsewhere than in what they share; counting stops at kMostPairs.
void find_self_intersections(const RepairedSurface& repaired, const EdgeTable& table, const RunContext& context,
                             SurfaceDefects& defects);
inline constexpr std::uint64_t kMostPairs = 1'000'000;

/// Keeps the first places of a kind, in order of their faces.
class FirstPlaces {
 public:
  explicit FirstPlaces(SurfaceDefects::Kind& kind) : kind_(kind) {}
  /// `faces` are input faces; they are sorted, and each kept once.
  void add(std::vector<std::uint32_t> faces, Vec3 at);

 private:
  SurfaceDefects::Kind& kind_;
};

}  // namespace octafront::tidy
