#pragma once

// What first_defect() looks at, for meshes whose tetrahedra are in several hands: what holds of a share by itself, and
// what is left to be seen together.

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// Of a mesh whose tetrahedra are a share of all: who uses its vertices.
struct MeshShare {
  std::uint64_t first_tet = 0;  ///< the number of the first tetrahedron in the whole
  /// Per vertex: by tetrahedra of this share; of any; of several.
  std::vector<std::uint8_t> used_here, used_by_any, used_by_several;

  /// Whether tetrahedra of several shares may have this face.
  bool is_at_rim(const Triangle& t) const {
    return std::ranges::all_of(t, [&](VertexIndex v) { return used_by_several[v] != 0; });
  }
  /// Whether only tetrahedra of this share may.
  bool is_here_alone(const Triangle& t) const {
    return std::ranges::any_of(t, [&](VertexIndex v) { return used_here[v] != 0 && used_by_several[v] == 0; });
  }
};

/// Marks the vertices of the tetrahedra.
std::vector<std::uint8_t> vertices_in_use(const TetMesh& mesh);

/// Too many of something, points that are not finite, rows of vertices that are not there. Must hold before the others.
std::optional<std::string> indices_defect(const TetMesh& mesh);

/// What breaks a law of first_defect() in a share of a mesh of first order without curves, but for faces at its rim and
/// the volume.
std::optional<std::string> share_defect(const TetMesh& mesh, const MeshShare& share, const RunContext& context);

/// A face that tetrahedra of several shares may have, counter-clockwise seen from outside of its own.
struct RimFace {
  Triangle corners{};
  std::uint32_t tet = 0;  ///< in the whole
};
std::vector<RimFace> rim_faces(const TetMesh& mesh, const MeshShare& share);
/// What is wrong with the faces at rims whose least vertices are in [begin, end): those of all shares.
std::optional<std::string> rim_defect(const TetMesh& mesh, const MeshShare& share, std::span<const RimFace> faces,
                                      VertexIndex begin, VertexIndex end);

/// The sum of six volumes of tetrahedra (a, b, c, o), with what rounding may do to it: little of the sum where they are
/// large, but much where they are flat.
struct RoundedSum {
  double six_volumes = 0, magnitude = 0, products = 0, terms = 0;
  void add(Vec3 a, Vec3 b, Vec3 c) {
    const double term = dot(a, cross(b, c));
    six_volumes += term;
    magnitude += std::abs(term);
    products += std::sqrt(squared_length(a) * squared_length(b) * squared_length(c));
    ++terms;
  }
  RoundedSum& operator+=(const RoundedSum& other) {
    six_volumes += other.six_volumes;
    magnitude += other.magnitude;
    products += other.products;
    terms += other.terms;
    return *this;
  }
};
RoundedSum volume_of_tets(const TetMesh& mesh);
/// Whether the boundary encloses that volume. Follows from the other laws, so it guards the checks themselves: equal
/// but for rounding.
std::optional<std::string> volume_defect(const TetMesh& mesh, const RoundedSum& tets);

/// Where the boundary is not the surface, or the faces not those of the complex.
std::optional<std::string> difference_to(const TetMesh& mesh, const SurfaceMesh& surface);

}  // namespace octafront
