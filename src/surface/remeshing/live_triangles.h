#pragma once

#include "geometry/triangle_tree.h"
#include "surface/remeshing/working_mesh.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace octafront::remeshing {

/// A triangle that is to come, or one of the mesh.
struct IdTriangle {
  Triangle ids;
  TriangleCorners corners;
};

/// Finds what a triangle crosses in a working mesh while that changes: a tree over the triangles as they were, made
/// when it is first needed, and a list of those that changed since.
class LiveTriangles {
 public:
  /// The mesh must outlive this.
  explicit LiveTriangles(const WorkingMesh& mesh) : mesh_(mesh), is_changed_(mesh.triangle_count(), 0) {}

  TriangleCorners corners(std::uint32_t t) const {
    return {mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2)};
  }
  /// Without area: such a triangle meets all and none.
  static bool is_degenerate(const TriangleCorners& t);

  /// How many triangles of the mesh, but those of `old`, meet this one where they should not, exactly; counts no
  /// further than to `enough`.
  int crossings(const IdTriangle& made, std::span<const std::uint32_t> old, int enough);
  /// Pairs of triangles that meet so, of which one at least is among these.
  int crossings_among(std::span<const std::uint32_t> triangles);
  /// The same for triangles that are to come in the place of `old`, about as far as to `enough`.
  int crossings_among(std::span<const IdTriangle> made, std::span<const std::uint32_t> old, int enough);

  /// To be called for what changed, appeared or vanished.
  void note_changed(std::span<const std::uint32_t> triangles);

 private:
  void plant_tree();

  const WorkingMesh& mesh_;
  std::optional<TriangleTree> tree_;      ///< of the mesh as it was
  std::vector<std::uint32_t> in_tree_;    ///< its triangles
  std::vector<std::uint8_t> is_changed_;  ///< per triangle: no longer the one in the tree
  std::vector<std::uint32_t> changed_;    ///< and alive
};

}  // namespace octafront::remeshing
