#pragma once

#include <octafront/error.h>
#include <octafront/no_context.h>
#include <octafront/surface_mesh.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace octafront {

/// A surface after repair, and what was done to it.
struct RepairedSurface {
  SurfaceMesh surface;  ///< its `source` refers to the input's faces
  std::uint64_t merged_vertices = 0, unused_vertices = 0, duplicate_faces = 0, degenerate_faces = 0;
  std::uint64_t divided_faces = 0;    ///< neighbours of degenerate faces, so that no gap opened
  std::uint64_t turned_faces = 0;     ///< to make neighbours agree
  std::uint64_t turned_shells = 0;    ///< inside-out, or cavities that did not face inward
  std::uint64_t turned_cavities = 0;  ///< the latter alone
  std::uint32_t shells = 0, cavities = 0, bodies = 0;
  std::vector<std::uint32_t> body_of_triangle;  ///< per triangle; a cavity belongs to the body around it
  std::vector<std::string> notes;               ///< a sentence for each kind of change
};

/// Merges equal vertices, drops duplicate and degenerate faces and unused vertices, makes neighbouring faces agree,
/// turns inside-out shells outward and nested shells by their depth (odd depth: a cavity). Never moves a vertex.
///   - Of faces with the same corners one stays; none, where two layers lie back to back and the rest is closed without
///     them (a wall inside a body, a sheet without thickness).
///   - A face whose corners lie on a line is dropped, and what it joined is joined without it: the faces at its longest
///     edge are divided at the corner in the middle of that edge. The surface as a set of points stays the same.
///   - Of a complex (SurfaceMesh::sides) no shell is turned or nested: triangles of two bodies at one place are joined,
///     and all are turned such that the outside, or else the higher region, lies in front.
///   - Open shells, shells that cannot be oriented and vertices where shells are pinched stay for find_defects.
///
/// Throws InputError if indices are out of range, or coordinates not finite or above 1e50, Cancelled if `context` asks
/// for it. Cost: O(n log n), about a second per million triangles.
RepairedSurface repair_surface(const SurfaceMesh& soup, const RunContext& context = no_context());

/// Whether there are as many vertices as corners of triangles, as in STL files: that repair merges them is no news.
bool has_vertices_of_each_triangle(const SurfaceMesh& surface);

/// What keeps a surface from being meshed, found exactly.
struct SurfaceDefects {
  struct Place {
    Vec3 at;                           ///< where to look
    std::vector<std::uint32_t> faces;  ///< input faces at fault
  };
  struct Kind {
    std::uint64_t count = 0;
    std::vector<Place> first;  ///< the first ten in order of face id
  };
  Kind open_edges;               ///< edges of one face
  Kind non_manifold_edges;       ///< edges of three faces or more
  Kind misoriented_edges;        ///< edges whose two faces do not agree: the surface cannot be oriented
  Kind non_manifold_vertices;    ///< vertices, not on such edges, whose faces form more than one fan
  Kind self_intersections;       ///< pairs of faces that meet elsewhere than in the corners and edges they share
  Kind degenerate_faces;         ///< faces without area that repair could not do without
  Kind region_conflicts;         ///< of a complex: edges around which the sides of the faces do not agree
  Kind misplaced_parts;          ///< of a complex: parts that lie in another region than their outer sides say
  bool no_faces = false;         ///< nothing is left to mesh
  std::uint64_t open_loops = 0;  ///< closed chains of open edges: the holes

  bool clean() const;
  /// A paragraph for each kind: count, first places with face ids and coordinates, what to do. Empty if clean.
  std::string describe() const;
};

/// A surface is refused for its defects.
class DefectsError : public InputError {
 public:
  explicit DefectsError(const SurfaceDefects& found) : DefectsError(found.describe(), found) {}
  DefectsError(const std::string& what, SurfaceDefects found) : InputError(what), defects(std::move(found)) {}
  SurfaceDefects defects;
};

/// A complex is clean if its triangles meet in shared vertices and edges only, and the regions on their sides agree:
/// around each edge, and of each part with what it lies in. Its edges may have any number of triangles.
///
/// Throws Cancelled if `context` asks for it. Cost: O(n log n), about a second per million triangles.
SurfaceDefects find_defects(const RepairedSurface& repaired, const RunContext& context = no_context());

}  // namespace octafront
