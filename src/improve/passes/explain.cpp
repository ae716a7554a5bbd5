#include "improve/passes/explain.h"

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "improve/passes/mesh_editor.h"
#include "improve/shape/maximize_worst.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace octafront::improve {
namespace {

bool spans_boundary(const EditMesh& mesh, TetIndex t) {
  return std::all_of(mesh.tet(t).begin(), mesh.tet(t).end(), [&](VertexIndex v) { return mesh.on_boundary(v); });
}

class Explainer {
 public:
  Explainer(EditMesh& mesh, float threshold)
      : editor_(mesh), mesh_(mesh), threshold_(threshold), batch_(mesh.objective()) {}

  Shortfall::Cause cause_by_boundary(TetIndex t) {
    if (forced_by_angle(t)) return Shortfall::kWedge;
    if (forced_by_triangle(t)) return Shortfall::kKeptTriangle;
    return spans_boundary(mesh_, t) ? Shortfall::kThin : Shortfall::kNotForced;
  }

 private:
  /// Some boundary edge of t encloses an angle that alone keeps every element there below the threshold.
  bool forced_by_angle(TetIndex t) {
    for (const auto& [i, j] : kTetEdges) {
      editor_.edge_ring(t, i, j, ring_);
      if (ring_.closed) continue;
      const double angle = enclosed_angle(mesh_.point(mesh_.tet(t)[i]), mesh_.point(mesh_.tet(t)[j]));
      if (std::sqrt(kSmallWeight * (1 - elementary::cos(std::min(angle, 1.0)))) < threshold_) return true;
    }
    return false;
  }

  /// Some boundary face of t, or at one of its edges, carries no tetrahedron that reaches the threshold, wherever its
  /// apex: the short edge of a needle spoils all elements around it.
  bool forced_by_triangle(TetIndex t) {
    for (const auto& [i, j] : kTetEdges) {
      editor_.edge_ring(t, i, j, ring_);
      if (ring_.closed) continue;
      const std::size_t n = ring_.tets.size();
      if (poor_behind(ring_.tets.front(), ring_.ring[1]) || poor_behind(ring_.tets.back(), ring_.ring[n - 1]))
        return true;
    }
    return false;
  }

  double enclosed_angle(Vec3 a, Vec3 b) const {
    double sum = 0;
    const Vec3 axis = normalized(b - a);
    for (std::size_t k = 0; k + 1 < ring_.ring.size(); ++k) {
      const Vec3 p = mesh_.point(ring_.ring[k]) - a, q = mesh_.point(ring_.ring[k + 1]) - a;
      const Vec3 u = p - dot(p, axis) * axis, v = q - dot(q, axis) * axis;
      sum += elementary::atan2(length(cross(u, v)), dot(u, v));
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

  MeshEditor editor_;
  const EditMesh& mesh_;
  float threshold_;
  EdgeRing ring_;
  ShapeBatch batch_;
  WorstMaximizer maximizer_;
};

/// Elements that solvers stumble over.
constexpr double kPoorBeta = 0.2, kPoorAngle = 10 * std::numbers::pi / 180;

bool is_poor(const EditMesh& mesh, TetIndex t) {
  const auto [a, b, c, d] = mesh.tet(t);
  const Vec3 p = mesh.point(a), q = mesh.point(b), r = mesh.point(c), s = mesh.point(d);
  const auto cosines = dihedral_cosines(p, q, r, s);
  return tet_radius_ratio(p, q, r, s) < kPoorBeta ||
         *std::max_element(cosines.begin(), cosines.end()) > elementary::cos(kPoorAngle);
}

Shortfall::Cause cause_by_input(const EditMesh& mesh, TetIndex t, const InputForce& force) {
  const auto [a, b, c, d] = mesh.tet(t);
  switch (force.cause_of({mesh.point(a), mesh.point(b), mesh.point(c), mesh.point(d)})) {
    case InputForce::Cause::kWedge:
      return Shortfall::kWedge;
    case InputForce::Cause::kCorner:
      return Shortfall::kCorner;
    case InputForce::Cause::kThin:
      return Shortfall::kThin;
    case InputForce::Cause::kNone:
      break;
  }
  return Shortfall::kNotForced;
}

}  // namespace

Shortfall explain_shortfall(EditMesh& mesh, float threshold, const InputForce* force, const RunContext& context) {
  Shortfall s;
  Explainer explainer(mesh, threshold);
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t) || mesh.shape(t).score >= threshold) continue;
    context.check();
    const Shortfall::Cause cause = force ? cause_by_input(mesh, t, *force) : explainer.cause_by_boundary(t);
    ++s.elements;
    Shortfall::Class& c = s.by_cause[cause];
    ++c.elements;
    if (c.worst == kNone || mesh.worse(t, c.worst)) c.worst = t;
    if (!is_poor(mesh, t)) continue;
    ++s.poor;
    s.poor_not_forced += cause == Shortfall::kNotForced;
  }
  return s;
}

}  // namespace octafront::improve
