#include "fill/front/backtrack.h"

#include "fill/front/advance.h"

#include <algorithm>

namespace octafront {

namespace {

/// A cavity that asks for more tetrahedra than this for each wall is not being closed but blown up.
constexpr std::size_t kTetsPerWall = 60;

/// A trial that succeeds on a well-shaped surface needs a tenth of this; what needs more seldom succeeds at all.
constexpr std::uint64_t kFaceTestsPerTrial = 200'000;

/// The vertices of the walls, numbered in ascending order.
std::vector<VertexIndex> corners_of(const std::vector<Wall>& walls) {
  std::vector<VertexIndex> corners;
  for (const Wall& w : walls) corners.insert(corners.end(), w.begin(), w.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// The walls as a front of their own, on vertices numbered as in `global`.
FrontState front_of(const std::vector<Wall>& walls, const std::vector<VertexIndex>& global, const WorkMesh& mesh,
                    const SizeField& sizes) {
  FrontState front;
  front.finest_size = sizes.min_size();
  for (const VertexIndex v : global) {
    front.domain.add(mesh.at(v));
    front.points.push_back(mesh.at(v));
    front.sizes.push_back(static_cast<float>(sizes.at(mesh.at(v))));
  }
  const auto local = [&](VertexIndex v) {
    return static_cast<VertexIndex>(std::lower_bound(global.begin(), global.end(), v) - global.begin());
  };
  for (const Wall& w : walls) front.queue.push_back({{{local(w[0]), local(w[1]), local(w[2])}}});
  return front;
}

}  // namespace

bool close_by_front(const OpenCavity& cavity, const BacktrackVariant& variant, const FrontTask& task,
                    std::uint64_t& face_tests) {
  if (face_tests == 0) return false;
  Excavation excavation(cavity);
  for (int ring = 0; ring < variant.rings; ++ring)
    if (!excavation.grow_ring()) return false;
  const std::vector<Wall> walls = excavation.walls();
  std::vector<VertexIndex> global = corners_of(walls);
  FrontState front = front_of(walls, global, cavity.mesh, task.sizes);
  VolumeOptions options = task.options;
  options.ideal_distance *= variant.ideal_factor;
  options.ranking = variant.ranking;
  FrontCounters unused;
  const AdvanceBudget budget{.tets = 1000 + kTetsPerWall * walls.size(),
                             .face_tests = std::min(face_tests, kFaceTestsPerTrial)};
  const bool within_budget = advance_front(front, {task.sizes, options, task.stage}, budget, unused);
  face_tests -= std::min(face_tests, front.work.face_tests);
  if (!within_budget || !front.held.empty()) return false;
  for (std::size_t v = global.size(); v < front.points.size(); ++v)
    global.push_back(cavity.mesh.add_point(front.points[v]));
  for (const FilledPiece& piece : front.filled)
    for (const Tet& t : piece.tets) cavity.mesh.add({global[t[0]], global[t[1]], global[t[2]], global[t[3]]});
  excavation.commit();
  return true;
}

}  // namespace octafront
