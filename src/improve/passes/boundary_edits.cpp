// The boundary gives way where it keeps elements poor that the input does not force: what the surface front could not
// see, the elements show. Edges of the boundary collapse and its vertices move, off the input if need be, where the
// elements around lack less in sum then, and the boundary strays little.

#include "base/geometry/doubtful_parts.h"
#include "base/geometry/live_triangles.h"
#include "base/geometry/measures.h"
#include "base/mesh/link_condition.h"
#include "improve/passes/fewest_poor.h"
#include "improve/passes/passes.h"
#include "improve/passes/poor_tets.h"
#include "improve/passes/star_edit.h"
#include "improve/shape/flat_walls.h"
#include "improve/shape/input_force.h"

#include <algorithm>

namespace octafront::improve {
namespace {

/// What the sum that elements lack must fall by.
constexpr double kLeastFallByEdit = 0.1;
/// New edges are at most this many times as long as the longest edge of the star that they replace.
constexpr double kLongestOfEdit = 1.5;
/// The boundary strays by this part of the edges around the vertex that goes at most, or by the tolerance, if less.
constexpr double kMovedPart = 0.25;
/// Cosine of the angle between a new boundary triangle and the input beneath it, unless an old one was worse.
constexpr double kFacing = 0.5;
/// Below this, features may give way too: where curves of a scan's noise meet, nothing else is left to move.
constexpr float kPoorAtFeature = 0.2f;
/// Triangles that lie beyond the tolerance already may be followed by such as lie so much farther: samples differ.
constexpr double kNoWorse = 1.02;
/// How finely triangles are looked at, in edges: over these the distance changes evenly.
constexpr double kSpacing = 0.1;
/// Steps per vertex that moves at most.
constexpr int kStepsOfEdit = 8;

class BoundaryEditor {
 public:
  BoundaryEditor(EditMesh& mesh, BoundaryGuide& guide)
      : editor_(mesh),
        mesh_(mesh),
        guide_(guide),
        live_(mesh),
        force_(guide.ground().force),
        walls_(guide.ground().walls),
        floor_(mesh.floor()),
        batch_(mesh.objective()),
        star_edit_(mesh) {}

  /// Worst first, and what comes of it.
  BoundaryEdits run(float threshold, const RunContext& context) {
    std::vector<TetIndex> queue = tets_below(mesh_, threshold);
    std::sort(queue.begin(), queue.end(), [&](TetIndex s, TetIndex t) { return mesh_.worse(s, t); });
    for (std::size_t k = 0; k < queue.size(); ++k) {
      context.check();
      const TetIndex t = queue[k];
      if (!mesh_.alive(t) || mesh_.shape(t).score >= threshold || is_forced(t)) continue;
      ++edits_.result.tried;
      if (!improve(t)) continue;
      ++edits_.result.done;
      for (const TetIndex made : changed_)
        if (mesh_.shape(made).score < threshold) queue.push_back(made);
    }
    return edits_;
  }

 private:
  struct Collapse {
    VertexIndex gone = kNone, onto = kNone;
    double gain = kLeastFallByEdit;
    MeshEditor::Refill tets;
    MeshEditor::BoundaryChange change;
  };

  /// What the input itself forces stays: a wedge is not to be opened.
  bool is_forced(TetIndex t) const {
    const auto [a, b, c, d] = mesh_.tet(t);
    const Vec3 p = mesh_.point(a), q = mesh_.point(b), r = mesh_.point(c), s = mesh_.point(d);
    return force_.cause_at(centroid(p, q, r, s), std::sqrt(longest_squared_edge(p, q, r, s))) !=
           InputForce::Cause::kNone;
  }

