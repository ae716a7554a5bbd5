#include "base/mesh/complex.h"

#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/mesh/face_table.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {

namespace {

Triangle turned(const Triangle& t) {
  return {t[0], t[2], t[1]};
}

// Numbers of the face table: tetrahedra, each with the way its face is turned, before triangles of the complex.
constexpr std::uint32_t kIsWall = 1u << 31;

FaceTable faces_and_walls(const SurfaceMesh& complex, const TetMesh& mesh, const std::vector<std::uint8_t>& on_wall) {
  return {mesh.points.size(), [&](const auto& add) {
            for_each_face_between(mesh, on_wall, add);
            for (std::uint32_t f = 0; f < complex.triangles.size(); ++f) add(complex.triangles[f], kIsWall | f);
          }};
}

struct Claim {
  TetIndex tet;
  std::uint32_t region;
};

[[noreturn]] void throw_leak(const SurfaceMesh& complex, const TetMesh& mesh, const Claim& claim, std::uint32_t known) {
  const Tet& t = mesh.tets[claim.tet];
  const Vec3 p = (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]] + mesh.points[t[3]]) / 4;
  const auto name = [&](std::uint32_t r) { return r == kNone ? "the outside" : region_name(complex, r); };
  throw MeshingError(fmt::format("{} and {} meet without a triangle between them near ({:.6g}, {:.6g}, {:.6g})",
                                 name(claim.region), name(known), p.x, p.y, p.z));
}

}  // namespace

bool is_complex(const SurfaceMesh& surface) {
  return std::any_of(surface.sides.begin(), surface.sides.end(), [](const Sides& s) { return s != Sides{kNone, 0}; });
}

void face_lower_regions_behind(SurfaceMesh& complex) {
  for (std::size_t t = 0; t < complex.sides.size(); ++t) {
    auto& [front, behind] = complex.sides[t];
    if (front >= behind) continue;
    std::swap(front, behind);
    complex.triangles[t] = turned(complex.triangles[t]);
  }
}

std::vector<std::uint8_t> corners_of(std::size_t points, const std::vector<Triangle>& triangles) {
  std::vector<std::uint8_t> is_corner(points, 0);
  for (const Triangle& t : triangles)
    for (const VertexIndex v : t) is_corner[v] = 1;
  return is_corner;
}

std::uint32_t region_count(const SurfaceMesh& complex) {
  if (complex.sides.empty()) return 1;
  std::uint32_t count = 0;
  for (const Sides& sides : complex.sides)
    for (const std::uint32_t r : sides)
      if (r != kNone) count = std::max(count, r + 1);
  return count;
}

std::vector<double> volumes_of_regions(const SurfaceMesh& complex) {
  std::vector<double> volumes(region_count(complex), 0);
  // Each is measured from a vertex of its own.
  std::vector<VertexIndex> from(volumes.size(), kNone);
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const Triangle& corners = complex.triangles[t];
    const auto [front, behind] = complex.sides_of(t);
    if (front == behind) continue;
    const auto add = [&](std::uint32_t region, double sign) {
      if (region == kNone) return;
      if (from[region] == kNone) from[region] = corners[0];
      const Vec3 o = complex.points[from[region]];
      const Vec3 p = complex.points[corners[0]] - o, q = complex.points[corners[1]] - o,
                 r = complex.points[corners[2]] - o;
      volumes[region] += sign * dot(p, cross(q, r)) / 6;
    };
    add(behind, 1), add(front, -1);
  }
  return volumes;
}

std::string region_name(const SurfaceMesh& complex, std::uint32_t region) {
  if (region < complex.region_names.size() && !complex.region_names[region].empty())
    return complex.region_names[region];
  return region_label("", region, region_count(complex));
}

SurfaceMesh hull_of(const SurfaceMesh& complex) {
  SurfaceMesh hull{complex.points, {}, {}, complex.patch_names, {}};
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto [front, behind] = complex.sides_of(t);
    if ((front == kNone) == (behind == kNone)) continue;
    hull.triangles.push_back(front == kNone ? complex.triangles[t] : turned(complex.triangles[t]));
    if (!complex.patch.empty()) hull.patch.push_back(complex.patch[t]);
  }
  return hull;
}

SurfaceMesh boundary_of_region(const SurfaceMesh& complex, std::uint32_t region) {
  SurfaceMesh boundary{complex.points, {}, {}, complex.patch_names, {}};
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto [front, behind] = complex.sides_of(t);
    const auto add = [&](const Triangle& triangle) {
      boundary.triangles.push_back(triangle);
      if (!complex.patch.empty()) boundary.patch.push_back(complex.patch[t]);
    };
    if (behind == region) add(complex.triangles[t]);
    if (front == region) add(turned(complex.triangles[t]));
  }
  return boundary;
}

void list_faces(const SurfaceMesh& complex, TetMesh& mesh) {
  mesh.patch_names = complex.patch_names;
  mesh.patch_labels = complex.patch_labels;
  if (complex.sides.empty()) {
    mesh.boundary = complex.triangles;
    mesh.patch = complex.patch;
    return;
  }
  mesh.boundary.clear(), mesh.patch.clear(), mesh.interfaces.clear(), mesh.interface_patch.clear();
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const bool is_outer = complex.sides[t][0] == kNone;
    (is_outer ? mesh.boundary : mesh.interfaces).push_back(complex.triangles[t]);
    if (!complex.patch.empty()) (is_outer ? mesh.patch : mesh.interface_patch).push_back(complex.patch[t]);
  }
}

std::vector<std::uint32_t> regions_within(const SurfaceMesh& complex, const TetMesh& mesh) {
  const std::vector<std::uint8_t> on_wall = corners_of(mesh.points.size(), complex.triangles);
  DisjointSets sets(mesh.tets.size());
  std::vector<TetIndex> first_at(mesh.points.size(), kNone);
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (const VertexIndex v : mesh.tets[t]) {
      if (on_wall[v] != 0) continue;
      if (first_at[v] == kNone) first_at[v] = t;
      sets.join(first_at[v], t);
    }
  std::vector<Claim> claims;
  faces_and_walls(complex, mesh, on_wall)
      .for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> on_face) {
        const std::uint32_t last = on_face.back().face;
        if ((last & kIsWall) == 0) {
          if (on_face.size() == 2) sets.join(on_face[0].face / 2, on_face[1].face / 2);
          return;
        }
        const std::uint32_t wall = last & ~kIsWall;
        const bool is_wall_even = is_even(complex.triangles[wall]);
        const auto [front, behind] = complex.sides_of(wall);
        for (const FaceTable::Entry& entry : on_face.first(on_face.size() - 1))
          claims.push_back({entry.face / 2, (entry.face % 2 != 0) == is_wall_even ? behind : front});
      });
  std::vector<std::uint32_t> of_set(mesh.tets.size(), kNone), region(mesh.tets.size());
  for (const Claim& claim : claims) {
    std::uint32_t& known = of_set[sets.find(claim.tet)];
    if (claim.region == kNone || (known != kNone && known != claim.region)) throw_leak(complex, mesh, claim, known);
    known = claim.region;
  }
  for (std::uint32_t t = 0; t < region.size(); ++t) region[t] = of_set[sets.find(t)];
  return region;
}

}  // namespace octafront
