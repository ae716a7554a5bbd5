#pragma once

#include <octafront/ids.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include "fill/classic/alternating_tree.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

/// The front of the classical method: oriented triangles (a, b, c) that face the unfilled side, so that (a, b, c, p) is
/// positive for a point p to which the face may advance; its faces and its vertices each in an alternating digital
/// tree; and the tetrahedra made so far.
class ClassicFront {
 public:
  using Face = std::uint32_t;

  explicit ClassicFront(const Box3& domain);

  VertexIndex add_vertex(Vec3 at);
  /// Numbers of faces are never used again.
  Face add_face(const Triangle& corners);
  void remove_face(Face face);
  void add_tet(const Triangle& face, VertexIndex apex);

  const std::vector<Vec3>& points() const { return points_; }
  Vec3 at(VertexIndex v) const { return points_[v]; }
  const Triangle& corners(Face face) const { return faces_[face]; }
  bool alive(Face face) const { return alive_[face]; }
  double size_of(Face face) const;  ///< area
  std::size_t face_count() const { return faces_.size(); }
  const std::vector<Tet>& tets() const { return tets_; }
  double filled_volume() const { return six_volumes_ / 6; }
  const Box3& domain() const { return domain_; }

  /// The faces whose boxes meet `box`.
  void faces_near(const Box3& box, std::vector<Face>& out) const;
  /// The vertices with faces on the front, in `box`.
  void vertices_near(const Box3& box, std::vector<VertexIndex>& out) const;

  /// Where the faces and the trees contradict each other (base/core/validate.h).
  std::optional<std::string> first_inconsistency() const;
  /// The same at one face and its corners.
  std::optional<std::string> first_inconsistency(Face face) const;

 private:
  Box3 domain_;
  /// Faces whose boxes have a largest extent in [2^power, 2^(power + 1)), by the middles of their boxes: a search need
  /// not reach farther for small faces because there are large ones.
  struct FaceTree {
    int power;
    AlternatingTree<3> tree;
  };
  FaceTree& tree_for(double extent);
  std::vector<FaceTree> face_trees_;
  std::vector<std::uint8_t> tree_of_face_;
  AlternatingTree<3> vertex_tree_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> faces_at_;  ///< per vertex
  std::vector<Triangle> faces_;
  std::vector<char> alive_;
  std::vector<Tet> tets_;
  double six_volumes_ = 0;
};

}  // namespace octafront
