#pragma once

#include <octafront/error.h>

#include "fill/recovery/delaunay.h"
#include "fill/recovery/flips.h"
#include "fill/recovery/recovery_task.h"
#include "fill/recovery/segment_walk.h"
#include "fill/recovery/subdivided_surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::recovery {

/// How many points may be made, and how long their coordinates may get: in words of 64 bits.
struct PointLimits {
  std::size_t points, words;
};

/// More points than were allowed are needed with the choices made, or longer ones: other ones may need fewer.
struct TooManyPoints : MeshingError {
  TooManyPoints() : MeshingError("recovery of the surface needs more points than it may make") {}
};

/// Counters of the recovery of edges and facets.
struct RecoveryCounts {
  std::uint64_t missing_edges = 0, edges_by_flips = 0, edge_points = 0, crossing_points = 0;
  std::uint64_t missing_facets = 0, facets_by_flips = 0, facet_points = 0;
};

/// Makes every edge and every facet of a surface a union of edges and faces of the mesh: by flips where they suffice,
/// else by Steiner points on the surface, at exact coordinates. Afterwards each face of the mesh that lies on the
/// surface has the number of its facet in surface.facets() as label.
///
/// It ends: a Steiner point is put strictly inside a crossed tet (or exactly into a crossing), which cuts the segment
/// into parts that together cross nothing more than it did; a part that crosses one face only, between two tets that
/// have its ends as apexes, is made by one flip. Other seeds make other choices, which end in other Steiner points. See
/// docs/how/recovery.md.
class BoundaryRecovery {
 public:
  BoundaryRecovery(const RecoveryTask& task, SubdividedSurface& surface, PointLimits most)
      : points_(task.points),
        mesh_(task.mesh),
        surface_(surface),
        flipper_(task.points, task.mesh, surface.edges()),
        frame_(task.frame),
        context_(task.context),
        most_(most),
        random_(2463534242u + task.seed),
        longest_first_(task.seed % 2 == 1) {}

  /// Throws MeshingError, with the place, if the surface turns out to intersect itself, and TooManyPoints.
  void run();
  const RecoveryCounts& counts() const { return counts_; }

 private:
  void learn_planes();
  [[noreturn]] void refuse_intersection(Vec3 at) const;

  // Edges.
  std::vector<Edge> missing_edges();
  void recover_edges(const std::vector<Edge>& wanted);
  /// `walk`: where the segment passes now; present if it is an edge.
  bool edge_by_flips(VertexIndex a, VertexIndex b, SegmentWalk& walk);
  bool improve_once(const SegmentWalk& walk, const SegmentHindrance& hindrance, bool random);
  bool improve_at(const Crossing& c, const SegmentHindrance& hindrance, bool random);
  VertexIndex divide_edge(VertexIndex a, VertexIndex b, const std::vector<Crossing>& crossings);
  VertexIndex place_inside(VertexIndex a, VertexIndex b, TetIndex tet, double enter, double leave);
  VertexIndex place_at_crossing(VertexIndex a, VertexIndex b, const Crossing& c, double at);
  void insert(VertexIndex s, std::span<const TetIndex> tets);
  Edge line_of(VertexIndex a, VertexIndex b) const;
  Edge crossed_line(VertexIndex x, VertexIndex y) const;
  double parameter(const Edge& line, VertexIndex v) const;

  // Facets.
  /// A convex part of an input triangle, counter-clockwise seen from outside; its sides are edges of the mesh. Corners
  /// may be straight.
  struct Polygon {
    std::vector<VertexIndex> corners;
    std::uint32_t parent;
  };
  void recover_facets();
  void recover_polygon(const Polygon& polygon, std::vector<Polygon>& stack);
  bool adopt_face(const Polygon& polygon, std::vector<Polygon>& stack);
  void divide_polygon(const Polygon& polygon, std::vector<Polygon>& stack);
  int turn(std::uint32_t parent, VertexIndex a, VertexIndex b, VertexIndex c) const;
  bool label_face(const Triangle& corners, std::uint32_t parent);
  HalfFace find_face(const Triangle& f);
  bool facet_by_flips(const Polygon& polygon);
  void crossing_edges(const Polygon& polygon, std::vector<Edge>& edges, std::vector<TetIndex>& tets);
  void crossing_edge_at_side(const Polygon& polygon, std::size_t side, std::vector<Edge>& edges,
                             std::vector<TetIndex>& tets);
  VertexIndex point_on_facet(const Polygon& polygon);

  std::uint32_t random() {
    random_ ^= random_ << 13;
    random_ ^= random_ >> 17;
    return random_ ^= random_ << 5;
  }

  struct Carrier {  ///< the line on which a Steiner point was made
    VertexIndex from = kNone, to = kNone;
    double t = 0;
    Edge crossed{kNone, kNone};  ///< the line of the mesh edge that it divides as well
  };

  ExactPoints& points_;
  LabelledComplex& mesh_;
  SubdividedSurface& surface_;
  Flipper flipper_;
  VertexIndex frame_;
  const RunContext& context_;
  PointLimits most_;
  RecoveryCounts counts_;
  std::vector<Carrier> carrier_;  ///< of vertex frame_ + kFrameVertices + i
  EdgeRing ring_;
  std::uint32_t random_;
  bool longest_first_;
  bool planes_known_ = false;
  bool strict_ = false;  ///< only flips that make a wanted edge at once
};

}  // namespace octafront::recovery
