#include "fill/lattice/snap_features.h"

#include <octafront/error.h>

#include "base/core/groups.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/edge_table.h"

#include <algorithm>
#include <tuple>

#include <fmt/core.h>

namespace octafront {

namespace {

/// A vertex moves at most this far, in units of the size there: about half an edge of the lattice and the warp's reach.
constexpr double kReach = 0.7;
/// What beta a move may leave. Where boundary faces meet at a crease the lattice cannot do much better than this, and
/// improvement starts from it; below it the crease is rather left blunt.
constexpr double kLeastBeta = 0.12;

/// Two vertices near a curve lie on different sides of it if the surface turns by this much between them: curves fade
/// out, so their sides may be one part of the surface.
constexpr double kCosOfSides = 0.866;

class Snapper {
 public:
  Snapper(TetMesh& mesh, const SurfaceMesh& surface, const Features& features, const TriangleTree& triangles,
          const SizeField& sizes)
      : mesh_(mesh),
        surface_(surface),
        features_(features),
        triangles_(triangles),
        sizes_(sizes),
        before_(mesh.points),
        fixed_(mesh.points.size(), 0),
        star_(boundary_stars()) {}

  std::size_t corners = 0, on_curves = 0, refused = 0, undone = 0;

  void snap_corners() {
    const TriangleTree boundary(mesh_.points, mesh_.boundary);
    for (const VertexIndex corner : features_.corners) {
      const Vec3 p = surface_.points[corner];
      const double reach = kReach * sizes_.at(p);
      std::vector<std::pair<double, VertexIndex>> near;
      boundary.for_each_overlapping({p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}},
                                    [&](std::uint32_t face) {
                                      for (const VertexIndex v : mesh_.boundary[face])
                                        near.emplace_back(distance(mesh_.points[v], p), v);
                                    });
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
      for (const auto& [d, v] : near) {
        if (d > reach || fixed_[v]) continue;
        if (!move(v, p)) continue;
        ++corners;
        break;
      }
    }
  }

  /// Boundary edges with ends on different sides of a curve cross it: one end goes onto it.
  void snap_curves(const RunContext& context) {
    const TriangleTree curves = tree_of_segments(surface_.points, features_.edges);
    struct Goal {
      double squared_distance;
      VertexIndex vertex;
      Vec3 at;
    };
    std::vector<Goal> goal(mesh_.points.size());
    std::vector<Vec3> normal(mesh_.points.size());  // zero: not near a curve
    for (const VertexIndex v : boundary_vertices()) {
      const Vec3 p = mesh_.points[v];
      const double reach = kReach * sizes_.at(p);
      const auto nearest = curves.nearest(p, reach * reach);
      if (nearest.triangle == kNone) continue;
      goal[v] = {nearest.squared_distance, v, nearest.point};
      const auto& [a, b, c] = triangles_.corners(triangles_.nearest(p).triangle);
      normal[v] = unit_normal(a, b, c);
    }
    struct Crossing {
      double squared_distance;
      VertexIndex near, far;
    };
    std::vector<Crossing> crossings;
    for (const auto& [a, b] : make_edge_table(mesh_.points.size(), mesh_.boundary).edges) {
      if (normal[a] == Vec3{} || normal[b] == Vec3{} || dot(normal[a], normal[b]) > kCosOfSides) continue;
      const bool a_nearer = goal[a].squared_distance <= goal[b].squared_distance;
      const VertexIndex near = a_nearer ? a : b, far = a_nearer ? b : a;
      crossings.push_back({goal[near].squared_distance, near, far});
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& s, const Crossing& t) {
      return std::tie(s.squared_distance, s.near, s.far) < std::tie(t.squared_distance, t.near, t.far);
    });
    for (const Crossing& c : crossings) {
      context.check();
      if (fixed_[c.near] || fixed_[c.far]) continue;
      if (move(c.near, goal[c.near].at) || move(c.far, goal[c.far].at))
        ++on_curves;
      else
        ++refused;
    }
  }

