#pragma once

// improve/passes: the single passes of improvement. Each takes a mesh and a guide of its boundary, looks at places
// that are bad, and changes them for the better. It leaves the mesh valid by exact signs and the worst element, by
// beta, by smallest and by largest dihedral angle, no worse than it was. One thread works on a mesh, which may be a
// piece of a larger one (pieces/); schedule/ decides their order.

#include <octafront/run_context.h>

#include "improve/shape/boundary_guide.h"
#include "improve/shape/edit_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::improve {

/// What a pass did.
struct PassResult {
  std::uint64_t tried = 0;  ///< places looked at
  std::uint64_t done = 0;   ///< places changed

  PassResult& operator+=(const PassResult& o) {
    tried += o.tried, done += o.done;
    return *this;
  }
};

/// Passes ask whether to stop after so many places.
inline constexpr std::size_t kBetweenChecks = 64;

/// When a vertex may go to where the Laplacian wants it.
enum class MoveRule {
  kWorstRises,  ///< the worst beta around the vertex must rise (the paper's smoothing)
  kMeanRises,   ///< the mean beta around it must rise, and its worst score may fall, but not below kMeanRisesGuard
};
/// Elements above this score may get worse in exchange for a better mean.
inline constexpr float kMeanRisesGuard = 0.6f;
/// Stars whose beta are all above it are left alone by moves for the mean: next to nothing moves there, above all not
/// in a lattice.
inline constexpr float kGoodEnough = 0.93f;

/// Sweeps over the inner vertices: each goes the part `relaxation` of the way to the mean of its neighbours, weighted
/// by the length of the edges to them, if the rule allows.
PassResult laplacian_sweeps(EditMesh& mesh, int sweeps, double relaxation, MoveRule rule, const RunContext& context);

/// Sweeps over the vertices: each goes towards where the sum of (1 - beta)^2 around it is least, if that falls and the
/// worst score around it rises or stays above kMeanRisesGuard. Here and below, vertices of the boundary move as the
/// guide says; without one they stay.
PassResult smooth_mean(EditMesh& mesh, int sweeps, const RunContext& context, const BoundaryGuide* guide = nullptr);

/// What a reconnection must make better.
enum class Goal {
  kWorst,  ///< the worst score of the changed place
  kMean,   ///< the sum of (1 - beta)^2 over the changed place, with no new element below kMeanRisesGuard and the old
           ///< ones
  /// The same, looking at edges with rings of up to four only: 2,350 of the 2,360 changes that kMean makes on a mesh of
  /// 190,000 elements, for a third of its time.
  kMeanQuick,
  kFewestPoor,  ///< the sum of what elements lack (fewest_poor.h)
};

/// Removes edges (up to a ring of kLongestRing tetrahedra, by dynamic programming) and faces (2-3 flips) of the
/// elements with a score below `threshold`, wherever that serves the goal; goes on with what it made. With a guide,
/// for the worst, edges of the boundary too: its two triangles there become those on the other diagonal.
PassResult reconnect(EditMesh& mesh, float threshold, Goal goal, const RunContext& context,
                     const BoundaryGuide* guide = nullptr);
inline constexpr int kLongestRing = 7;

/// Takes some tetrahedra around each element with a score below `threshold` away and fills their space anew from the
/// same vertices, where a search (polyhedron_search.h) finds elements all of which score higher than that one.
PassResult reconnect_small_polyhedra(EditMesh& mesh, float threshold, const RunContext& context);

/// Moves the vertices of the elements with a score below `threshold` to where the worst score around them is
/// best, as near as a few steps come, unless that costs the mean too much.
PassResult optimize_vertices(EditMesh& mesh, float threshold, const RunContext& context,
                             const BoundaryGuide* guide = nullptr);

/// Removes inner vertices of elements with a score below `threshold` by collapse onto a neighbour, where that makes the
/// sum of (1 - beta)^2 around them a good deal less, no new edge is too long, and the worst score of the place rises
/// or stays above kMeanRisesGuard.
PassResult collapse_vertices(EditMesh& mesh, float threshold, Goal goal, const RunContext& context);

/// Moves the inner vertices of the elements with a score below `threshold` to where the elements around them lack least
/// in sum (fewest_poor.h).
PassResult relieve_vertices(EditMesh& mesh, float threshold, const RunContext& context);

struct TakenBack {
  PassResult pass;
  std::vector<VertexIndex> crossing;  ///< vertices of triangles of the boundary
                                      ///< that still cross, and of those around
};
/// Where triangles of the boundary have come to cross, their vertices and those around go back to where they were when
/// the mesh was taken, `home` by their numbers, or part of the way, as long as that makes no element worse than the
/// worst.
TakenBack take_back_crossings(EditMesh& mesh, std::span<const Vec3> home, const BoundaryGuide& guide,
                              const RunContext& context);

struct BoundaryEdits {
  PassResult result;
  double largest_move = 0;  ///< of a vertex, in one step; input units
};
/// Collapses edges of the boundary and moves its vertices at the elements with a score below `threshold` that the input
/// does not force (input_force.h), worst first, where the elements around lack less in sum then: inside patches and
/// along curves, curves and corners giving way below 0.2 only. The boundary stays as near to the input as the guide's
/// tolerance and a quarter of its edges, or as it was, exactly without crossings. Its triangles become fewer.
BoundaryEdits edit_boundary(EditMesh& mesh, float threshold, BoundaryGuide& guide, const RunContext& context);

/// Replaces elements with a score below `threshold`, worst first, and some around them, by the star of a new vertex
/// where that serves the goal: kWorst or kFewestPoor.
PassResult insert_vertices(EditMesh& mesh, float threshold, Goal goal, const RunContext& context);

/// Replaces elements that span an edge of a thin wall and the one right behind it, flat up to rounding, and those
/// around one of their edges, by the star of a new vertex.
PassResult open_flat_elements(EditMesh& mesh, const RunContext& context);

}  // namespace octafront::improve
