#pragma once

#include "base/geometry/triangle_tree.h"
#include "sizing/field/inside_fraction.h"

#include <optional>
#include <span>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// Whether sheets with these unit normals face each other, or turn their backs: within about 45 degrees. Beyond, they
/// form a corner rather than a wall or a gap.
constexpr bool faces(Vec3 n, Vec3 m) {
  constexpr double kMostCosine = -0.7;
  return dot(n, m) < kMostCosine;
}

/// Walls of one to three layers of elements, whose number follows the surface and not the volume: a plate much thinner
/// than its elements are wide has three of them for two triangles, however thin it is.
class ThinWalls {
 public:
  explicit ThinWalls(const SurfaceMesh& surface) : tree_(surface) {}

  /// How many elements more than the integral of kTetsPerCube / h^3 over the volume these walls will have; below 0:
  /// fewer. `pieces`: the surface, as surface_pieces() leaves it; `sizes`: the size at each of them; `triangles`: how
  /// many the surface has, if it is made by these sizes already. Looks at some thousand places.
  double excess_tets(std::span<const SurfacePiece> pieces, std::span<const double> sizes,
                     std::optional<std::size_t> triangles) const;
  /// How many elements reach from one side of a wall to the other.
  double tets_through(std::span<const SurfacePiece> pieces, std::span<const double> sizes,
                      std::optional<std::size_t> triangles) const;

 private:
  /// A place that was looked at, and what of the surface it stands for.
  struct Place {
    std::size_t piece;
    double squares, walls = 0;  ///< area in squares of the size; thickness in sizes
  };
  struct Look {
    std::vector<Place> places;
    double triangles_per_square;
  };
  Look look(std::span<const SurfacePiece> pieces, std::span<const double> sizes,
            std::optional<std::size_t> triangles) const;
  double thickness(Vec3 p, Vec3 normal, double reach) const;

  TriangleTree tree_;
};

}  // namespace octafront
