#pragma once

// fill/front: the volume front. Takes a clean surface and sizes; leaves tetrahedra of the wanted size whose boundary
// is that surface, triangle for triangle.
//
//   partition (blocks of space) -> front, front_index (open faces and what is near) -> advance, block_run
//     (candidates, attempt, meeting) -> ladder (backtrack, the means of the cavity room, recover_cavity) -> regions

#include <octafront/ids.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "fill/front/front_index.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

struct FrontVertex {
  Vec3 at;
  float size = 0;                   ///< wanted edge length here
  mutable std::uint32_t local = 0;  ///< scratch of Neighborhood
};

/// A face of the front: its corners, and the region that it bounds on its unfilled side, kNone where nobody knows. Only
/// faces of one region can be in each other's way: walls between regions are faces of both.
struct FrontFace {
  Triangle corners{};
  std::uint32_t region = kNone;
};

/// A face that waits in a queue. Ids of faces are used again; the generation tells whether it is still the same face.
struct QueuedFace {
  FaceIndex face;
  std::uint32_t generation;
};

/// The boundary between what is filled and what is not: oriented triangles (a, b, c) that face the unfilled side, so
/// that (a, b, c, p) is positive for a point p to which the face may advance; and the tetrahedra made so far.
class Front {
 public:
  /// Nothing yet; faces will lie within `domain`.
  Front(const Box3& domain, double finest_size);

  VertexIndex add_vertex(Vec3 at, double size);
  FaceIndex add_face(const FrontFace& face);
  void remove_face(FaceIndex face);
  /// Records the tetrahedron (face, apex); the faces are the caller's business.
  void add_tet(const Triangle& face, VertexIndex apex);

  const std::vector<FrontVertex>& vertices() const { return vertices_; }
  const FrontVertex& vertex(VertexIndex v) const { return vertices_[v]; }
  Vec3 at(VertexIndex v) const { return vertices_[v].at; }
  const FrontFace& face(FaceIndex face) const { return faces_[face].face; }
  const Triangle& corners(FaceIndex face) const { return faces_[face].face.corners; }
  QueuedFace queued(FaceIndex face) const { return {face, faces_[face].generation}; }
  bool alive(QueuedFace q) const { return faces_[q.face].generation == q.generation; }
  const FrontIndex& index() const { return index_; }
  std::vector<Tet>& tets() { return tets_; }
  const std::vector<Tet>& tets() const { return tets_; }
  /// Sum of the volumes of what add_tet() was given.
  double filled_volume() const { return six_volumes_ / 6; }
  const Box3& domain() const { return domain_; }

  /// Every face has three corners, and is either in the index or free.
  std::optional<std::string> first_inconsistency() const;

 private:
  struct Face {
    FrontFace face;
    std::uint32_t generation = 0;
  };

  Box3 domain_;
  FrontIndex index_;
  std::vector<FrontVertex> vertices_;
  std::vector<Face> faces_;
  std::vector<FaceIndex> free_;
  std::vector<Tet> tets_;
  double six_volumes_ = 0;
};

}  // namespace octafront
