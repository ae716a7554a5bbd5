#include "fill/front/excavation.h"

#include <octafront/error.h>

#include "base/core/validate.h"
#include "base/mesh/face_table.h"
#include "fill/front/open_edge.h"

#include <algorithm>

namespace octafront {

Excavation::Excavation(const OpenCavity& cavity)
    : mesh_(cavity.mesh), cavities_(cavity.cavities), merged_{cavity.number} {
  for (const Wall& w : cavity.walls()) walls_.emplace(wall_key(w), w);
}

Excavation::~Excavation() {
  if (committed_) return;
  for (const TetIndex t : removed_) mesh_.restore(t);
}

std::vector<Wall> Excavation::walls() const {
  std::vector<Wall> list;
  list.reserve(walls_.size());
  for (const auto& [key, wall] : walls_) list.push_back(wall);
  return list;
}

void Excavation::toggle(const Wall& wall) {
  const WallKey key = wall_key(wall);
  // The two sides of a triangle of the surface do not join.
  const auto back = mesh_.is_two_sided(wall) ? walls_.end() : walls_.find(back_of(key));
  if (back != walls_.end()) {
    walls_.erase(back);
    return;
  }
  if (walls_.emplace(key, wall).second) return;
  const auto& [a, b, c] = wall;
  throw MeshingError("tetrahedra overlap at the face (" + std::to_string(a) + ", " + std::to_string(b) + ", " +
                     std::to_string(c) + "); check the surface for self-intersections");
}

void Excavation::take_out(TetIndex t) {
  mesh_.remove(t);
  removed_.push_back(t);
  const Tet tet = mesh_.tet(t);
  for (int i = 0; i < 4; ++i) {
    const auto [a, b, c] = face_of(tet, i);
    const Wall inward{a, c, b};
    // Behind this face may lie another cavity: then the two become one.
    const std::uint32_t other = mesh_.is_two_sided(inward) ? kNone : cavities_.owner(inward);
    if (other != kNone && merged_.insert(other).second)
      for (const Wall& w : cavities_.walls(other)) toggle(w);
    toggle(inward);
  }
}

bool Excavation::grow_through(const Wall& wall) {
  const TetIndex t = mesh_.is_two_sided(wall) ? kNone : mesh_.tet_behind(wall);
  if (t == kNone) return false;
  take_out(t);
  validate(*this);
  return true;
}

bool Excavation::grow_ring() {
  std::set<VertexIndex> corners;
  for (const auto& [key, wall] : walls_) corners.insert(wall.begin(), wall.end());
  std::vector<TetIndex> ring;
  for (const VertexIndex v : corners) {
    const std::vector<TetIndex> around = mesh_.around(v);
    ring.insert(ring.end(), around.begin(), around.end());
  }
  std::sort(ring.begin(), ring.end());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  for (const TetIndex t : ring) take_out(t);
  validate(*this);
  return !ring.empty();
}

std::optional<std::string> Excavation::first_inconsistency() const {
  for (const auto& [key, wall] : walls_)
    if (key != wall_key(wall)) return "a wall stands under another's corners";
  for (const TetIndex t : removed_)
    if (mesh_.alive(t)) return "tetrahedron " + std::to_string(t) + " was taken out and lives";
  return why_not_closed(walls(), "the walls of an excavation");
}

void Excavation::commit() {
  for (const std::uint32_t c : merged_) cavities_.close(c);
  committed_ = true;
}

}  // namespace octafront
