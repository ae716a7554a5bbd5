// Reconnection of small polyhedra: some tetrahedra around a bad one go, and the space that they filled is filled anew
// from the same vertices as well as a search can. It finds changes that no row of flips reaches without getting worse
// on the way.

#include "improve/passes/passes.h"
#include "improve/passes/poor_tets.h"
#include "improve/shape/polyhedron_search.h"

#include <algorithm>
#include <array>

namespace octafront::improve {
namespace {

constexpr float kLeastGainOfPolyhedron = 0.01f;

/// A small cavity is quickly searched; a larger one has more ways to be filled.
constexpr std::array<std::size_t, 2> kCorners{8, PolyhedronSearch::kMostCorners};

class PolyhedronReconnector {
 public:
  explicit PolyhedronReconnector(EditMesh& mesh)
      : editor_(mesh), mesh_(mesh), floor_(mesh.floor()), search_(mesh.objective()) {}

  /// True if tet t and others around it were replaced by better ones; those are in created().
  bool improve(TetIndex t) {
    std::size_t last = 0;
    tets_.assign(1, t);
    corners_.assign(mesh_.tet(t).begin(), mesh_.tet(t).end());
    for (const std::size_t most : kCorners) {
      grow(most);
      if (tets_.size() == last) continue;
      last = tets_.size();
      if (list_faces() && search_.fill(points_, faces_, floor_, mesh_.shape(t).score + kLeastGainOfPolyhedron))
        return commit();
    }
    return false;
  }

  const std::vector<TetIndex>& created() const { return editor_.created(); }

 private:
  bool holds(TetIndex t) const { return std::find(tets_.begin(), tets_.end(), t) != tets_.end(); }
  bool is_corner(VertexIndex v) const { return std::find(corners_.begin(), corners_.end(), v) != corners_.end(); }

  /// Adds neighbours until none fits: first those without a new corner, else the worst.
  void grow(std::size_t most_corners) {
    for (;;) {
      TetIndex next = kNone;
      bool next_is_free = false;
      for (const TetIndex t : tets_)
        for (int i = 0; i < 4; ++i) {
          const HalfFace across = mesh_.across(4 * t + i);
          if (is_outside(across) || holds(across / 4)) continue;
          const bool free = is_corner(mesh_.tet(across / 4)[across % 4]);
          if (!free && (next_is_free || corners_.size() >= most_corners)) continue;
          const TetIndex behind = editor_.behind(4 * t + i);
          if (behind == kNone) continue;
          if (next == kNone || free > next_is_free || mesh_.worse(behind, next)) next = behind, next_is_free = free;
        }
      if (next == kNone || tets_.size() >= kMostTets) return;
      tets_.push_back(next);
      for (const VertexIndex v : mesh_.tet(next))
        if (!is_corner(v)) corners_.push_back(v);
    }
  }

  PolyhedronSearch::Corner number_of(VertexIndex v) const {
    return static_cast<PolyhedronSearch::Corner>(std::find(corners_.begin(), corners_.end(), v) - corners_.begin());
  }

  /// False if the polyhedron has too many faces.
  bool list_faces() {
    faces_.clear();
    for (const TetIndex t : tets_)
      for (int i = 0; i < 4; ++i) {
        const HalfFace across = mesh_.across(4 * t + i);
        if (!is_outside(across) && holds(across / 4)) continue;
        if (faces_.size() == PolyhedronSearch::kMostFaces) return false;
        const Triangle f = face_of(mesh_.tet(t), i);
        faces_.push_back({number_of(f[0]), number_of(f[1]), number_of(f[2])});
      }
    points_.clear();
    for (const VertexIndex v : corners_) points_.push_back(mesh_.point(v));
    return true;
  }

  bool commit() {
    MeshEditor::Refill refill{tets_, {}, {}};
    for (const auto& [c, shape] : search_.tets())
      refill.add({corners_[c[0]], corners_[c[1]], corners_[c[2]], corners_[c[3]]}, shape);
    return editor_.replace(refill);
  }

  static constexpr std::size_t kMostTets = 24;

  MeshEditor editor_;
  EditMesh& mesh_;
  Floor floor_;
  PolyhedronSearch search_;
  std::vector<TetIndex> tets_;
  std::vector<VertexIndex> corners_;
  std::vector<Vec3> points_;
  std::vector<PolyhedronSearch::Face> faces_;
};

}  // namespace

PassResult reconnect_small_polyhedra(EditMesh& mesh, float threshold, const RunContext& context) {
  PolyhedronReconnector reconnector(mesh);
  return improve_each(reconnector, mesh, threshold, context);
}

}  // namespace octafront::improve
