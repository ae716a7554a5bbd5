#include "base/dual/poly_measures.h"

#include "base/core/parallel.h"

#include <algorithm>
#include <array>
#include <vector>

namespace octafront {
namespace dual {
namespace {

/// Calls visit(a, b) for the sides of a face, seen from outside the cell.
template <class Visit>
void for_each_side(const PolyMesh& mesh, std::size_t face, std::uint32_t cell, const Visit& visit) {
  const auto points = mesh.face(face);
  const bool is_owner = mesh.owner[face] == cell;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 a = mesh.points[points[i]], b = mesh.points[points[(i + 1) % points.size()]];
    is_owner ? visit(a, b) : visit(b, a);
  }
}

/// Calls visit(six volumes, centre of mass) for the tetrahedra between a point and the triangles of a cell's faces.
template <class Visit>
void for_each_tet(const PolyMesh& mesh, std::uint32_t cell, std::span<const std::uint32_t> faces, Vec3 from,
                  const Visit& visit) {
  for (const std::uint32_t f : faces) {
    const Vec3 middle = mean_of(mesh, f) - from;
    for_each_side(mesh, f, cell, [&](Vec3 a, Vec3 b) {
      visit(dot(cross(a - from, b - from), middle), (a - from + (b - from) + middle) / 4);
    });
  }
}

}  // namespace

Groups<> faces_of_cells(const PolyMesh& mesh) {
  return {mesh.cells(), [&](const auto& add) {
            for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
              add(mesh.owner[f], f);
              if (f < mesh.inner_faces()) add(mesh.neighbour[f], f);
            }
          }};
}

Vec3 mean_of(const PolyMesh& mesh, std::size_t face) {
  Vec3 sum;
  for (const VertexIndex p : mesh.face(face)) sum += mesh.points[p];
  return sum / static_cast<double>(mesh.face(face).size());
}

FaceMeasure measure(const PolyMesh& mesh, std::size_t face) {
  const Vec3 mean = mean_of(mesh, face);
  Vec3 area, moment;
  double sum = 0;
  for_each_side(mesh, face, mesh.owner[face], [&](Vec3 a, Vec3 b) {
    const Vec3 n = cross(a - mean, b - mean) / 2;
    const double size = length(n);
    area += n;
    sum += size;
    moment += ((a - mean) + (b - mean)) * (size / 3);
  });
  return {area, sum > 0 ? mean + moment / sum : mean};
}

double volume_of(const PolyMesh& mesh, std::uint32_t cell, std::span<const std::uint32_t> faces) {
  double sum = 0;
  for_each_tet(mesh, cell, faces, mean_of(mesh, faces.front()), [&](double six, Vec3) { sum += six; });
  return sum / 6;
}

Vec3 middle_of_cell(const PolyMesh& mesh, std::uint32_t cell, std::span<const std::uint32_t> faces) {
  const Vec3 from = mean_of(mesh, faces.front());
  double sum = 0;
  Vec3 moment;
  for_each_tet(mesh, cell, faces, from, [&](double six, Vec3 middle) {
    sum += six;
    moment += middle * six;
  });
  return sum > 0 ? from + moment / sum : from;
}

bool is_closed(const PolyMesh& mesh, std::uint32_t cell, std::span<const std::uint32_t> faces) {
  std::vector<std::array<std::uint32_t, 3>> edges;  // lower end, upper end, direction
  for (const std::uint32_t f : faces) {
    const auto points = mesh.face(f);
    const bool is_owner = mesh.owner[f] == cell;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const VertexIndex a = points[i], b = points[(i + 1) % points.size()];
      edges.push_back({std::min(a, b), std::max(a, b), (a < b) == is_owner ? 1U : 0U});
    }
  }
  std::sort(edges.begin(), edges.end());
  if (edges.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const auto &a = edges[i], &b = edges[i + 1];
    if (a[0] != b[0] || a[1] != b[1] || a[2] != 0 || b[2] != 1) return false;
    if (i + 2 < edges.size() && edges[i + 2][0] == a[0] && edges[i + 2][1] == a[1]) return false;
  }
  return true;
}

}  // namespace dual

std::vector<double> cell_volumes(const PolyMesh& mesh) {
  const Groups<> faces = dual::faces_of_cells(mesh);
  std::vector<double> volumes(mesh.cells());
  parallel_for(mesh.cells(),
               [&](std::size_t c) { volumes[c] = dual::volume_of(mesh, static_cast<std::uint32_t>(c), faces[c]); });
  return volumes;
}

}  // namespace octafront
