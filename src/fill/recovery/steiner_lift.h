#pragma once

#include "base/mesh/tet_complex.h"
#include "fill/recovery/delaunay.h"
#include "fill/recovery/recovery_task.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace octafront::recovery {

struct LiftCounts {
  std::uint64_t collapsed = 0, lifted = 0, deferred = 0, removed = 0;  ///< removed: after they were lifted
};

/// Takes the Steiner points off the surface: after run() the boundary of the mesh is the input's triangles, one for
/// one, and all points are doubles. Points that can be merged into a neighbour on the surface are, the others move
/// inside.
class SteinerLift {
 public:
  /// `triangles`: those to which what lies across boundary faces refers, counter-clockwise seen from outside of the
  /// region. Vertices behind the frame are Steiner points.
  SteinerLift(const RecoveryTask& task, const std::vector<Triangle>& triangles)
      : points_(task.points),
        mesh_(task.mesh),
        triangles_(triangles),
        first_steiner_(task.frame + kFrameVertices),
        frame_(task.frame),
        context_(task.context),
        random_(88172645463325252u + task.seed) {}

  /// The points for which no place of doubles was found; the mesh is done if there are none.
  std::vector<VertexIndex> run();
  const LiftCounts& counts() const { return counts_; }

 private:
  /// The boundary faces around a Steiner point that lie on one input triangle: fans over the chain of its vertices,
  /// counter-clockwise seen from outside. Closed (the point lies inside the triangle) or open (on its edge).
  struct Fan {
    std::uint32_t parent = kNone;
    std::vector<VertexIndex> chain;
    bool closed = false;
  };

  void split_umbrellas();
  std::vector<Fan> fans_around(VertexIndex s);
  bool triangulate(const Fan& fan, std::vector<TetComplex::BoundaryFace>& faces) const;
  bool is_ear(const std::vector<VertexIndex>& polygon, std::size_t i, VertexIndex off_plane, int up) const;
  VertexIndex off_plane(std::uint32_t parent) const;

  bool collapse(VertexIndex s);
  double collapse_quality(VertexIndex s, VertexIndex target, double at_least) const;
  void collapse_onto(VertexIndex s, VertexIndex target);

  bool merge_inside(VertexIndex v);

  bool lift(VertexIndex s, int round);
  bool grow_cavity(VertexIndex s, Vec3 x, std::size_t limit);
  double cavity_quality(Vec3 x, const std::vector<TetComplex::BoundaryFace>& boundary) const;
  /// What lies around a point on the surface.
  struct Outlook {
    Vec3 inward, middle;  ///< inward: a unit vector; middle: from the point to the mean of its star's vertices
    double size = 0;      ///< distance of the farthest of them
  };
  Outlook outlook(VertexIndex s, const std::vector<Fan>& fans) const;
  /// The k-th direction in which a place is sought.
  Vec3 direction(const Outlook& outlook, int k);
  bool sees_fans(Vec3 x, const std::vector<Fan>& fans) const;
  /// Inside, where the worst element of the cavity around it is best; `boundary`: the faces without s.
  std::optional<Vec3> best_place(VertexIndex s, const std::vector<Fan>& fans,
                                 const std::vector<TetComplex::BoundaryFace>& boundary, int round);
  /// Moves s there. False if its cavity cannot be grown.
  bool place(VertexIndex s, Vec3 x, const std::vector<TetComplex::BoundaryFace>& boundary);
  double random_unit();

  ExactPoints& points_;
  TetComplex& mesh_;
  const std::vector<Triangle>& triangles_;
  VertexIndex first_steiner_, frame_;
  const RunContext& context_;
  LiftCounts counts_;
  std::vector<TetIndex> star_, cavity_;
  std::vector<Triangle> rim_;
  std::uint64_t random_;
};

}  // namespace octafront::recovery
