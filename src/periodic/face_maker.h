#pragma once

// What both ways to make faces the same have in common: parts of faces and their lines, triangles divided at their
// edges, surfaces rebuilt.

#include <octafront/surface_mesh.h>

#include "base/core/function_ref.h"
#include "periodic/make_periodic.h"
#include "periodic/periodic_cell.h"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace octafront::periods {

/// What a triangle of the surface is, beside its corners.
struct FaceKind {
  std::uint32_t patch;
  Sides sides;
  std::uint32_t origin;
  CellFace face;  ///< where it is known
};

/// New triangles of a surface, of which nothing is read any more.
struct Rebuilt {
  std::vector<Triangle> triangles;
  std::vector<FaceKind> kinds;
  void add(const Triangle& t, const FaceKind& kind) { triangles.push_back(t), kinds.push_back(kind); }
};

/// Adds a triangle divided where its edges have vertices between their ends: from the lower end of the edge on.
void add_divided(const Triangle& t, const FaceKind& kind, const std::map<Edge, std::vector<VertexIndex>>& between,
                 Rebuilt& to);

/// The triangles of a surface on one face of the cell, and the parts that patches and regions divide them into.
struct FaceParts {
  std::vector<std::uint32_t> triangles;  ///< ascending
  std::vector<std::uint32_t> part;       ///< per entry of `triangles`
  std::vector<std::uint32_t> first;      ///< per part: a triangle of it
  /// Edges of one triangle of a part, and the part; and with kNone edges within a part at which walls end that are
  /// not on the face. Vertices of the surface, the lower one first.
  std::vector<std::pair<Edge, std::uint32_t>> lines;
  std::vector<VertexIndex> touched;  ///< vertices of triangles that are not on the face
};

/// Of the triangles that `has`; `is_on`: whether a vertex lies on the face.
FaceParts parts_of_face(const SurfaceMesh& surface, FunctionRef<bool(std::uint32_t)> has,
                        FunctionRef<bool(VertexIndex)> is_on);

/// Vertices in the order of one of their coordinates.
class VerticesAlong {
 public:
  VerticesAlong(const std::vector<Vec3>& points, std::vector<VertexIndex> vertices, int axis);
  /// The nearest one to p within reach; kNone: none.
  VertexIndex nearest(Vec3 p, double reach) const;

 private:
  const std::vector<Vec3>& points_;
  std::vector<VertexIndex> vertices_;
  int axis_;
};

/// A surface whose faces are made the same, and what was done to it.
class FaceMaker {
 protected:
  /// Gives all triangles patches and sides, where there are none.
  FaceMaker(SurfaceMesh& surface, const RunContext& context);

  const PeriodicCell& cell() const { return made_.cell; }
  FaceKind kind_of(std::uint32_t t) const { return {surface_.patch[t], surface_.sides[t], made_.origin[t], face_[t]}; }
  /// Counts moves that are longer than from a place to the grid.
  void move(Vec3& p, Vec3 to);
  /// Whether the low triangles, led by the period, are the high ones.
  bool are_same(int period, const std::vector<std::uint32_t>& low, const std::vector<std::uint32_t>& high) const;
  /// The surface gets these triangles; points without any go.
  void take(Rebuilt rebuilt);
  /// With names of faces and with sources; plain again if it was before.
  MadePeriodic made();

  SurfaceMesh& surface_;
  const RunContext& context_;
  const double diagonal_, tolerance_;  ///< kSamePlace of the diagonal
  std::vector<CellFace> face_;         ///< per triangle; kNone: on none, or not known
  MadePeriodic made_;

 private:
  std::vector<std::uint32_t> source_;
  bool is_plain_;
};

}  // namespace octafront::periods