  bool improve(TetIndex t) {
    best_ = {};
    const Tet corners = mesh_.tet(t);
    for (const VertexIndex u : corners) {
      if (!mesh_.on_boundary(u) || !guide_.may_slide(u)) continue;
      editor_.star(u, star_);
      link_ = link_at(star_);
      for (const VertexIndex w : corners)
        if (w != u && mesh_.on_boundary(w)) consider(u, w);
    }
    if (best_.gone == kNone) {
      const bool on_features = mesh_.shape(t).score < kPoorAtFeature;
      return std::any_of(corners.begin(), corners.end(), [&](VertexIndex v) { return move(v, on_features); });
    }
    if (!editor_.replace(best_.tets, &best_.change)) return false;
    changed_ = editor_.created();
    if (guide_.kind(best_.gone) == BoundaryGuide::Kind::kCurve) guide_.merge_curve(best_.gone, best_.onto);
    numbers_.clear();
    for (const HalfFace across : best_.change.gone) numbers_.push_back(across - kFirstOutside);
    live_.note_changed(numbers_);
    return true;
  }

  bool may_move(VertexIndex v, bool on_features) const {
    if (!mesh_.on_boundary(v) || guide_.is_frozen(v)) return false;
    return on_features || guide_.kind(v) == BoundaryGuide::Kind::kSurface;
  }

  /// Moves a vertex of the boundary to where the elements around it lack least, off the input if need be.
  bool move(VertexIndex v, bool on_features) {
    if (!may_move(v, on_features)) return false;
    editor_.star(v, star_);
    if (!star_edit_.load(v, star_)) return false;
    link_ = link_at(star_);
    const Vec3 from = mesh_.point(v);
    take_old();
    if (walls_.hold(old_)) return false;
    const double limit = limit_at(from);
    descent_.descend(star_edit_.batch(), from, kStepsOfEdit, [&](Vec3 to) {
      if (!star_edit_.acceptable(to, floor_)) return false;
      plan_move(v, to);
      return guide_.is_near_home(v, to, limit) && is_true(from, limit);
    });
    if (!descent_.moved()) return false;
    if (star_edit_.current_lack() - descent_.lack() < kLeastFallByEdit) return false;
    plan_move(v, descent_.place());
    if (!crosses_nothing() || !stays_near()) return false;
    star_edit_.evaluate(descent_.place());
    star_edit_.commit();
    edits_.largest_move = std::max(edits_.largest_move, distance(from, descent_.place()));
    live_.note_changed(numbers_);
    changed_.clear();
    for (const HalfFace h : star_) changed_.push_back(h / 4);
    return true;
  }

  /// The boundary triangles at v, and with v elsewhere.
  void plan_move(VertexIndex v, Vec3 to) {
    take_old();
    for (const std::uint32_t n : numbers_) {
      const Triangle t = mesh_.triangle(n);
      new_.push_back({t, corners_of(t)});
      for (int k = 0; k < 3; ++k)
        if (t[k] == v) new_.back().corners[k] = to;
    }
  }

  /// The boundary triangles at the vertex whose star is loaded.
  void take_old() {
    old_.clear(), new_.clear(), numbers_.clear();
    for (const HalfFace h : star_) {
      for (int i = 0; i < 4; ++i) {
        const HalfFace across = mesh_.across(4 * (h / 4) + i);
        if (i == static_cast<int>(h % 4) || !is_outside(across)) continue;
        numbers_.push_back(across - kFirstOutside);
        old_.push_back(corners_of(mesh_.triangle(numbers_.back())));
      }
    }
  }

  /// Remembers the collapse of u, whose star is loaded, onto w if it is the best so far.
  void consider(VertexIndex u, VertexIndex w) {
    if (guide_.is_frozen(w)) return;
    if (guide_.kind(u) == BoundaryGuide::Kind::kCurve && !guide_.is_feature_edge(u, w)) return;
    if (!std::binary_search(link_.wall_vertices.begin(), link_.wall_vertices.end(), w)) return;
    Collapse c{u, w, 0, {}, {}};
    if (!plan_tets(c) || !(c.gain > best_.gain) || !keeps_manifold(w) || !plan_boundary(c)) return;
    const Vec3 p = mesh_.point(u);
    if (is_true(p, limit_at(p)) && crosses_nothing() && stays_near()) best_ = std::move(c);
  }

