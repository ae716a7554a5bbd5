#pragma once

#include <octafront/no_context.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// A mesh of polyhedra by their faces, in the order of OpenFOAM: faces between two cells come first, ascending by owner
/// and neighbour, then those of the boundary by patch and owner. Names of regions and patches are those of the
/// tetrahedral mesh that it was made of.
struct PolyMesh {
  std::vector<Vec3> points;
  std::vector<std::uint64_t> face_begin{0};  ///< one more than faces: where the points of each begin
  std::vector<VertexIndex> face_points;      ///< of all faces, counter-clockwise seen from outside the owner
  std::vector<std::uint32_t> owner;          ///< one per face
  std::vector<std::uint32_t> neighbour;      ///< one per face between two cells: above its owner
  std::vector<std::uint32_t> patch;          ///< one per face: its patch, also of interfaces; kNone: none
  std::vector<std::uint32_t> region;         ///< one per cell
  std::vector<VertexIndex> vertex;           ///< one per cell: the vertex of the tetrahedral mesh that it is made of

  std::size_t cells() const { return region.size(); }
  std::size_t faces() const { return owner.size(); }
  std::size_t inner_faces() const { return neighbour.size(); }
  std::span<const VertexIndex> face(std::size_t f) const {
    return std::span(face_points).subspan(face_begin[f], face_begin[f + 1] - face_begin[f]);
  }
  friend bool operator==(const PolyMesh&, const PolyMesh&) = default;
};

/// The dual of a tetrahedral mesh: a cell for each vertex, a face for each edge, a point for each tetrahedron. Cells
/// end at the boundary, at interfaces and sheets, on each side of which they are of their own; feature edges (between
/// patches, curves, or that bend by more than 40 degrees) and the vertices on them are kept; where a body bends inward
/// at such an edge a cell is made for each side of it. Boundary layers (TetMesh::wide_cells) become columns of
/// polygonal prisms as high as the layers are, as many as there were layers. Mid-side nodes are not looked at. The same
/// bits for any number of threads.
///
/// REQUIRES a valid mesh (first_defect). Throws MeshingError with the cell at fault if the result is not sound (below),
/// Cancelled. About 5 s per million tetrahedra; as
/// long again for each time that cells are divided otherwise, for some were skew (four times at most).
PolyMesh dual_mesh(const TetMesh& mesh, const RunContext& context = no_context());

/// The first way in which a mesh of polyhedra is not sound; else nullopt.
///   - indices in range, coordinates finite, no point unused; faces in order, of three points or more, each once
///   - every cell closed: each edge of its faces is in two of them, once in either direction
///   - every cell of positive volume, by the divergence theorem over its faces (triangles around their middles)
std::optional<std::string> first_defect(const PolyMesh& mesh, const RunContext& context = no_context());

/// Per cell its volume, as above. They add up to what the boundary encloses, for faces between cells cancel.
std::vector<double> cell_volumes(const PolyMesh& mesh);

}  // namespace octafront
