#pragma once

// What the arrays of a periodic mesh say (TetMesh::periods, periodic_nodes).

#include <octafront/tet_mesh.h>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace octafront {

/// A direction turned by a period of the mesh; itself by a translation.
Vec3 turned_by_period(const TetMesh& mesh, std::uint32_t period, Vec3 v);

/// Where a period of the mesh leads a place, in the order of operations that TetMesh::periodic_nodes names.
Vec3 led_by_period(const TetMesh& mesh, std::uint32_t period, Vec3 p);

/// What the nodes of a mesh are copies of, by its pairs.
class Originals {
 public:
  /// The mesh must outlive this.
  explicit Originals(const TetMesh& mesh);

  /// The node that this one is a copy of; itself on the axis of a period that is a rotation; kNone: of none.
  VertexIndex of(std::uint32_t period, VertexIndex v) const;
  /// The face that this one is a copy of, corner by corner.
  std::optional<Triangle> of(std::uint32_t period, const Triangle& face) const;

 private:
  const TetMesh& mesh_;
  std::vector<std::map<VertexIndex, VertexIndex>> original_;  ///< per period: of copies
};

}  // namespace octafront
