#include "support/thin_surfaces.h"

#include <cmath>
#include <numbers>

namespace octafront::testing {

namespace {

void add_ring(SurfaceMesh& mesh, VertexIndex sides, double radius, double z) {
  for (VertexIndex k = 0; k < sides; ++k) {
    const double a = 2 * std::numbers::pi * k / sides;
    mesh.points.push_back({radius * std::cos(a), radius * std::sin(a), z});
  }
}

/// Triangles between a ring and a point, which looks up or down on it.
void add_fan(SurfaceMesh& mesh, VertexIndex first, VertexIndex sides, VertexIndex tip, bool is_above) {
  for (VertexIndex k = 0; k < sides; ++k) {
    const VertexIndex a = first + k, b = first + (k + 1) % sides;
    mesh.triangles.push_back(is_above ? Triangle{a, b, tip} : Triangle{b, a, tip});
  }
}

}  // namespace

SurfaceMesh rod(VertexIndex sides, double radius, double length) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, length}};
  add_ring(mesh, sides, radius, 0);
  add_ring(mesh, sides, radius, length);
  add_fan(mesh, 2, sides, 0, false);
  add_fan(mesh, 2 + sides, sides, 1, true);
  for (VertexIndex k = 0; k < sides; ++k) {
    const VertexIndex a = 2 + k, b = 2 + (k + 1) % sides;
    mesh.triangles.push_back({a, b, b + sides});
    mesh.triangles.push_back({a, b + sides, a + sides});
  }
  return mesh;
}

SurfaceMesh needle(VertexIndex sides, double radius, double length) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, length}};
  add_ring(mesh, sides, radius, 0);
  add_fan(mesh, 2, sides, 0, false);
  add_fan(mesh, 2, sides, 1, true);
  return mesh;
}

}  // namespace octafront::testing
