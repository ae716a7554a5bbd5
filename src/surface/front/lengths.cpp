#include "surface/edits/coarsen.h"
#include "surface/edits/local_guards.h"
#include "surface/edits/sweep.h"
#include "surface/front/front_steps.h"

#include <algorithm>
#include <optional>

namespace octafront::surface {

namespace {

/// Lengths beyond these, in wanted sizes, are mended; the front and smoothing leave few.
constexpr double kLongEdge = 1.5, kShortEdge = 0.6;
/// Triangles below this squared quality are bad (2r/R of about 0.5).
constexpr double kBadLength = 0.2;
/// An operation on a bad triangle must raise the worst around by this factor, so that two never undo each other.
constexpr double kGainOfLengths = 1.3;
/// The same for points of curves, by 2r/R.
constexpr double kCurveGain = 1.15;
/// Mending one triangle may spoil or free another.
constexpr int kMendRounds = 3;
/// Height of an equilateral triangle.
constexpr double kEquilateral = 0.8660254037844386;
/// Edges between points of curves shorter than this, in wanted sizes, may vanish, with a corner, where they spoil
/// triangles.
constexpr double kTiny = 0.2;
/// Segments that turn by less than this (sine) are one line.
constexpr double kStraight = 1e-9;
constexpr TurnLimits kEdgeLimits{0.2, -0.3};
/// A split point lies near the middle of its edge, or the walk to it went astray.
constexpr double kAstrayOfEdge = 0.35;

class LengthAdjuster {
 public:
  LengthAdjuster(WorkingMesh& mesh, const InputSurface& input, CurvePoints& curve_points, const SizeField& sizes,
                 ImproveCounts& counts)
      : mesh_(mesh), input_(input), curve_points_(curve_points), sizes_(sizes), counts_(counts), star_(mesh) {}

  void run() {
    collapse_short();
    split_long();
    mend_all();
  }

  void mend_all() {
    const auto is_bad = [&](std::uint32_t t) {
      return !mesh_.is_removed(t) && !mesh_.is_back(t) && quality(3 * t) < kBadLength;
    };
    for (int round = 0; round < kMendRounds; ++round) {
      const bool any = sweep(
          mesh_, [&] { return mesh_.triangle_count(); }, is_bad,
          [&](std::uint32_t t) {
            return !mesh_.is_removed(t) &&
                   std::ranges::any_of(mesh_.triangle(t), [&](VertexIndex v) { return has_changed(v); });
          },
          [&](std::uint32_t t) { return is_bad(t) && mend(t); });
      if (!any) break;
    }
  }

 private:
  bool has_changed(VertexIndex v) const { return mesh_.is_marked(v, WorkingMesh::kForSweep); }

  void collapse_short() {
    const auto is_wanted = [&](VertexIndex v) {
      return mesh_.kind[v] == VertexKind::kFree && mesh_.outgoing[v] != kNone && has_short(v);
    };
    sweep(
        mesh_, [&, vertices = mesh_.points.size()] { return vertices; }, is_wanted,
        [&](VertexIndex v) { return has_changed(v); },
        [&](VertexIndex v) { return is_wanted(v) && collapse_short_at(v); });
  }

  void split_long() {
    const auto is_wanted = [&](HalfEdge h) {
      return mesh_.start[h] != kNone && h < mesh_.twin[h] && relative_length(h) > kLongEdge;
    };
    sweep(
        mesh_, [&, half_edges = mesh_.start.size()] { return half_edges; }, is_wanted,
        [&](HalfEdge h) {
          return mesh_.start[h] != kNone && (has_changed(mesh_.start[h]) || has_changed(mesh_.end(h)));
        },
        [&](HalfEdge h) { return is_wanted(h) && split(h); });
  }

  /// Squared quality of the triangle of h.
  double quality(HalfEdge h) const {
    return squared_quality(mesh_.points[mesh_.start[h]], mesh_.points[mesh_.end(h)], mesh_.points[mesh_.apex(h)]);
  }
  double relative_length(HalfEdge h) const {
    const VertexIndex a = mesh_.start[h], b = mesh_.end(h);
    return 2 * distance(mesh_.points[a], mesh_.points[b]) / (mesh_.size[a] + mesh_.size[b]);
  }

  bool has_short(VertexIndex v) const {
    bool is_short = false;
    mesh_.for_each_outgoing(v, [&](HalfEdge h) { is_short = is_short || relative_length(h) < kShortEdge; });
    return is_short;
  }

  /// The first of its short edges that may collapse, does; false if none may.
  bool collapse_short_at(VertexIndex v) {
    star_.gather(v);
    const double now = star_.quality_now();
    for (std::size_t i = 0; i < star_.ring().size(); ++i) {
      const HalfEdge h = star_.ring()[i];
      if (relative_length(h) >= kShortEdge || star_.longest_after(i) > kLongEdge) continue;
      if (!(star_.quality_after(i, kEdgeLimits, std::min(0.5 * now, kBadLength)) > 0) || !mesh_.may_collapse(h))
        continue;
      mesh_.collapse(h);
      ++counts_.collapses;
      return true;
    }
    return false;
  }

