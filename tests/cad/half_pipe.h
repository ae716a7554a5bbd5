#pragma once

#include "cad/model/cad_model.h"

namespace octafront::cad {

/// A half-pipe of two quarters, radius 1, length `length`, that meet smoothly along a line, both with a lid beside: the
/// plane y = 0 for x > 1. Faces 0 and 1 are the quarters, 2 the lid.
inline CadModel half_pipe(double length) {
  CadModel m;
  const double h = 0.70710678118654752;
  for (const double z : {0.0, length})
    for (const Vec3 p : {Vec3{1, 0, 0}, Vec3{h, h, 0}, Vec3{0, 1, 0}, Vec3{-h, h, 0}, Vec3{-1, 0, 0}, Vec3{3, 0, 0}})
      m.points.push_back({p.x, p.y, z});
  const auto strip = [&](VertexIndex a, VertexIndex b, std::uint32_t face, Uv low, Uv high) {
    m.triangles.push_back({a, b, b + 6}), m.triangles.push_back({a, b + 6, a + 6});
    m.face_of.insert(m.face_of.end(), 2, face);
    m.corners.push_back({low, Uv{high.u, low.v}, high}), m.corners.push_back({low, high, Uv{low.u, high.v}});
  };
  const double eighth = 0.78539816339744831;
  for (std::uint32_t k = 0; k < 4; ++k) strip(k, k + 1, k / 2, {k * eighth, 0}, {(k + 1) * eighth, length});
  strip(5, 0, 2, {3, 0}, {1, length});
  Face quarter;
  quarter.surface.kind = SurfaceRecord::Kind::kCylinder;
  quarter.surface.radius = 1;
  quarter.area = 2 * eighth * length;
  Face lid;
  lid.surface.kind = SurfaceRecord::Kind::kPlane;
  lid.surface.frame = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  lid.area = 2 * length;
  m.faces = {quarter, quarter, lid};
  m.faces[1].labels.name = "left";
  const auto line = [&](VertexIndex at, std::vector<std::uint32_t> faces, bool smooth) {
    CadEdge edge;
    edge.curve.kind = CurveRecord::Kind::kLine;
    edge.curve.frame = {m.points[at], {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    edge.vertices = {at, at + 6}, edge.parameters = {0, length};
    edge.faces = std::move(faces), edge.length = length, edge.is_smooth = smooth;
    m.edges.push_back(edge);
  };
  line(2, {0, 1}, true), line(0, {0, 2}, false);
  m.vertices = {0, 2, 6, 8};
  return m;
}

}  // namespace octafront::cad
