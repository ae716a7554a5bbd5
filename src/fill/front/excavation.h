#pragma once

#include "fill/front/work_mesh.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace octafront {

/// A cavity that grows by the removal of tetrahedra around it, as a transaction: nothing is lost until commit(), and an
/// excavation that ends without it puts everything back.
class Excavation {
 public:
  explicit Excavation(const OpenCavity& cavity);
  ~Excavation();
  Excavation(const Excavation&) = delete;
  Excavation& operator=(const Excavation&) = delete;

  const WorkMesh& mesh() const { return mesh_; }
  /// The walls in a fixed order.
  std::vector<Wall> walls() const;
  std::size_t size() const { return walls_.size(); }
  bool empty() const { return walls_.empty(); }
  /// Removes the tetrahedron behind a wall; false if there is none, or the wall is part of the surface.
  bool grow_through(const Wall& wall);
  /// Removes all tetrahedra that touch a vertex of the walls; false if there are none.
  bool grow_ring();
  /// The walls are closed, and what was taken out is gone.
  std::optional<std::string> first_inconsistency() const;
  /// The cavity, and those that it has run into, have been filled.
  void commit();

 private:
  void take_out(TetIndex t);
  void toggle(const Wall& wall);

  WorkMesh& mesh_;
  Cavities& cavities_;
  std::map<WallKey, Wall> walls_;
  std::vector<TetIndex> removed_;
  std::set<std::uint32_t> merged_;
  bool committed_ = false;
};

}  // namespace octafront