  bool split(HalfEdge h) {
    if (!mesh_.is_feature[h]) return split_inside(h);
    const bool done = curve_points_.halve(h);
    counts_.splits += done;
    return done;
  }

  /// The middle is walked to from an end inside a patch; where both lie on curves, from a vertex opposite.
  bool split_inside(HalfEdge h) {
    const HalfEdge g = mesh_.twin[h];
    const Vec3 a = mesh_.points[mesh_.start[h]], b = mesh_.points[mesh_.start[g]];
    for (const VertexIndex from : {mesh_.start[h], mesh_.start[g], mesh_.apex(h), mesh_.apex(g)}) {
      if (mesh_.kind[from] != VertexKind::kFree) continue;
      const std::optional<SurfacePoint> x = walk_from(from, (a + b) * 0.5);
      if (!x || distance(x->p, (a + b) * 0.5) > kAstrayOfEdge * distance(a, b) || !split_is_sound(h, x->p)) continue;
      const Vec3 normal = input_.normal_at(x->face, x->p);
      mesh_.split_edge(h, mesh_.add_vertex(x->p, VertexKind::kFree, normal, sizes_.at(x->p), x->face));
      ++counts_.splits;
      return true;
    }
    return false;
  }

  std::optional<SurfacePoint> walk_from(VertexIndex v, Vec3 target) const {
    const Vec3 p = mesh_.points[v], n = mesh_.normal[v];
    const Vec3 along = normalized((target - p) - n * dot(target - p, n));
    SurfacePoint x;
    if (walk(input_, {p, mesh_.face[v]}, along, n, distance(p, target), x) != WalkEnd::kArrived) return std::nullopt;
    return x;
  }

  bool split_is_sound(HalfEdge h, Vec3 x) const {
    const HalfEdge g = mesh_.twin[h];
    const Vec3 star = mesh_.area_vector(h / 3) + mesh_.area_vector(g / 3);
    for (const HalfEdge side : {next_of(h), previous_of(h), next_of(g), previous_of(g)}) {
      const Vec3 a = mesh_.points[mesh_.start[side]] - x, b = mesh_.points[mesh_.end(side)] - x;
      if (!turns_little(cross(a, b), star, kEdgeLimits.star)) return false;
    }
    return true;
  }

