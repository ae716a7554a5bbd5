#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/vec.h>

#include "base/core/groups.h"
#include "images/nets/net.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::nets {

/// Vertices on opposite faces of the cell of an image that goes on periodically, which are copies of each other.
class Mates {
 public:
  Mates() = default;
  /// Starts of mates become the same, too.
  Mates(const Lattice& lattice, Net& net);

  /// Mates come to where the first one is, each on its own faces.
  void bring_together(const Lattice& lattice, const Net& net, std::vector<Vec3>& x) const;
  /// Adds the mates of those listed; some may be there twice then.
  void add_to(std::vector<VertexIndex>& vertices) const;

 private:
  std::vector<std::vector<VertexIndex>> sets_;
  std::vector<std::uint32_t> set_of_;  ///< per vertex; kNone: it has no mates
};

/// Which quads certainly cross no other of these, so that exact tests are left to the rest.
///
/// Each corner's cell, the box between the middles of its eight voxels, has one vertex strictly within. The way between
/// the vertices of two cells side by side passes the face between them, since both cells together are convex. So the
/// four tetrahedra of the middles of two voxels and a side of the quad between these, for all quads, have no inner
/// point in common. A quad whose two triangles have both middles strictly on their right sides lies within its own four
/// tetrahedra, and touches their surface in its sides only (T. Ju, T. Udeshi, "Intersection-Free Contouring on an
/// Octree Grid", 2006). All of that for the vertices in the world too, which rounding puts a little elsewhere.
class Shelters {
 public:
  /// `x`: where the vertices are; straight space.
  Shelters(const Net& net, const Lattice& lattice, std::span<const Vec3> x);

  bool holds(std::uint32_t quad) const;

 private:
  bool is_home(VertexIndex v) const;

  const Net& net_;
  const Lattice& lattice_;
  std::span<const Vec3> x_;
  Vec3 unit_;     ///< the longest voxel along each axis
  double least_;  ///< six times the volume of a tetrahedron whose sign rounding does not change
};

/// Quads at fault, ascending, each once.
struct Conflicts {
  /// Quads with triangles that cross others or have no area, and quads around an edge where they do not follow each
  /// other in the order of the regions between them.
  std::vector<std::uint32_t> invalid;
  /// Quads that leave a region only a sharp wedge between them, or lie at sharp corners of curves: no good element fits
  /// into such places. Quads whose vertices may not yield are not among them.
  std::vector<std::uint32_t> sharp;
  bool empty() const { return invalid.empty() && sharp.empty(); }
};

/// What keeps a net from being a complex, exactly, and from being a good one, found in layers of the lattice so that
/// memory stays small.
class ConflictSearch {
 public:
  /// `x`, `world`: the vertices in straight space and in the world. `may_yield`: per vertex, whether the vertex may be
  /// asked to go back where the net is sharp.
  ConflictSearch(const Net& net, const Lattice& lattice, std::span<const Vec3> x, std::span<const Vec3> world,
                 std::span<const std::uint8_t> may_yield);

  Conflicts all(const RunContext& context) const;
  /// The same of the quads near moved vertices.
  Conflicts near(const std::vector<VertexIndex>& moved, const RunContext& context) const;

 private:
  struct Part;
  struct CurveEnd;
  void search(const Part& part, Conflicts& found, const RunContext& context) const;
  std::vector<std::uint32_t> quads_that_may_cross(const Part& part) const;
  void find_crossings(const Part& part, Conflicts& found, const RunContext& context) const;
  void find_around_edges(const Part& part, Conflicts& found) const;
  void find_sharp_corners(std::vector<CurveEnd> ends, Conflicts& found) const;
  void find_folds(const Part& part, Conflicts& found) const;
  void add_sharp(std::uint32_t quad, Conflicts& found) const;

  const Net& net_;
  Shelters shelters_;
  std::span<const Vec3> world_;
  bool is_mirrored_;
  std::span<const std::uint8_t> may_yield_;
};

/// The vertices that make a complex of the net, and what that took.
struct ResolvedNet {
  std::vector<Vec3> world;       ///< per vertex
  std::uint64_t conflicts = 0;   ///< quads at fault at first
  std::uint64_t sharp = 0;       ///< quads that left sharp wedges at first
  std::uint64_t moved_back = 0;  ///< vertices
  std::uint64_t joined = 0;      ///< vertices that became one with others of their corner
};

/// Makes a complex of a net whose vertices were moved to x (straight space). The vertices of quads at fault go halfway
/// back to where they started, again and again, and then all the way. Where a quad is at fault even then, and not only
/// sharp, all vertices of a corner of the lattice become one vertex at that corner. Between such vertices quads are
/// faces of voxels, which do not cross, so the function always ends with a complex. `mates`: what is done to one vertex
/// is done to these, too.
ResolvedNet resolve_conflicts(Net& net, const Groups<>& quads_at, const Lattice& lattice, std::vector<Vec3>& x,
                              const RunContext& context, const Mates& mates = {});

}  // namespace octafront::nets
