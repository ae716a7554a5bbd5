#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// A triangle surface as flat arrays: the boundary of one body, or a *complex* of several regions.
///
/// What the library calls a *clean* surface is closed, oriented outward, 2-manifold, and free of self-intersections:
/// each edge has exactly two triangles that run through it in opposite directions, and the triangles around each vertex
/// form one fan. A shell inside another one, facing the other way, bounds a cavity.
///
/// A *complex* says for each triangle what lies on its two sides. Its triangles meet in shared vertices and edges only;
/// the same region on both sides makes a *sheet* (a crack, a membrane).
struct SurfaceMesh {
  std::vector<Vec3> points;          ///< input units
  std::vector<Triangle> triangles;   ///< indices into points
  std::vector<std::uint32_t> patch;  ///< one per triangle: which named part of the surface it belongs to; empty: all 0
  std::vector<std::string> patch_names;  ///< patch p is patch_names[p]; may be shorter than the number of patches
  /// One per triangle: the face of the input that it came from, by which messages and TetMesh::source name it; empty:
  /// triangle t is face t.
  std::vector<std::uint32_t> source;
  /// One per triangle; empty: one region, 0, lies behind every triangle, and nothing in front.
  std::vector<Sides> sides = {};
  std::vector<std::string> region_names = {};  ///< region r is region_names[r]; may be shorter than their number
  /// Numbers that regions have where they come from: labels of an image; region r is label region_labels[r]. Empty:
  /// they have none.
  std::vector<std::int64_t> region_labels = {};
  /// The same of patches, such as the reference numbers of a file. Patches that have none count on behind the largest.
  std::vector<std::int64_t> patch_labels = {};

  std::uint32_t patch_of(std::size_t triangle) const { return patch.empty() ? 0 : patch[triangle]; }
  std::uint32_t source_of(std::size_t triangle) const {
    return source.empty() ? static_cast<std::uint32_t>(triangle) : source[triangle];
  }
  Sides sides_of(std::size_t triangle) const { return sides.empty() ? Sides{kNone, 0} : sides[triangle]; }
  friend bool operator==(const SurfaceMesh&, const SurfaceMesh&) = default;
};

/// The smallest axis-parallel box around the vertices.
Box3 bounding_box(const std::vector<Vec3>& points);

/// Volume enclosed by a closed surface that faces outward (cavities count negative). Unit: input unit cubed.
double enclosed_volume(const SurfaceMesh& surface);

/// Sum of the areas of the triangles. Unit: input unit squared.
double area(const SurfaceMesh& surface);

/// A number that tells this geometry from others: of its points, triangles and sides, bit for bit.
std::uint64_t fingerprint(const SurfaceMesh& surface);

}  // namespace octafront
