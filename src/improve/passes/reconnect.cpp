// Changes of connection that raise the worst score of the place they change: removal of an edge, its ring triangulated
// anew (RingFilling), and of a face between two tetrahedra (2-3 flip). The 3-2 and the 4-4 flip are removals of edges
// with rings of three and four.

#include "base/geometry/measures.h"
#include "base/mesh/ring_filling.h"
#include "improve/passes/fewest_poor.h"
#include "improve/passes/passes.h"
#include "improve/passes/poor_tets.h"

#include <algorithm>
#include <array>
#include <optional>

namespace octafront::improve {
namespace {

/// A way to refill the place of some tets, and by how much it is better than what is there.
struct BestRefill : MeshEditor::Refill {
  float gain = 0;
  std::optional<MeshEditor::BoundaryChange> turn;  ///< where the removed edge lies on the boundary

  void clear() {
    Refill::clear();
    gain = 0;
    turn.reset();
  }
};

// A change must gain at least this. Sums of the same numbers in another order differ in their last bits: on a regular
// lattice two refills of equal worth would otherwise replace each other for ever.
constexpr float kLeastGainOfRefill = 1e-5f;

constexpr std::size_t kQuickRing = 4;

/// A tet at the boundary that goes without another in its place counts as replaced by one of this score.
constexpr float kWorthOfNothing = 0.6f;

class Reconnector {
 public:
  Reconnector(EditMesh& mesh, Goal goal, const BoundaryGuide* guide)
      : editor_(mesh), mesh_(mesh), floor_(mesh.floor()), goal_(goal), guide_(guide), batch_(mesh.objective()) {}

  /// Makes the best change there is at tet t, of those where t is the worst element concerned; the tets made are in
  /// created(). False if none is better.
  bool improve(TetIndex t) {
    best_.clear();
    best_.gain = kLeastGainOfRefill;
    const unsigned closed = faces_to_worse(t);
    for (const auto& [i, j] : kTetEdges)
      if ((closed & ~(1u << i | 1u << j)) == 0) try_edge(t, i, j);
    if (goal_ != Goal::kMeanQuick)
      for (int i = 0; i < 4; ++i) try_face(t, i);
    if (guide_ && goal_ == Goal::kWorst)
      for (const auto& [i, j] : kTetEdges) try_boundary_edge(t, i, j);
    if (best_.old_tets.empty()) return false;
    return editor_.replace(best_, best_.turn ? &*best_.turn : nullptr);
  }

  const std::vector<TetIndex>& created() const { return editor_.created(); }

 private:
  static constexpr float kUnusable = -1e6f;  ///< below the sum of any usable values

