#include "fill/front/ladder.h"

#include <octafront/open_cavity_error.h>

#include "base/core/stage_timer.h"
#include "base/core/validate.h"
#include "base/mesh/renumber_mesh.h"
#include "base/shared/packing.h"
#include "fill/front/backtrack.h"
#include "fill/front/recover_cavity.h"
#include "fill/front/star.h"
#include "fill/front/work_mesh.h"

#include <algorithm>
#include <array>
#include <span>
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

/// Work that backtracking may spend on a cavity, in faces tested for each of its walls. Of 66 cavities that it closed
/// on five surfaces with needles, 58 took less; 82 others would have cost some times as much and stayed open, while the
/// lower rungs are quick.
constexpr std::uint64_t kFaceTestsPerWall = 5000;

/// Adds the CPU time that run() takes to `seconds`; the rungs are tried one after the other.
template <class Run>
auto timed(double& seconds, Run&& run) {
  const double start = process_cpu_seconds();
  auto result = run();
  seconds += process_cpu_seconds() - start;
  return result;
}

/// Where the cavities are, with room for some rings of tetrahedra.
std::vector<Box3> surroundings(const std::vector<Vec3>& points, const Cavities& cavities) {
  std::vector<Box3> boxes;
  for (std::size_t c = 0; c < cavities.size(); ++c) {
    Box3 box;
    for (const Wall& w : cavities.walls(c))
      for (const VertexIndex v : w) box.add(points[v]);
    const double margin = 2 * box.diagonal();
    boxes.push_back(box.grown(margin));
  }
  return boxes;
}

