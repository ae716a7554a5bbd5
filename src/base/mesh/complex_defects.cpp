#include "base/mesh/complex_defects.h"

#include <octafront/surface_mesh.h>

#include "base/mesh/complex.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <array>
#include <tuple>

#include <fmt/core.h>

namespace octafront {

namespace {

using PlacedCorners = std::array<std::array<double, 3>, 3>;

/// A triangle by its coordinates, the least corner first and the lower region, or no outside, behind it.
struct PlacedWall {
  PlacedCorners corners;
  Sides sides;

  friend bool operator==(const PlacedWall&, const PlacedWall&) = default;
  friend bool operator<(const PlacedWall& a, const PlacedWall& b) {
    return std::tie(a.corners, a.sides) < std::tie(b.corners, b.sides);
  }
};

PlacedWall placed(const std::vector<Vec3>& points, Triangle t, Sides sides) {
  const auto [front, behind] = sides;
  if (front < behind) {
    std::swap(t[1], t[2]);
    sides = {behind, front};
  }
  PlacedCorners corners;
  for (int i = 0; i < 3; ++i) corners[i] = {points[t[i]].x, points[t[i]].y, points[t[i]].z};
  const auto first = std::min_element(corners.begin(), corners.end());
  std::rotate(corners.begin(), first, corners.end());
  // A sheet has no front.
  if (front == behind && corners[2] < corners[1]) std::swap(corners[1], corners[2]);
  return {corners, sides};
}

std::string words(const PlacedWall& wall) {
  std::string text;
  for (const auto& p : wall.corners)
    text += fmt::format("{}({:.6g}, {:.6g}, {:.6g})", text.empty() ? "" : " ", p[0], p[1], p[2]);
  const auto side = [](std::uint32_t r) {
    return r == kNone ? std::string("the outside") : fmt::format("region {}", r);
  };
  return text + " between " + side(wall.sides[0]) + " and " + side(wall.sides[1]);
}

/// Where the mesh changes its region: every face of the boundary, every interface, and what is not listed but should.
struct Walls {
  std::vector<PlacedWall> found;
  std::optional<std::string> defect;
};

/// A vertex away from boundary and interfaces at which regions meet.
std::optional<std::string> changing_vertex(const TetMesh& mesh, const std::vector<std::uint8_t>& on_wall) {
  if (mesh.region.empty()) return std::nullopt;
  std::vector<std::uint32_t> region_at(mesh.points.size(), kNone);
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    for (const VertexIndex v : mesh.tets[t]) {
      if (on_wall[v] != 0) continue;
      if (region_at[v] == kNone) region_at[v] = mesh.region[t];
      if (region_at[v] == mesh.region[t]) continue;
      const Vec3 p = mesh.points[v];
      return fmt::format("regions {} and {} meet at vertex {} ({:.6g}, {:.6g}, {:.6g}), which is on no interface",
                         region_at[v], mesh.region[t], v, p.x, p.y, p.z);
    }
  return std::nullopt;
}

Walls walls_of(const TetMesh& mesh) {
  constexpr std::uint32_t kListed = 1u << 31;
  const auto boundary = static_cast<std::uint32_t>(mesh.boundary.size());
  const auto listed = [&](std::uint32_t f) { return f < boundary ? mesh.boundary[f] : mesh.interfaces[f - boundary]; };
  std::vector<std::uint8_t> on_wall = corners_of(mesh.points.size(), mesh.boundary);
  for (const Triangle& t : mesh.interfaces)
    for (const VertexIndex v : t) on_wall[v] = 1;
  const FaceTable table(mesh.points.size(), [&](const auto& add) {
    for_each_face_between(mesh, on_wall, add);
    for (std::uint32_t f = 0; f < boundary + mesh.interfaces.size(); ++f) add(listed(f), kListed | f);
  });
  const auto region = [&](std::uint32_t entry) { return mesh.region.empty() ? 0 : mesh.region[entry / 2]; };
  Walls walls;
  walls.defect = changing_vertex(mesh, on_wall);
  table.for_each_group([&](const Triangle& key, std::span<const FaceTable::Entry> on_face) {
    const std::uint32_t last = on_face.back().face;
    if ((last & kListed) == 0) {
      const std::uint32_t a = region(on_face[0].face), b = region(on_face[1].face);
      if (a != b && !walls.defect)
        walls.defect =
            "the mesh changes its region at a face that is no interface: " + words(placed(mesh.points, key, {a, b}));
      return;
    }
    const Triangle t = listed(last & ~kListed);
    Sides sides{kNone, kNone};
    for (const FaceTable::Entry& entry : on_face.first(on_face.size() - 1))
      sides[(entry.face % 2 != 0) == is_even(t)] = region(entry.face);
    walls.found.push_back(placed(mesh.points, t, sides));
  });
  return walls;
}

}  // namespace

std::optional<std::string> difference_to_complex(const TetMesh& mesh, const SurfaceMesh& complex) {
  Walls made = walls_of(mesh);
  if (made.defect) return made.defect;
  std::vector<PlacedWall> wanted;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t)
    wanted.push_back(placed(complex.points, complex.triangles[t], complex.sides_of(t)));
  std::sort(made.found.begin(), made.found.end());
  std::sort(wanted.begin(), wanted.end());
  const auto [m, w] = std::mismatch(made.found.begin(), made.found.end(), wanted.begin(), wanted.end());
  if (w != wanted.end() && (m == made.found.end() || *w < *m))
    return "the mesh lacks the complex's triangle " + words(*w);
  if (m != made.found.end()) return "the mesh has a boundary or interface that the complex has not: " + words(*m);
  return std::nullopt;
}

}  // namespace octafront