  /// The tets with u at w, and what is gained; false if one would not be usable.
  bool plan_tets(Collapse& c) {
    batch_.size = 0;
    if (star_.size() > ShapeBatch::kBatch) return false;
    const Vec3 p = mesh_.point(c.onto), from = mesh_.point(c.gone);
    double longest = 0;
    for (const VertexIndex v : link_.vertices) longest = std::max(longest, distance(from, mesh_.point(v)));
    for (const HalfFace h : star_) {
      c.tets.old_tets.push_back(h / 4);
      c.gain += lack_of(mesh_.shape(h / 4).score);
      if (mesh_.has(h / 4, c.onto)) continue;
      Tet made = mesh_.tet(h / 4);
      made[h % 4] = c.onto;
      for (const VertexIndex v : made)
        if (distance(p, mesh_.point(v)) > kLongestOfEdit * longest) return false;
      c.tets.new_tets.push_back(made);
      batch_.add(mesh_.point(made[0]), mesh_.point(made[1]), mesh_.point(made[2]), mesh_.point(made[3]));
    }
    batch_.evaluate();
    for (int k = 0; k < batch_.size; ++k) {
      const Shape s = batch_.shape(k);
      if (!editor_.is_usable(c.tets.new_tets[k], s, floor_)) return false;
      c.tets.shapes.push_back(s);
      c.gain -= lack_of(s.score);
    }
    return !c.tets.new_tets.empty();
  }

  bool keeps_manifold(VertexIndex w) {
    editor_.star(w, star_of_other_);
    return may_contract(link_, link_at(star_of_other_), link_at(star_, w));
  }

  /// Of the vertex opposite these faces, or of its edge to w.
  VertexLink link_at(std::span<const HalfFace> star, VertexIndex w = kNone) const {
    const auto tet = [&](TetIndex t) -> const Tet& { return mesh_.tet(t); };
    return link_of(
        star, tet, [&](HalfFace h) { return is_outside(mesh_.across(h)); }, w);
  }

  /// The boundary triangles at u, and those with w in its place; false if a patch would vanish or two curves merge.
  bool plan_boundary(Collapse& c) {
    std::vector<std::uint32_t> left, vanishing;
    take_old();
    for (const std::uint32_t n : numbers_) {
      const HalfFace across = kFirstOutside + n;
      Triangle t = mesh_.triangle(n);
      c.change.gone.push_back(across);
      const bool vanishes = std::find(t.begin(), t.end(), c.onto) != t.end();
      (vanishes ? vanishing : left).push_back(mesh_.boundary_patch(across));
      if (vanishes && merges_curves(t, c)) return false;
      if (vanishes) continue;
      std::replace(t.begin(), t.end(), c.gone, c.onto);
      c.change.made.push_back({across, t});
      new_.push_back({t, corners_of(t)});
    }
    return std::all_of(vanishing.begin(), vanishing.end(),
                       [&](std::uint32_t p) { return std::find(left.begin(), left.end(), p) != left.end(); });
  }

  /// Whether both edges of a vanishing triangle that become one lie on curves.
  bool merges_curves(const Triangle& t, const Collapse& c) const {
    for (const VertexIndex x : t)
      if (x != c.gone && x != c.onto) return guide_.is_feature_edge(c.gone, x) && guide_.is_feature_edge(c.onto, x);
    return false;
  }

  TriangleCorners corners_of(const Triangle& t) const {
    return {mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2])};
  }

  /// How far the boundary may stray around the vertex at p.
  double limit_at(Vec3 p) const {
    double edges = 0;
    for (const VertexIndex v : link_.wall_vertices) edges += distance(p, mesh_.point(v));
    return std::min(guide_.tolerance_at(p), kMovedPart * edges / static_cast<double>(link_.wall_vertices.size()));
  }

  /// Whether the new triangles stray by no more than the limit, from the vertex p too, which the old ones had in
  /// common.
  bool is_true(Vec3 p, double limit) const {
    double away = HUGE_VAL;
    std::vector<TriangleCorners> after;
    for (const IdTriangle& t : new_) {
      after.push_back(t.corners);
      away =
          std::min(away, squared_distance(p, closest_point_on_triangle(p, t.corners[0], t.corners[1], t.corners[2])));
    }
    if (away > limit * limit) return false;
    const BoundaryGuide::Truth had = guide_.truth_of(old_), has = guide_.truth_of(after);
    return has.squared_distance <= std::max(limit * limit, had.squared_distance) &&
           has.cosine >= std::min(kFacing, had.cosine);
  }

