#pragma once

#include <octafront/surface_mesh.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// A surface after repair, and what was done to it.
struct RepairedSurface {
  SurfaceMesh surface;
  std::vector<std::uint32_t> face_of_triangle;  ///< per triangle: the input face that it came from
  std::uint64_t merged_vertices = 0, unused_vertices = 0, duplicate_faces = 0, degenerate_faces = 0;
  std::uint64_t turned_faces = 0;   ///< to make neighbours agree
  std::uint64_t turned_shells = 0;  ///< inside-out, or cavities that did not face inward
  std::uint32_t shells = 0, cavities = 0, bodies = 0;
  std::vector<std::uint32_t> body_of_triangle;  ///< per triangle; a cavity belongs to the body around it
  std::vector<std::string> notes;   ///< a sentence for each kind of change
};

/// Merges equal vertices, drops duplicate and degenerate faces and unused vertices, makes neighbouring faces agree,
/// turns inside-out shells outward and nested shells by their depth (odd depth: a cavity). Never moves a vertex.
/// `face_of_triangle` may be empty (then triangle i is face i).
RepairedSurface repair_surface(const SurfaceMesh& soup, const std::vector<std::uint32_t>& face_of_triangle = {});

/// What keeps a surface from being meshed, found exactly.
struct SurfaceDefects {
  struct Place {
    Vec3 at;                            ///< where to look
    std::vector<std::uint32_t> faces;   ///< input faces at fault
  };
  struct Kind {
    std::uint64_t count = 0;
    std::vector<Place> first;  ///< the first ten in order of face id
  };
  Kind open_edges, non_manifold_edges, non_manifold_vertices, misoriented_edges, self_intersections;
  std::uint64_t open_loops = 0;  ///< closed chains of open edges: the holes

  bool clean() const;
  /// A paragraph for each kind: count, first places with face ids and coordinates, what to do. Empty if clean.
  std::string describe() const;
};

SurfaceDefects find_defects(const RepairedSurface& repaired);

}  // namespace octafront
