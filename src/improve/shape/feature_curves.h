#pragma once

// The feature curves of a surface as paths that a point can walk along.

#include <octafront/ids.h>
#include <octafront/surface_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "base/mesh/features.h"

#include <array>
#include <optional>
#include <vector>

namespace octafront {
struct SurfaceMesh;
}

namespace octafront::improve {

class FeatureCurves {
 public:
  FeatureCurves(const SurfaceMesh& surface, const Features& features);

  /// A point of a curve: on the segment of feature edge `edge`.
  struct Place {
    Vec3 at;
    std::uint32_t edge = kNone;
  };
  /// The nearest point of the curves within `limit` of p.
  std::optional<Place> nearest(Vec3 p, double limit) const;

  /// Unit vector along the curve at a place.
  Vec3 tangent(const Place& place) const;

  /// Where one comes to who walks from `place` along the curve for the length |by|, forward as tangent(place) points if
  /// `by` is positive; nullopt if the curve ends or branches on the way.
  std::optional<Place> walk(const Place& place, double by) const;

 private:
  Vec3 point(VertexIndex v) const { return surface_.points[v]; }
  /// The other feature edge at v, kNone if there is not just one, or v is a corner.
  std::uint32_t next_edge(VertexIndex v, std::uint32_t edge) const;

  const SurfaceMesh& surface_;
  const std::vector<Edge>& edges_;
  std::vector<std::array<std::uint32_t, 2>> at_vertex_;  ///< per vertex: its two feature edges; kNone, kNone elsewhere
  TriangleTree tree_;
};

}  // namespace octafront::improve
