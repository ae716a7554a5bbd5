#include "improve/explain.h"

#include "geometry/measures.h"
#include "improve/edit_block.h"
#include "improve/maximize_worst.h"

#include <algorithm>
#include <cmath>

namespace octafront::improve {
namespace {

class Explainer {
 public:
  Explainer(EditMesh& mesh, float threshold)
      : block_(mesh), mesh_(mesh), threshold_(threshold), batch_(mesh.objective()) {}

  /// Some boundary edge of t encloses an angle that alone keeps every element there below the threshold.
  bool forced_by_angle(TetIndex t) {
    for (const auto& [i, j] : kTetEdges) {
      block_.edge_ring(t, i, j, ring_);
      if (ring_.closed) continue;
      const double angle = enclosed_angle(mesh_.point(mesh_.tet(t)[i]), mesh_.point(mesh_.tet(t)[j]));
      if (std::sqrt(kSmallWeight * (1 - std::cos(std::min(angle, 1.0)))) < threshold_) return true;
    }
    return false;
  }

  /// Some boundary face of t, or at one of its edges, carries no tetrahedron that reaches the threshold, wherever its
  /// apex: the short edge of a needle spoils all elements around it.
  bool forced_by_triangle(TetIndex t) {
    for (const auto& [i, j] : kTetEdges) {
      block_.edge_ring(t, i, j, ring_);
      if (ring_.closed) continue;
      const std::size_t n = ring_.tets.size();
      if (poor_behind(ring_.tets.front(), ring_.ring[1]) || poor_behind(ring_.tets.back(), ring_.ring[n - 1]))
        return true;
    }
    return false;
  }

 private:
  double enclosed_angle(Vec3 a, Vec3 b) const {
    double sum = 0;
    const Vec3 axis = normalized(b - a);
    for (std::size_t k = 0; k + 1 < ring_.ring.size(); ++k) {
      const Vec3 p = mesh_.point(ring_.ring[k]) - a, q = mesh_.point(ring_.ring[k + 1]) - a;
      const Vec3 u = p - dot(p, axis) * axis, v = q - dot(q, axis) * axis;
      sum += std::atan2(length(cross(u, v)), dot(u, v));
    }
    return sum;
  }

  /// True if the boundary face of t opposite a corner carries no tetrahedron that reaches the threshold.
  bool poor_behind(TetIndex t, VertexIndex corner) { return best_on_face(t, mesh_.corner_of(t, corner)) < threshold_; }

  double best_on_face(TetIndex t, int i) {
    constexpr int kSteps = 60;
    const auto& f = kTetFaces[i];
    const Tet& c = mesh_.tet(t);
    const Vec3 p = mesh_.point(c[f[0]]), q = mesh_.point(c[f[1]]), r = mesh_.point(c[f[2]]);
    batch_.size = 0;
    batch_.add(p, q, r);
    const double edge = std::sqrt(longest_squared_edge(p, q, r));
    // The triangle faces outward: the apex of a regular tetrahedron lies against its normal.
    maximizer_.climb(batch_, centroid(p, q, r) - 0.8 * edge * unit_normal(p, q, r), kSteps, [](Vec3) { return true; });
    return maximizer_.worst();
  }

  EditBlock block_;
  const EditMesh& mesh_;
  float threshold_;
  EdgeRing ring_;
  ShapeBatch batch_;
  WorstMaximizer maximizer_;
};

bool spans_boundary(const EditMesh& mesh, TetIndex t) {
  return std::all_of(mesh.tet(t).begin(), mesh.tet(t).end(), [&](VertexIndex v) { return mesh.on_boundary(v); });
}

}  // namespace

Shortfall explain_shortfall(EditMesh& mesh, float threshold) {
  Shortfall s;
  Explainer explainer(mesh, threshold);
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t) || mesh.shape(t).score >= threshold) continue;
    ++s.elements;
    if (explainer.forced_by_angle(t)) {
      ++s.forced_by_angle;
    } else if (explainer.forced_by_triangle(t)) {
      ++s.forced_by_triangle;
    } else if (spans_boundary(mesh, t)) {
      ++s.in_thin_places;
    } else {
      ++s.not_forced;
      if (s.worst_not_forced == kNone || mesh.shape(t).score < mesh.shape(s.worst_not_forced).score)
        s.worst_not_forced = t;
    }
  }
  return s;
}

}  // namespace octafront::improve
