// Elements that span an edge of a thin wall and the one right behind it: their corners lie in a plane up to rounding,
// so that they are positive by exact sign only. The three elements on either side of such a one fill a prism whose
// diagonals run around, and have no others with one of them turned: no exchange of edges and faces leads out. A vertex
// inside the prism does. In walls so thin scores are near 0 everywhere; so what counts is by how much they differ.

#include "base/geometry/measures.h"
#include "improve/passes/passes.h"
#include "improve/passes/poor_tets.h"

#include <algorithm>
#include <cmath>

namespace octafront::improve {
namespace {

/// An element with less than this part of the volume of one beside it is flat: those of one layer differ by some times.
constexpr double kFlatPart = 1e-3;
/// Others score more, however thin the wall is whose edges stand behind each other.
constexpr float kFlatScore = 0.01f;
/// The smallest angle becomes twice as large at least: 1 - cos grows with its square. Scores do not tell, for the beta
/// of all elements of a layer falls with the square of its thickness.
constexpr float kTimesBetter = 4;

class FlatOpener {
 public:
  explicit FlatOpener(EditMesh& mesh) : editor_(mesh), mesh_(mesh), floor_(mesh.floor()), star_(mesh.objective()) {}

  /// True if tet t is flat, and it and others around one of its edges were replaced by the star of a new vertex.
  bool improve(TetIndex t) {
    if (!is_flat(t)) return false;
    float best = kTimesBetter * std::max(0.0f, mesh_.shape(t).small);
    int best_edge = -1;
    for (int e = 0; e < 6; ++e)
      if (load_star(t, e) && star_.star_acceptable(apex_, floor_) && least_angle() > best) {
        best = least_angle();
        best_edge = e;
      }
    return best_edge >= 0 && load_star(t, best_edge) && editor_.replace_by_star(ring_.tets, faces_, star_, apex_);
  }

  const std::vector<TetIndex>& created() const { return editor_.created(); }

 private:
  double volume(TetIndex t) const {
    const Tet& c = mesh_.tet(t);
    return std::abs(six_volumes(mesh_.point(c[0]), mesh_.point(c[1]), mesh_.point(c[2]), mesh_.point(c[3])));
  }

  bool is_flat(TetIndex t) {
    double most = 0;
    for (HalfFace i = 0; i < 4; ++i)
      if (const TetIndex behind = editor_.behind(4 * t + i); behind != kNone) most = std::max(most, volume(behind));
    return volume(t) < kFlatPart * most;
  }

  /// The elements around an edge as the star of a vertex in the middle of their corners, evaluated; false if it lies on
  /// the boundary.
  bool load_star(TetIndex t, int edge) {
    const auto [i, j] = kTetEdges[edge];
    editor_.edge_ring(t, i, j, ring_);
    if (!ring_.closed || ring_.ring.size() > kLongestRing) return false;
    const VertexIndex a = mesh_.tet(t)[i], b = mesh_.tet(t)[j];
    apex_ = mesh_.point(a) + mesh_.point(b);
    for (const VertexIndex v : ring_.ring) apex_ += mesh_.point(v);
    apex_ = apex_ / static_cast<double>(ring_.ring.size() + 2);
    faces_.clear();
    star_.size = 0;
    for (const TetIndex r : ring_.tets)
      for (const VertexIndex end : {a, b}) {
        const Triangle f = faces_.emplace_back(face_of(mesh_.tet(r), mesh_.corner_of(r, end)));
        star_.add(mesh_.point(f[0]), mesh_.point(f[1]), mesh_.point(f[2]));
      }
    star_.evaluate_star(apex_);
    return true;
  }

  float least_angle() const {
    float least = 2;
    for (int k = 0; k < star_.size; ++k) least = std::min(least, star_.shape(k).small);
    return least;
  }

  MeshEditor editor_;
  EditMesh& mesh_;
  Floor floor_;
  ShapeBatch star_;
  Vec3 apex_;
  EdgeRing ring_;
  std::vector<Triangle> faces_;  ///< of the elements around the edge, as seen from inside
};

}  // namespace

PassResult open_flat_elements(EditMesh& mesh, const RunContext& context) {
  FlatOpener opener(mesh);
  return improve_each(opener, mesh, kFlatScore, context);
}

}  // namespace octafront::improve
