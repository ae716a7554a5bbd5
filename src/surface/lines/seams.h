#pragma once

#include <octafront/run_context.h>

#include "base/geometry/live_triangles.h"
#include "base/mesh/known_surface.h"
#include "periodic/periodic_cell.h"
#include "surface/edits/coarsen.h"
#include "surface/edits/working_mesh.h"
#include "surface/lines/curves.h"

#include <cstdint>
#include <vector>

namespace octafront::surface {

// How the surface front works on a complex. Along *seams* more than two patches meet, or one ends: there
// no surface is a manifold. So the complex is cut open along them, and each loop of a cut gets a back, a fan of
// triangles around a tip: a closed manifold again, on which everything else works as on a single surface. Backs have no
// shape that matters: nobody puts points there or turns their edges. Vertices on a cut exist once in each part; what
// becomes of them is decided for all of them at once. In the end the backs are dropped and the cuts are sewn.
//
// A periodic complex is cut along the borders of its periodic faces, too. What lies on them has copies at other places,
// and is decided for all of these at once.

/// A complex cut open. Triangle t of the complex is face t of `input`; backs follow.
struct SeamedSurface {
  InputSurface input;
  std::vector<VertexIndex> place;    ///< per vertex of `input`: the vertex of the complex that it is a copy of
  VertexIndex first_tip = 0;         ///< vertices of `input` from here on are tips of backs, copies of nothing
  std::vector<std::uint8_t> pinned;  ///< per vertex of `input`: a corner of the complex, whatever its features say
  Features features;                 ///< those of the complex that are not seams, on the copies; and its corners
  PeriodicFaces periods = {};
  std::vector<VertexIndex> original = {};  ///< as `place`, but by a period's copies, too, the same for all of them
  VerticesByPlace vertex_at = {};          ///< of a periodic complex: its vertices
};

/// REQUIRES a clean complex. Its own patches are kept.
SeamedSurface cut_along_seams(const KnownSurface& complex, PeriodicFaces periods = {});

/// The curves of the cut surface, not divided.
struct SeamedCurves {
  std::vector<Curve> curves;
  std::vector<std::uint32_t> group;  ///< per curve: the first of its copies
  std::vector<std::uint32_t> twin;   ///< the same by copies at other places, too
};

/// Chains the features and seams of the cut surface (`input`, with feature marks). `is_fixed` as of chain_curves();
/// copies of vertices that are corners for one part become fixed for all.
SeamedCurves chained_curves(const InputSurface& input, const SeamedSurface& seamed, const SizeField& sizes,
                            std::vector<std::uint8_t>& is_fixed);

/// The same, divided; those along one seam alike.
std::vector<Curve> divided_curves(const InputSurface& input, const SeamedSurface& seamed, const SizeField& sizes,
                                  std::vector<std::uint8_t>& is_fixed);

/// Collapses the complex's own vertices on seams, in all parts or in none, as remove_input_vertices() does with others.
void coarsen_seams(WorkingMesh& mesh, const PeriodicCell& cell, const RunContext& context, CoarsenCounts& counts);

/// The vertices on seams are corners from here on: seams change no more.
void settle_seams(WorkingMesh& mesh, const SizeField& sizes);

/// Turns or divides edges between vertices on seams that there are in other parts, or on the seams, too: once sewn,
/// they would be one. Faces that are copies have the edges of those that they are copies of. New vertices lie on their
/// own patch of `complex`. Returns how many.
std::uint64_t divide_repeated_edges(WorkingMesh& mesh, const KnownSurface& complex, const PeriodicFaces& periods,
                                    const SizeField& sizes);

/// Divides triangles that other parts have on the same three vertices of seams, by a point of their own patch: once
/// sewn they would lie upon each other, as the two sides of a tiny lens. Returns how many.
std::uint64_t divide_repeated_triangles(WorkingMesh& mesh, const KnownSurface& complex, const PeriodicFaces& periods,
                                        const SizeField& sizes);

/// For each vertex of the working mesh the first one at its place on a seam; others are themselves.
std::vector<VertexIndex> sewn_vertices(const WorkingMesh& mesh);

/// The living triangles that are no backs.
std::vector<std::uint32_t> front_triangles(const WorkingMesh& mesh);

/// The working mesh as LiveTriangles looks at it: sewn, without backs. Seams must not change while it is used.
class SewnMesh {
 public:
  explicit SewnMesh(const WorkingMesh& mesh) : mesh_(mesh) {
    if (mesh.first_back != kNone) sewn_ = sewn_vertices(mesh);
  }

  std::size_t triangle_count() const { return mesh_.triangle_count(); }
  bool is_removed(std::size_t t) const { return mesh_.is_removed(t) || mesh_.is_back(t); }
  Vec3 corner(std::uint32_t t, int i) const { return mesh_.corner(t, i); }
  Triangle triangle(std::uint32_t t) const {
    const Triangle own = mesh_.triangle(t);
    return {vertex(own[0]), vertex(own[1]), vertex(own[2])};
  }
  IdTriangle sewn(const IdTriangle& t) const {
    return {{vertex(t.ids[0]), vertex(t.ids[1]), vertex(t.ids[2])}, t.corners};
  }
  /// Those that came later are not on seams.
  VertexIndex vertex(VertexIndex v) const { return v < sewn_.size() ? sewn_[v] : v; }

 private:
  const WorkingMesh& mesh_;
  std::vector<VertexIndex> sewn_;
};

}  // namespace octafront::surface