  /// True if something was done about the triangle.
  bool mend(std::uint32_t t) {
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      if (flip_if_better(h)) return true;
    }
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      if (mesh_.kind[mesh_.start[h]] == VertexKind::kFree && move_if_better(mesh_.start[h])) return true;
    }
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      if (mesh_.kind[mesh_.start[h]] == VertexKind::kFree && remove_if_better(mesh_.start[h])) return true;
    }
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      if (mesh_.kind[mesh_.start[h]] != VertexKind::kCurve || !curve_points_.relieve(mesh_.start[h], kCurveGain))
        continue;
      ++counts_.moves;
      return true;
    }
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      if (!mesh_.is_feature[h] || !curve_points_.split(h, kCurveGain)) continue;
      ++counts_.splits;
      return true;
    }
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      if (relative_length(h) > kTiny || !(mesh_.on_curve(mesh_.start[h]) && mesh_.on_curve(mesh_.end(h)))) continue;
      if (merge_if_better(h) || merge_if_better(mesh_.twin[h])) return true;
    }
    return false;
  }

  /// Tries the middle of the neighbours, and the mean of the best places as the triangles around see it, the worse a
  /// triangle the more it counts.
  bool move_if_better(VertexIndex v) {
    const Vec3 p = mesh_.points[v], n = mesh_.normal[v];
    ring_.clear();
    Vec3 star;
    mesh_.for_each_outgoing(v, [&](HalfEdge h) {
      ring_.push_back({mesh_.points[mesh_.end(h)], mesh_.points[mesh_.apex(h)]});
      star += mesh_.area_vector(h / 3);
    });
    Vec3 middle, ideal;
    double weights = 0, worst = 1;
    for (const auto& [a, b] : ring_) {
      const double q = squared_quality(p, a, b), w = 1 / (q + 0.01);
      middle += a / static_cast<double>(ring_.size());
      ideal += ((a + b) * 0.5 + normalized(cross(n, b - a)) * (kEquilateral * distance(a, b))) * w;
      weights += w;
      worst = std::min(worst, q);
    }
    for (const Vec3 target : {ideal / weights, middle}) {
      const Vec3 d = (target - p) - n * dot(target - p, n);
      const double l = length(d);
      SurfacePoint x;
      if (!(l > 0) || walk(input_, {p, mesh_.face[v]}, d / l, n, l, x) != WalkEnd::kArrived) continue;
      if (!gets_better(x.p, star, kGainOfLengths * worst)) continue;
      mesh_.points[v] = x.p;
      mesh_.face[v] = x.face;
      mesh_.normal[v] = input_.normal_at(x.face, x.p);
      mesh_.size[v] = sizes_.at(x.p);
      mesh_.mark_star_changed(v);
      ++counts_.moves;
      return true;
    }
    return false;
  }

  /// Whether each of the ring's triangles is better than `least` with its apex at p, and none turns too far.
  bool gets_better(Vec3 p, Vec3 star, double least) const {
    return std::ranges::all_of(ring_, [&](const auto& e) {
      const auto& [a, b] = e;
      return turns_little(cross(a - p, b - p), star, kEdgeLimits.star) && squared_quality(p, a, b) > least;
    });
  }

  /// Whether a straight line of two segments or more ends at the corner: it would bend if the corner moved.
  bool ends_straight_line(VertexIndex corner) const {
    if (mesh_.kind[corner] != VertexKind::kCorner) return false;
    bool found = false;
    mesh_.for_each_outgoing(corner, [&](HalfEdge h) {
      const VertexIndex x = mesh_.end(h);
      if (!mesh_.is_feature[h] || mesh_.kind[x] != VertexKind::kCurve) return;
      const Vec3 along = normalized(mesh_.points[x] - mesh_.points[corner]);
      mesh_.for_each_outgoing(x, [&](HalfEdge g) {
        if (!mesh_.is_feature[g] || mesh_.end(g) == corner) return;
        const Vec3 further = normalized(mesh_.points[mesh_.end(g)] - mesh_.points[x]);
        found |= dot(along, further) > 0 && length(cross(along, further)) < kStraight;
      });
    });
    return found;
  }

  /// Moves the start of a tiny edge between curves to its end: details far below the element size make only slivers.
  bool merge_if_better(HalfEdge h) {
    const VertexIndex u = mesh_.start[h], w = mesh_.end(h);
    if (mesh_.first_back != kNone) return false;  // regions keep their corners
    star_.gather(u);
    const auto i = std::find(star_.ring().begin(), star_.ring().end(), h) - star_.ring().begin();
    const double least = kGainOfLengths * star_.quality_now();
    if (!(star_.quality_after(static_cast<std::size_t>(i), kEdgeLimits, least) > least)) return false;
    if (!mesh_.may_collapse(h, true) || ends_straight_line(u)) return false;
    if (mesh_.kind[u] == VertexKind::kCorner) mesh_.kind[w] = VertexKind::kCorner;
    mesh_.collapse(h);
    ++counts_.collapses;
    return true;
  }

  bool flip_if_better(HalfEdge h) {
    if (mesh_.is_feature[h]) return false;
    const HalfEdge g = mesh_.twin[h];
    const Vec3 a = mesh_.points[mesh_.start[h]], b = mesh_.points[mesh_.end(h)];
    const Vec3 c = mesh_.points[mesh_.apex(h)], d = mesh_.points[mesh_.apex(g)];
    const double before = std::min(quality(h), quality(g));
    if (!(std::min(squared_quality(a, d, c), squared_quality(b, c, d)) > kGainOfLengths * before)) return false;
    if (!flip_is_sound(mesh_, h, kEdgeLimits) || !mesh_.may_flip(h)) return false;
    mesh_.flip(h);
    ++counts_.flips;
    return true;
  }

  bool remove_if_better(VertexIndex v) {
    star_.gather(v);
    double best = kGainOfLengths * star_.quality_now();
    HalfEdge chosen = kNone;
    for (std::size_t i = 0; i < star_.ring().size(); ++i) {
      const HalfEdge h = star_.ring()[i];
      const double quality = star_.quality_after(i, kEdgeLimits, best);
      if (!(quality > best) || star_.longest_after(i) > kLongEdge || !mesh_.may_collapse(h)) continue;
      best = quality;
      chosen = h;
    }
    if (chosen == kNone) return false;
    mesh_.collapse(chosen);
    ++counts_.collapses;
    return true;
  }

  WorkingMesh& mesh_;
  const InputSurface& input_;
  CurvePoints& curve_points_;
  const SizeField& sizes_;
  ImproveCounts& counts_;
  StarCollapse star_;
  std::vector<std::pair<Vec3, Vec3>> ring_;  ///< the far edges of a vertex's triangles
};

}  // namespace

void mend_triangles(WorkingMesh& mesh, const InputSurface& input, CurvePoints& curve_points, const SizeField& sizes,
                    ImproveCounts& counts) {
  LengthAdjuster(mesh, input, curve_points, sizes, counts).mend_all();
}

void adjust_lengths(WorkingMesh& mesh, const InputSurface& input, CurvePoints& curve_points, const SizeField& sizes,
                    ImproveCounts& counts) {
  LengthAdjuster(mesh, input, curve_points, sizes, counts).run();
}

}  // namespace octafront::surface