  /// No tetrahedra outside hold two parts of the boundary apart: where moves made it meet itself, they are undone.
  void undo_meetings(const RunContext& context) {
    for (;;) {
      context.check();
      const auto meeting = self_intersections(mesh_.points, mesh_.boundary);
      if (meeting.empty()) return;
      const std::size_t before = undone;
      for (const auto& pair : meeting)
        for (const std::uint32_t face : pair)
          for (const VertexIndex v : mesh_.boundary[face]) undo(v);
      if (undone > before) continue;
      const Vec3 p = mesh_.points[mesh_.boundary[meeting.front()[0]][0]];
      throw MeshingError(
          fmt::format("the boundary cut from the lattice meets itself at {} places, the first near "
                      "({:.9g}, {:.9g}, {:.9g}); choose a smaller element size there",
                      meeting.size(), p.x, p.y, p.z));
    }
  }

 private:
  std::vector<VertexIndex> boundary_vertices() const {
    std::vector<VertexIndex> vertices;
    for (const Triangle& t : mesh_.boundary) vertices.insert(vertices.end(), t.begin(), t.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  Groups<TetIndex> boundary_stars() const {
    std::vector<char> on_boundary(mesh_.points.size(), 0);
    for (const Triangle& t : mesh_.boundary)
      for (const VertexIndex v : t) on_boundary[v] = 1;
    return {mesh_.points.size(), [&](const auto& add) {
              for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
                for (const VertexIndex v : mesh_.tets[t])
                  if (on_boundary[v]) add(v, t);
            }};
  }

  bool move(VertexIndex v, Vec3 to) {
    const Vec3 old = mesh_.points[v];
    mesh_.points[v] = to;
    for (const TetIndex i : star_[v]) {
      const Tet& t = mesh_.tets[i];
      const Vec3 a = mesh_.points[t[0]], b = mesh_.points[t[1]], c = mesh_.points[t[2]], d = mesh_.points[t[3]];
      if (orient3d(a, b, c, d) > 0 && tet_radius_ratio(a, b, c, d) >= kLeastBeta) continue;
      mesh_.points[v] = old;
      return false;
    }
    fixed_[v] = 1;
    return true;
  }

  /// With it go the moves that would leave a tetrahedron around it turned over.
  void undo(VertexIndex vertex) {
    std::vector<VertexIndex> open{vertex};
    while (!open.empty()) {
      const VertexIndex v = open.back();
      open.pop_back();
      if (!fixed_[v]) continue;
      fixed_[v] = 0;
      mesh_.points[v] = before_[v];
      ++undone;
      for (const TetIndex i : star_[v]) {
        const Tet& t = mesh_.tets[i];
        if (orient3d(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]], mesh_.points[t[3]]) <= 0)
          open.insert(open.end(), t.begin(), t.end());
      }
    }
  }

  TetMesh& mesh_;
  const SurfaceMesh& surface_;
  const Features& features_;
  const TriangleTree& triangles_;
  const SizeField& sizes_;
  const std::vector<Vec3> before_;
  std::vector<char> fixed_;  ///< moved
  Groups<TetIndex> star_;    ///< the tetrahedra at each vertex of the boundary
};

}  // namespace

void snap_features(TetMesh& mesh, const SurfaceMesh& surface, const Features& features, const TriangleTree& triangles,
                   const SizeField& sizes, const Stage& stage) {
  Snapper snapper(mesh, surface, features, triangles, sizes);
  snapper.snap_corners();
  if (!features.edges.empty()) snapper.snap_curves(stage.context());
  snapper.undo_meetings(stage.context());
  stage.count("vertices snapped to corners", static_cast<double>(snapper.corners));
  stage.count("vertices snapped to curves", static_cast<double>(snapper.on_curves));
  stage.count("snaps undone where the boundary met itself", static_cast<double>(snapper.undone));
  stage.count("crossings left blunt", static_cast<double>(snapper.refused));
}

}  // namespace octafront