std::vector<Triangle> two_sided_triangles(const SurfaceMesh& surface) {
  std::vector<Triangle> found;
  for (std::size_t t = 0; t < surface.sides.size(); ++t)
    if (surface.sides[t][0] != kNone && surface.sides[t][1] != kNone) found.push_back(surface.triangles[t]);
  return found;
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

/// Tries one rung after the other on a cavity, and counts.
class Ladder {
 public:
  /// Cavities with more walls than `most_walls` are given up.
  Ladder(const FrontTask& task, std::size_t most_walls) : task_(task), most_walls_(most_walls) {}

  void close(const OpenCavity& cavity) {
    task_.stage.check();
    ++cavities_;
    face_tests_ = kFaceTestsPerWall * cavity.walls().size();
    if (by_front(cavity, kBeforeStar) || by_star(cavity) || by_front(cavity, kAfterStar)) return;
    if (cavity.walls().size() > most_walls_ || !by_recovery(cavity)) give_up(cavity.mesh, cavity.walls());
  }

  void report_to(const Stage& stage) const {
    stage.count("cavities", cavities_);
    stage.count("closed by backtracking", by_front_);
    stage.count("closed by kernel points", by_star_);
    stage.count("closed by recovery", by_recovery_);
    stage.count("growth steps", growth_steps_);
    stage.count("backtracking CPU seconds", front_seconds_);
    stage.count("kernel points CPU seconds", star_seconds_);
    stage.count("recovery CPU seconds", recovery_seconds_);
  }

 private:
  bool by_front(const OpenCavity& cavity, std::span<const BacktrackVariant> variants) {
    const bool closed = std::any_of(variants.begin(), variants.end(), [&](const BacktrackVariant& variant) {
      return timed(front_seconds_, [&] { return close_by_front(cavity, variant, task_, face_tests_); });
    });
    by_front_ += closed;
    return closed;
  }

  bool by_star(const OpenCavity& cavity) {
    const StarResult star = timed(star_seconds_, [&] { return close_by_star(cavity); });
    growth_steps_ += star.growth_steps;
    by_star_ += star.closed;
    return star.closed;
  }

  bool by_recovery(const OpenCavity& cavity) {
    const bool closed = std::any_of(kRecoveryRings.begin(), kRecoveryRings.end(), [&](int rings) {
      return timed(recovery_seconds_, [&] { return close_by_recovery(cavity, rings, task_.stage.context()); });
    });
    by_recovery_ += closed;
    return closed;
  }

  const FrontTask& task_;
  const std::size_t most_walls_;
  std::uint64_t face_tests_ = 0;  ///< that backtracking may still spend on the cavity
  int cavities_ = 0, by_front_ = 0, by_star_ = 0, growth_steps_ = 0, by_recovery_ = 0;
  double front_seconds_ = 0, star_seconds_ = 0, recovery_seconds_ = 0;  // CPU, closed or not
};

/// Closes all, of a mesh whose tetrahedra are all given, or those of the focus alone.
void close_all(TetMesh& mesh, const std::vector<Wall>& walls, const SurfaceMesh& surface, const FrontTask& task,
               WorkMesh::Holds holds) {
  const double start = process_cpu_seconds();
  Ladder ladder(task, surface.triangles.size());
  Cavities cavities(walls);
  const std::vector<Box3> focus = surroundings(mesh.points, cavities);
  WorkMesh work(std::move(mesh.points), std::move(mesh.tets), focus, two_sided_triangles(surface), holds);
  for (std::uint32_t c = 0; c < cavities.size(); ++c)
    if (!cavities.walls(c).empty()) ladder.close({work, cavities, c});
  if (holds == WorkMesh::Holds::kAll) validate(work);
  mesh.points = work.take_points();
  mesh.tets = work.take_tets();
  ladder.report_to(task.stage);
  task.stage.count("closing CPU seconds", process_cpu_seconds() - start);
}

/// One cavity after the other, in the order of their names: of their least walls.
std::vector<Wall> in_order(std::vector<Wall> walls) {
  std::ranges::sort(walls, {}, wall_key);
  return walls;
}

/// The tetrahedra of all ranks that touch a marked point, in order of their numbers.
std::vector<NumberedTet> gathered_near(const FrontTets& share, const std::vector<std::uint8_t>& marks,
                                       const Comm& comm) {
  std::vector<NumberedTet> near;
  for (std::size_t t = 0; t < share.tets.size(); ++t)
    if (std::ranges::any_of(share.tets[t], [&](VertexIndex v) { return marks[v] != 0; }))
      near.push_back({share.number(t), share.tets[t]});
  near = gathered_lists(comm, near, "tetrahedra around cavities");
  std::ranges::sort(near, {}, &NumberedTet::number);
  return near;
}

/// Closing took some of `before`, and put others behind what it left: does the same to a share. The first rank gets the
/// new ones.
void follow(const std::vector<NumberedTet>& before, const std::vector<Tet>& after, FrontTets& share, const Comm& comm) {
  std::vector<std::uint64_t> gone;
  std::size_t left = 0;
  for (const NumberedTet& t : before) {
    if (left < after.size() && after[left] == t.tet)
      ++left;
    else
      gone.push_back(t.number);
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < share.tets.size(); ++t)
    if (!std::ranges::binary_search(gone, share.number(t))) share.tets[kept++] = share.tets[t];
  share.tets.resize(kept);
  share.stretches.clear();
  if (comm.rank() == 0)
    share.tets.insert(share.tets.end(), after.begin() + static_cast<std::ptrdiff_t>(left), after.end());
}

}  // namespace

void close_cavities(TetMesh& mesh, std::vector<Wall> walls, const SurfaceMesh& surface, const FrontTask& task) {
  if (walls.empty()) return;
  close_all(mesh, in_order(std::move(walls)), surface, task, WorkMesh::Holds::kAll);
  drop_unused_points(mesh, surface.points.size());
}

void close_cavities_of_shares(std::vector<Vec3>& points, FrontTets& share, std::vector<Wall> walls,
                              const SurfaceMesh& surface, const FrontTask& task) {
  if (walls.empty()) return;
  const Comm comm(task.ranks);
  walls = in_order(std::move(walls));
  std::vector<std::uint8_t> marks = near_boxes(points, surroundings(points, Cavities(walls)));
  for (WorkMesh::Holds holds = WorkMesh::Holds::kFocus;;) {
    const std::vector<NumberedTet> near = gathered_near(share, marks, comm);
    TetMesh part;
    part.points = points;
    for (const NumberedTet& t : near) part.tets.push_back(t.tet);
    try {
      close_all(part, walls, surface, task, holds);
    } catch (const BeyondPart&) {
      holds = WorkMesh::Holds::kAll;
      marks.assign(points.size(), 1);
      continue;
    }
    points = std::move(part.points);
    return follow(near, part.tets, share, comm);
  }
}

}  // namespace octafront
