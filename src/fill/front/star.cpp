#include "fill/front/star.h"

#include <octafront/quality.h>

#include "base/geometry/predicates.h"
#include "fill/front/kernel_point.h"

#include <algorithm>

namespace octafront {

namespace {

/// Walls whose distances from the point differ by less, as a share of the cavity's extent, are violated alike: at the
/// optimum several are, and equal only up to the rounding of kernel_point.cpp.
constexpr double kAlike = 1e-9;
constexpr int kMostSteps = 60;
/// A star with all elements above this is taken at once; others look for a better one for some more steps.
constexpr double kGoodStar = 0.12;
constexpr int kStepsForBetter = 10;
/// Beyond this many walls a single point makes no sense, and growth has gone astray.
constexpr std::size_t kMostWalls = 600;

struct View {
  Vec3 at;
  bool sees_all = false;
  double worst = 0;                  ///< beta of the worst element, where it sees all
  std::vector<std::size_t> blocked;  ///< walls, most violated first
};

View view_from_kernel(const WorkMesh& mesh, const std::vector<Wall>& walls) {
  std::vector<HalfSpace> planes;
  Box3 box;
  for (const Wall& w : walls) {
    const Vec3 a = mesh.at(w[0]), b = mesh.at(w[1]), c = mesh.at(w[2]);
    const Vec3 n = normalized(cross(b - a, c - a));
    planes.push_back({n, dot(n, (a + b + c) / 3)});
    box.add(a), box.add(b), box.add(c);
  }
  View view;
  view.at = deepest_point(planes, box).at;
  view.worst = 1;
  std::vector<std::pair<double, std::size_t>> violated;
  const double tight = kAlike * box.diagonal();
  double least = 0;
  view.sees_all = true;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Vec3 a = mesh.at(walls[i][0]), b = mesh.at(walls[i][1]), c = mesh.at(walls[i][2]);
    const double s = dot(planes[i].n, view.at) - planes[i].d;
    violated.emplace_back(s, i);
    least = i == 0 ? s : std::min(least, s);
    view.sees_all = view.sees_all && orient3d(a, b, c, view.at) > 0;
    view.worst = std::min(view.worst, radius_ratio(a, b, c, view.at));
  }
  // Among walls violated alike their order decides, not rounding.
  for (auto& [s, i] : violated)
    if (s < least + tight) s = least;
  std::sort(violated.begin(), violated.end());
  for (const auto& [s, i] : violated) view.blocked.push_back(i);
  return view;
}

/// Grows until the walls have a kernel and its star is good, or for `steps` steps at most; returns the number of the
/// step with the best star, -1 if there was none.
int best_step(Excavation& cavity, int steps) {
  int best = -1, last = steps;
  double best_quality = 0;
  for (int step = 0; step <= last && cavity.size() <= kMostWalls && !cavity.empty(); ++step) {
    const std::vector<Wall> walls = cavity.walls();
    const View view = view_from_kernel(cavity.mesh(), walls);
    if (view.sees_all && view.worst > best_quality) {
      if (best < 0) last = std::min(last, step + kStepsForBetter);
      best = step;
      best_quality = view.worst;
      if (view.worst >= kGoodStar) break;
    }
    const bool grown = std::any_of(view.blocked.begin(), view.blocked.end(),
                                   [&](std::size_t i) { return cavity.grow_through(walls[i]); });
    if (!grown) break;
  }
  return best;
}

void grow(Excavation& cavity, int steps) {
  for (int step = 0; step < steps; ++step) {
    const std::vector<Wall> walls = cavity.walls();
    for (const std::size_t i : view_from_kernel(cavity.mesh(), walls).blocked)
      if (cavity.grow_through(walls[i])) break;
  }
}

}  // namespace

StarResult close_by_star(const OpenCavity& cavity) {
  int steps = -1;
  {
    Excavation trial(cavity);
    steps = best_step(trial, kMostSteps);
  }
  if (steps < 0) return {};
  Excavation excavation(cavity);
  grow(excavation, steps);
  WorkMesh& mesh = cavity.mesh;
  const std::vector<Wall> walls = excavation.walls();
  const VertexIndex center = mesh.add_point(view_from_kernel(mesh, walls).at);
  for (const Wall& w : walls) mesh.add({w[0], w[1], w[2], center});
  excavation.commit();
  return {true, steps, 1};
}

}  // namespace octafront
