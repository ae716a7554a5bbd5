#include "volume/ladder.h"

#include <octafront/error.h>

#include "cavity/cavity.h"
#include "core/stage_timer.h"
#include "volume/backtrack.h"
#include "volume/recover_cavity.h"

#include <algorithm>
#include <array>
#include <string>

namespace octafront {

namespace {

using Ranking = VolumeOptions::Ranking;

/// Other choices, in the order in which they are tried.
constexpr std::array<BacktrackVariant, 4> kBeforeStar{{{1, 1.0, Ranking::kQuality},
                                                       {1, 0.8, Ranking::kSolidAngle},
                                                       {2, 1.0, Ranking::kQuality},
                                                       {2, 0.7, Ranking::kQuality}}};
constexpr std::array<BacktrackVariant, 3> kAfterStar{
    {{3, 1.0, Ranking::kQuality}, {3, 0.6, Ranking::kSolidAngle}, {4, 0.8, Ranking::kQuality}}};

/// The bare cavity first: rings only help where no doubles fit between its walls.
constexpr std::array<int, 4> kRecoveryRings{0, 1, 2, 4};

/// Work that backtracking may spend in all, in faces tested: about two seconds, and an eighth of what the front took.
/// On surfaces of needles most trials fail, and the lower rungs are quick.
constexpr std::uint64_t kBacktrackingFaceTests = 5'000'000;
constexpr std::uint64_t kFaceTestsPerTet = 3;

struct RungCounts {
  int cavities = 0, by_front = 0, by_star = 0, growth_steps = 0, by_recovery = 0;
  double front_seconds = 0, star_seconds = 0, recovery_seconds = 0;  ///< CPU, closed or not
};

/// Adds the CPU time that run() takes to `seconds`; the rungs are tried one after the other.
template <class Run>
auto timed(double& seconds, Run&& run) {
  const double start = process_cpu_seconds();
  auto result = run();
  seconds += process_cpu_seconds() - start;
  return result;
}

/// Where the cavities are, with room for some rings of tetrahedra; nothing if they are too many to tell apart quickly.
std::vector<Box3> surroundings(const std::vector<Vec3>& points, const Cavities& cavities) {
  constexpr std::size_t kMost = 64;
  std::vector<Box3> boxes;
  if (cavities.size() > kMost) return boxes;
  for (std::size_t c = 0; c < cavities.size(); ++c) {
    Box3 box;
    for (const Wall& w : cavities.walls(c))
      for (const VertexIndex v : w) box.add(points[v]);
    const double margin = 2 * box.diagonal();
    boxes.push_back({box.lo - Vec3{margin, margin, margin}, box.hi + Vec3{margin, margin, margin}});
  }
  return boxes;
}

[[noreturn]] void give_up(const WorkMesh& mesh, const std::vector<Wall>& walls) {
  std::vector<VertexIndex> global;
  SurfaceMesh surface = surface_of(mesh, walls, global);
  const Vec3 p = bounding_box(surface.points).center();
  throw OpenCavityError("a cavity of " + std::to_string(walls.size()) + " faces near (" + std::to_string(p.x) + ", " +
                            std::to_string(p.y) + ", " + std::to_string(p.z) +
                            ") could not be filled; please report it with the surface",
                        std::move(surface));
}

}  // namespace

void close_cavities(TetMesh& mesh, const std::vector<Wall>& walls, const SizeField& sizes, const VolumeOptions& options,
                    const Stage& stage) {
  const double start = process_cpu_seconds();
  const std::uint64_t mesh_tets = mesh.tets.size();
  Cavities cavities(walls);
  const std::vector<Box3> focus = surroundings(mesh.points, cavities);
  WorkMesh work(std::move(mesh.points), std::move(mesh.tets), focus);
  RungCounts counts;
  std::uint64_t face_tests = kBacktrackingFaceTests + kFaceTestsPerTet * mesh_tets;
  for (std::uint32_t c = 0; c < cavities.size(); ++c) {
    if (cavities.walls(c).empty()) continue;
    stage.check();
    ++counts.cavities;
    const auto by_front = [&](const BacktrackVariant& variant) {
      const bool closed = timed(counts.front_seconds, [&] {
        return close_by_front(work, cavities, c, variant, sizes, options, stage.context(), face_tests);
      });
      counts.by_front += closed;
      return closed;
    };
    if (std::any_of(kBeforeStar.begin(), kBeforeStar.end(), by_front)) continue;
    const StarResult star = timed(counts.star_seconds, [&] { return close_by_star(work, cavities, c); });
    counts.growth_steps += star.growth_steps;
    counts.by_star += star.closed;
    if (star.closed || std::any_of(kAfterStar.begin(), kAfterStar.end(), by_front)) continue;
    if (cavities.walls(c).size() > mesh.boundary.size()) give_up(work, cavities.walls(c));
    const auto by_recovery = [&](int rings) {
      return timed(counts.recovery_seconds,
                   [&] { return close_by_recovery(work, cavities, c, rings, stage.context()); });
    };
    if (std::any_of(kRecoveryRings.begin(), kRecoveryRings.end(), by_recovery)) {
      ++counts.by_recovery;
      continue;
    }
    give_up(work, cavities.walls(c));
  }
  mesh.points = work.take_points();
  mesh.tets = work.take_tets();
  stage.count("cavities", counts.cavities);
  stage.count("closed by backtracking", counts.by_front);
  stage.count("closed by kernel points", counts.by_star);
  stage.count("closed by recovery", counts.by_recovery);
  stage.count("growth steps", counts.growth_steps);
  stage.count("backtracking CPU seconds", counts.front_seconds);
  stage.count("kernel points CPU seconds", counts.star_seconds);
  stage.count("recovery CPU seconds", counts.recovery_seconds);
  stage.count("closing CPU seconds", process_cpu_seconds() - start);
}

}  // namespace octafront