  double mean_edge() const {
    double sum = 0;
    for (const TriangleCorners& t : old_) sum += distance(t[0], t[1]);
    return sum / static_cast<double>(old_.size());
  }

  static bool is_near(Vec3 p, double d, const TriangleCorners& t) {
    return squared_distance(p, closest_point_on_triangle(p, t[0], t[1], t[2])) < d * d;
  }

  /// How far triangles lie from the input at the worst of their doubtful parts; the tolerance if there are none.
  template <class Finest>
  double worst_distance(const std::vector<TriangleCorners>& triangles, const Finest& finest) const {
    const double limit = guide_.tolerance();
    double worst = limit;
    const auto is_near_input = [&](Vec3 p, double d) { return guide_.tree().is_within(p, d); };
    for (const TriangleCorners& t : triangles)
      for_each_doubtful_part(t, farther_than(limit, HUGE_VAL, is_near_input, finest), [&](Vec3 p) {
        worst = std::max(worst, std::sqrt(guide_.tree().nearest(p).squared_distance));
        return true;
      });
    return worst;
  }

  /// Whether input and new triangles lie within the tolerance of each other, by all their parts, or where they do not,
  /// did not before.
  bool stays_near() {
    const double limit = guide_.tolerance();
    const auto finest = [part = std::max(limit, kSpacing * mean_edge())](Vec3) { return part; };
    const auto near_new = [&](Vec3 p, double d) {
      return std::any_of(new_.begin(), new_.end(), [&](const IdTriangle& t) { return is_near(p, d, t.corners); }) ||
             live_.is_within(p, d, numbers_);
    };
    const auto is_kept = [&](Vec3 p) {
      return near_new(p, limit) ||
             std::none_of(old_.begin(), old_.end(), [&](const TriangleCorners& t) { return is_near(p, limit, t); });
    };
    Box3 box;
    for (const TriangleCorners& t : old_)
      for (const Vec3 p : t) box.add(p);
    const Vec3 around{limit, limit, limit};
    box = {box.lo - around, box.hi + around};
    // An input triangle may be far larger than what changed: elsewhere nothing of it needs a look.
    const auto is_doubtful = [&, look = farther_than(limit, limit, near_new, finest)](PartCorners part, Vec3 middle,
                                                                                      double reach) {
      return box_of_part(part).overlaps(box) ? look(part, middle, reach) : Part::kWithin;
    };
    if (!guide_.tree().for_each_box_near(box, [&](std::uint32_t, const TriangleCorners& t) {
          return for_each_doubtful_part(t, is_doubtful, is_kept);
        }))
      return false;
    std::vector<TriangleCorners> made;
    for (const IdTriangle& t : new_) made.push_back(t.corners);
    const double had = worst_distance(old_, finest);
    return worst_distance(made, finest) <= (had > limit ? kNoWorse * had : limit);
  }

  bool crosses_nothing() {
    for (const IdTriangle& t : new_)
      if (live_.is_degenerate(t.corners)) return false;
    return live_.crossings_among(new_, numbers_, 1) == 0;
  }

  MeshEditor editor_;
  EditMesh& mesh_;
  BoundaryGuide& guide_;
  LiveTriangles<EditMesh> live_;
  const InputForce& force_;
  const FlatWalls& walls_;
  Floor floor_;
  ShapeBatch batch_;
  std::vector<HalfFace> star_, star_of_other_;
  VertexLink link_;
  std::vector<TriangleCorners> old_;
  std::vector<IdTriangle> new_;
  std::vector<std::uint32_t> numbers_;  ///< of the old ones
  StarEdit star_edit_;
  LackDescent descent_;
  Collapse best_;
  BoundaryEdits edits_;
  std::vector<TetIndex> changed_;
};

}  // namespace

BoundaryEdits edit_boundary(EditMesh& mesh, float threshold, BoundaryGuide& guide, const RunContext& context) {
  return BoundaryEditor(mesh, guide).run(threshold, context);
}

}  // namespace octafront::improve