  void add_candidate(const Tet& t) {
    batch_.add(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
  }

  /// What an element adds to the value of a place, larger being better: its score, or less what it lacks.
  float value_of(const Shape& s) const {
    if (goal_ == Goal::kWorst) return s.score;
    return goal_ == Goal::kFewestPoor ? -static_cast<float>(lack_of(s.score)) : -(1 - s.beta) * (1 - s.beta);
  }
  float combined(float a, float b) const { return goal_ == Goal::kWorst ? std::min(a, b) : a + b; }
  float neutral() const { return goal_ == Goal::kWorst ? 2.0f : 0.0f; }

  /// The value of candidate i of the batch, kUnusable if it may not be used.
  float usable_value(int i, const Tet& t) const {
    const Shape s = batch_.shape(i);
    const bool for_mean = goal_ == Goal::kMean || goal_ == Goal::kMeanQuick;
    return (for_mean && s.score < guard_) || !editor_.is_usable(t, s, floor_) ? kUnusable : value_of(s);
  }

  /// A bit for each face of t that lies on the boundary or has a worse element behind it: its edges are looked at from
  /// there, or not at all.
  unsigned faces_to_worse(TetIndex t) const {
    unsigned faces = 0;
    for (HalfFace i = 0; i < 4; ++i) {
      const HalfFace o = mesh_.across(4 * t + i);
      if (is_outside(o) || mesh_.worse(o / 4, t)) faces |= 1u << i;
    }
    return faces;
  }

  void try_edge(TetIndex t, int i, int j) {
    const VertexIndex a = mesh_.tet(t)[i], b = mesh_.tet(t)[j];
    if (!editor_.edge_ring_where_worst(t, i, j, longest_, ring_)) return;
    remove_edge(a, b);
  }

  /// Fills the place of the ring without the edge ab if that is better than the best so far; true if so.
  bool remove_edge(VertexIndex a, VertexIndex b) {
    const int n = static_cast<int>(ring_.ring.size());
    float before = neutral();
    guard_ = kMeanRisesGuard;
    for (const TetIndex r : ring_.tets) {
      before = combined(before, value_of(mesh_.shape(r)));
      guard_ = std::min(guard_, mesh_.shape(r).score);
    }
    const float bar = before + best_.gain;
    // Each edge of the ring is in one triangle of the new triangulation: if none on the first edge will do, none will.
    batch_.size = 0;
    add_triangles(a, b, 0, 1, n);
    batch_.evaluate();
    if (value_triangles(a, b, 0, 1, n) <= bar) return false;
    for (int i1 = 0; i1 < n; ++i1)
      for (int k = i1 + 1 + (i1 == 0); k < n; ++k) add_triangles(a, b, i1, k, n);
    batch_.evaluate();
    for (int i1 = 0; i1 < n; ++i1)
      for (int k = i1 + 1 + (i1 == 0); k < n; ++k) value_triangles(a, b, i1, k, n);
    const float after = filling_.best(
        n, neutral(), 4 * kUnusable,
        [&](int i, int k, int j, float low, float high, float) {
          return combined(combined(low, high), value_[i][k][j]);
        },
        [](int, int) { return true; });
    if (after <= bar) return false;
    best_.clear();
    best_.old_tets = ring_.tets;
    best_.gain = after - before;
    const auto& r = ring_.ring;
    filling_.for_each(n, [&](int i, int k, int j) {
      const int at = index_[i][k][j];
      best_.add({r[i], r[k], r[j], b}, batch_.shape(at));
      best_.add({r[i], r[j], r[k], a}, batch_.shape(at + 1));
    });
    return true;
  }

  /// Removal of an edge of the boundary: its two triangles become those on the other diagonal. A tet that holds both by
  /// itself goes without another in its place.
  void try_boundary_edge(TetIndex t, int i, int j) {
    const VertexIndex a = mesh_.tet(t)[i], b = mesh_.tet(t)[j];
    if (!mesh_.on_boundary(a) || !mesh_.on_boundary(b) || !guide_->may_turn(a, b)) return;
    editor_.edge_ring(t, i, j, ring_);
    if (ring_.closed || ring_.ring.size() > kLongestRing) return;
    for (const TetIndex r : ring_.tets)
      if (mesh_.worse(r, t)) return;
    const auto turn = turn_of(a, b);
    if (!turn) return;
    if (ring_.tets.size() > 1) {
      if (remove_edge(a, b)) best_.turn = turn;
      return;
    }
    // Nothing in its place: as good as an element at the threshold of what is worked on.
    const float gain = kWorthOfNothing - mesh_.shape(t).score;
    if (gain <= best_.gain) return;
    best_.clear();
    best_.old_tets = ring_.tets;
    best_.gain = gain;
    best_.turn = turn;
  }

  /// The boundary after the removal of its edge ab; nullopt if the mesh would not stay valid, or the boundary true.
  std::optional<MeshEditor::BoundaryChange> turn_of(VertexIndex a, VertexIndex b) {
    const VertexIndex c = ring_.ring.front(), d = ring_.ring.back();
    if (guide_->is_frozen(c) || guide_->is_frozen(d)) return std::nullopt;
    const HalfFace first = boundary_behind(ring_.tets.front(), ring_.ring[1]);
    const HalfFace second = boundary_behind(ring_.tets.back(), ring_.ring[ring_.ring.size() - 2]);
    if (mesh_.boundary_patch(first) != mesh_.boundary_patch(second)) return std::nullopt;
    if (is_edge_beyond_ring(c, d)) return std::nullopt;
    const Vec3 pa = mesh_.point(a), pb = mesh_.point(b), pc = mesh_.point(c), pd = mesh_.point(d);
    const std::array<TriangleCorners, 2> before{{{pa, pb, pd}, {pb, pa, pc}}}, after{{{pc, pd, pa}, {pd, pc, pb}}};
    for (const TriangleCorners& x : before)
      for (const TriangleCorners& y : after)
        if (!faces_alike(x, y)) return std::nullopt;
    if (!guide_->keeps_truth(before, after)) return std::nullopt;
    return MeshEditor::BoundaryChange{{first, second}, {{first, {c, d, a}}, {second, {d, c, b}}}};
  }

  HalfFace boundary_behind(TetIndex t, VertexIndex opposite) const {
    return mesh_.across(4 * t + mesh_.corner_of(t, opposite));
  }

  /// Two boundary triangles are only turned where the surface is nearly flat.
  static bool faces_alike(const TriangleCorners& x, const TriangleCorners& y) {
    constexpr double kTurn = 0.7;  // cosine
    const Vec3 n = double_area_normal(x[0], x[1], x[2]), m = double_area_normal(y[0], y[1], y[2]);
    const double along = dot(n, m);
    return along > 0 && along * along >= kTurn * kTurn * squared_length(n) * squared_length(m);
  }

  /// True if c and d are joined by an edge that would get a second fan of elements, or of boundary triangles: one that
  /// is there already, or, where a single tet goes and leaves its edge cd behind, one that lies on the boundary.
  bool is_edge_beyond_ring(VertexIndex c, VertexIndex d) {
    editor_.star(c, star_);
    for (const HalfFace h : star_) {
      const TetIndex t = h / 4;
      const Tet& corners = mesh_.tet(t);
      if (std::find(corners.begin(), corners.end(), d) == corners.end()) continue;
      if (ring_.tets.size() > 1) return true;
      for (int i = 0; i < 4; ++i)
        if (corners[i] != c && corners[i] != d && is_outside(mesh_.across(4 * t + i))) return true;
    }
    return false;
  }

  /// Adds both tets on each triangle (i, k, j) of the ring, j from k + 1 on.
  void add_triangles(VertexIndex a, VertexIndex b, int i, int k, int n) {
    const auto& r = ring_.ring;
    for (int j = k + 1; j < n; ++j) {
      index_[i][k][j] = batch_.size;
      add_candidate({r[i], r[k], r[j], b});
      add_candidate({r[i], r[j], r[k], a});
    }
  }

  /// Sets value_ of the same triangles to that of the two tets. Returns the best value.
  float value_triangles(VertexIndex a, VertexIndex b, int i, int k, int n) {
    const auto& r = ring_.ring;
    float best = kUnusable;
    for (int j = k + 1; j < n; ++j) {
      const int at = index_[i][k][j];
      value_[i][k][j] = combined(usable_value(at, {r[i], r[k], r[j], b}), usable_value(at + 1, {r[i], r[j], r[k], a}));
      best = std::max(best, value_[i][k][j]);
    }
    return best;
  }

  void try_face(TetIndex t, int i) {
    const TetIndex behind = editor_.behind(4 * t + i);
    if (behind == kNone || mesh_.worse(behind, t)) return;
    const VertexIndex a = mesh_.tet(t)[i], b = mesh_.tet(behind)[mesh_.across(4 * t + i) % 4];
    const auto [x, y, z] = face_of(mesh_.tet(t), i);
    const std::array<Tet, 3> made{{{a, b, x, y}, {a, b, y, z}, {a, b, z, x}}};
    batch_.size = 0;
    for (const Tet& m : made) add_candidate(m);
    batch_.evaluate();
    const float before = combined(value_of(mesh_.shape(t)), value_of(mesh_.shape(behind)));
    guard_ = std::min({kMeanRisesGuard, mesh_.shape(t).score, mesh_.shape(behind).score});
    float after = neutral();
    for (int k = 0; k < 3; ++k) after = combined(after, usable_value(k, made[k]));
    if (after <= before + best_.gain) return;
    best_.clear();
    best_.old_tets = {t, behind};
    for (int k = 0; k < 3; ++k) best_.add(made[k], batch_.shape(k));
    best_.gain = after - before;
  }

  MeshEditor editor_;
  EditMesh& mesh_;
  Floor floor_;
  Goal goal_;
  float guard_ = kMeanRisesGuard;  ///< for the mean, no new element may score less: this, or the worst of the old ones
  std::size_t longest_ = goal_ == Goal::kMeanQuick ? kQuickRing : kLongestRing;
  const BoundaryGuide* guide_;
  EdgeRing ring_;
  std::vector<HalfFace> star_;
  BestRefill best_;
  ShapeBatch batch_;
  int index_[kLongestRing][kLongestRing][kLongestRing];
  float value_[kLongestRing][kLongestRing][kLongestRing];
  RingFilling<kLongestRing> filling_;
};

}  // namespace

PassResult reconnect(EditMesh& mesh, float threshold, Goal goal, const RunContext& context,
                     const BoundaryGuide* guide) {
  Reconnector reconnector(mesh, goal, guide);
  return improve_each(reconnector, mesh, threshold, context);
}

}  // namespace octafront::improve
