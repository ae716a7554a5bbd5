#pragma once

// How many elements sizes come to, before any is made: by a field (here), and by a wish alone, so
// that what no mesh can hold is refused before anything is divided (affordable.h).

#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>

#include "sizing/field/octree_field.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

namespace octafront {

class ThinWalls;

/// How many tetrahedra a mesh of the inside of a surface by given sizes will have: the integral of c / h^3, where c is
/// measured; in walls of few layers as many as the triangles of their surface ask for. Refers to `surface`, which must
/// outlive the prediction.
class TetPrediction {
 public:
  explicit TetPrediction(const SurfaceMesh& surface);
  ~TetPrediction();
  /// `triangles`: how many the surface has, if it is made by these sizes already.
  double operator()(const SizeField& sizes, std::optional<std::size_t> triangles = {}) const;

  /// Those of them that reach through thin walls.
  double through_walls(const SizeField& sizes, std::optional<std::size_t> triangles = {}) const;

  /// The same for other sizes on the leaves of `grid`. Both `grid` and this prediction must outlive what is returned.
  std::function<double(const OctreeField&)> on_leaves_of(const OctreeField& grid) const;

  /// Triangles between the inside and the outside.
  std::size_t triangles() const { return surface_.triangles.size(); }

 private:
  const SurfaceMesh hull_;  ///< of a complex
  const SurfaceMesh& surface_;
  std::unique_ptr<const ThinWalls> walls_;
};

/// The prediction for one size field.
double expected_tets(const SizeField& sizes, const SurfaceMesh& surface);
/// The prediction within a surface that was made by these sizes, or is kept: its triangles are known.
double expected_tets_within(const SizeField& sizes, const SurfaceMesh& made);

/// Of those the ones that reach from one side of a wall to the other.
double expected_tets_through_walls(const SizeField& sizes, const SurfaceMesh& made);

/// The mean edge length of one level of a lattice whose cells come in powers of two of this length. A cell is divided
/// while its edges are longer than kLatticeTooLong times the wanted ones. The length is chosen so that the lattice
/// inside `surface` has as many elements as the sizes ask for, and near the sizes of the surface.
double lattice_cell_size(const SizeField& sizes, const SurfaceMesh& surface);
inline constexpr double kLatticeTooLong = 1.5;

}  // namespace octafront
