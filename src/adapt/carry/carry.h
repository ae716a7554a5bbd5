#pragma once

// adapt/carry: what was known on a mesh, on the mesh that was made of it: values at vertices by linear interpolation,
// values of elements such that their integrals stay. Takes two meshes and what became of what; looks only at what has
// changed.

#include <octafront/tet_mesh.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace octafront::adapt {

/// Const and safe on any number of threads; the same values for any number of them. Refers to what it is made of.
class Carrier {
 public:
  /// Both valid and linear; `old_of_new` and `old_tet_of_new` as AdaptedMesh has them.
  Carrier(const TetMesh& before, const TetMesh& now, std::span<const VertexIndex> old_of_new,
          std::span<const TetIndex> old_tet_of_new);
  ~Carrier();
  Carrier(const Carrier&) = delete;
  Carrier& operator=(const Carrier&) = delete;

  /// Values at the vertices of `now`, of those of `before`, `components` numbers each. A vertex that is where it was
  /// has its own bits; another the linear function of the tet that holds it, outside of all that of the nearest one, as
  /// far out as that tet is high and no farther.
  std::vector<double> at_vertices(std::span<const double> values, std::size_t components) const;

  /// Values of the tets of `now`: those of a tet that is unchanged are its own; another has the mean over what it
  /// shares with old ones of its region. Where the region's walls moved, its integral would be missed by a little: that
  /// is spread evenly over those that changed, so the sum of value times volume in each region stays, to rounding.
  std::vector<double> of_tets(std::span<const double> values, std::size_t components) const;

 private:
  struct Tree;

  void spread_rest(std::span<const double> values, std::size_t components, std::vector<double>& made) const;

  const TetMesh& before_;
  const TetMesh& now_;
  std::span<const VertexIndex> old_of_new_;
  std::span<const TetIndex> old_tet_of_new_;
  std::unique_ptr<Tree> tree_;  ///< of the old tets that are gone
};

}  // namespace octafront::adapt
