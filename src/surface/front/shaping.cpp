
#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "surface/edits/local_guards.h"
#include "surface/edits/surface_blocks.h"
#include "surface/front/front_steps.h"

#include <algorithm>
#include <atomic>
#include <numbers>
#include <span>
#include <utility>

namespace octafront::surface {

namespace {

constexpr TurnLimits kFlipLimits{0.7, 0.2};
constexpr TurnLimits kMoveLimits{0.5, 0.2};
/// Steps shorter than this, in element sizes, are not worth a walk (a fifth of that gains .001 of mean quality).
constexpr double kLeastFreeStep = 1e-2;
/// A flip for the sake of valence may not make a triangle worse than this (squared quality).
constexpr double kValenceFlipQuality = 0.25;
/// Rounds of flips and smoothing: quality gains little beyond. At coarse sizes the third is worth .001 of mean quality,
/// in large meshes .0002 for a sixth of the time.
constexpr int kImproveRounds = 3, kRoundsOfMany = 2;
constexpr std::size_t kMany = 100000;

/// Moves vertices to where the triangles around them are better. Each thread has its own.
class VertexSmoother {
 public:
  VertexSmoother(WorkingMesh& mesh, const InputSurface& input, const SizeField& sizes, const CurvePoints& curve_points)
      : mesh_(mesh),
        input_(input),
        sizes_(sizes),
        curve_points_(curve_points),
        is_uniform_(sizes.min_size() == sizes.max_size()) {}

  bool move(VertexIndex v) {
    if (mesh_.kind[v] == VertexKind::kFree) return move_inside(v);
    return mesh_.kind[v] == VertexKind::kCurve && curve_points_.slide(v);
  }

 private:
  struct Star {
    double sum = 0, worst = 1;
  };

  /// Quality of the ring's triangles with the vertex at p; false if one turns too far.
  bool judge(Vec3 p, Vec3 normal, Star& star) const {
    star = {};
    for (const auto& [a, b] : ring_) {
      const Vec3 u = a - p, v = b - p, area_vector = cross(u, v);
      const double l = squared_length(u) + squared_length(v) + squared_length(a - b), n = squared_length(area_vector);
      const double along = dot(area_vector, normal);
      if (!(along > 0) || along * along < kMoveLimits.surface * kMoveLimits.surface * n) return false;
      const double q = 12 * n / (l * l);
      star.sum += q;
      star.worst = std::min(star.worst, q);
    }
    return true;
  }

  bool move_inside(VertexIndex v) {
    const Vec3 p = mesh_.points[v], n = mesh_.normal[v];
    const double h = mesh_.size[v];
    ring_.clear();
    Vec3 sum, star_vector;
    double weights = 0;
    mesh_.for_each_outgoing(v, [&](HalfEdge o) {
      const VertexIndex ia = mesh_.end(o), ib = mesh_.apex(o);
      const Vec3 a = mesh_.points[ia], b = mesh_.points[ib], area_vector = cross(a - p, b - p);
      ring_.push_back({a, b});
      const double size = h + mesh_.size[ia] + mesh_.size[ib];
      const double weight = length(area_vector) / (size * size);
      sum += ((a - p) + (b - p)) * (weight / 3);
      star_vector += area_vector;
      weights += weight;
    });
    if (!(weights > 0)) return false;
    Vec3 d = sum / weights;
    d -= n * dot(d, n);
    const double step = length(d);
    if (step < kLeastFreeStep * h) return false;
    Star before;
    const bool was_sound = judge(p, n, before);
    for (const double part : {1.0, 0.4}) {
      SurfacePoint x;
      if (walk(input_, {p, mesh_.face[v]}, d / step, n, part * step, x) != WalkEnd::kArrived) continue;
      const Vec3 normal = input_.normal_at(x.face, x.p);
      Star after;
      if (!judge(x.p, normal, after) || !stays_in_front(x.p, star_vector)) continue;
      if (was_sound && !(after.sum > before.sum && after.worst >= std::min(before.worst, 0.3))) continue;
      mesh_.points[v] = x.p;
      mesh_.face[v] = x.face;
      mesh_.normal[v] = normal;
      if (!is_uniform_) mesh_.size[v] = sizes_.at(x.p);
      mesh_.mark_star_changed(v);
      return true;
    }
    return false;
  }

  bool stays_in_front(Vec3 p, Vec3 star_vector) const {
    return std::all_of(ring_.begin(), ring_.end(), [&](const auto& edge) {
      return turns_little(cross(edge.first - p, edge.second - p), star_vector, kMoveLimits.star);
    });
  }

  WorkingMesh& mesh_;
  const InputSurface& input_;
  const SizeField& sizes_;
  CurvePoints curve_points_;
  bool is_uniform_;
  std::vector<std::pair<Vec3, Vec3>> ring_;
};

class SurfaceImprover {
 public:
  SurfaceImprover(WorkingMesh& mesh, const InputSurface& input, const std::vector<Curve>& curves,
                  const SizeField& sizes, const RunContext& context, ImproveCounts& counts)
      : mesh_(mesh),
        input_(input),
        sizes_(sizes),
        context_(context),
        counts_(counts),
        curve_points_(mesh, input, curves, sizes),
        blocks_(mesh) {}

  void run() {
    const int rounds = mesh_.points.size() < kMany ? kImproveRounds : kRoundsOfMany;
    for (int round = 0; round < rounds; ++round) {
      if (round > 0) {
        adjust_lengths(mesh_, input_, curve_points_, sizes_, counts_);
        blocks_ = SurfaceBlocks(mesh_);
      }
      count_valences();
      equalize_valences();
      smooth();
      smooth();
      delaunay();
    }
    smooth();
    delaunay();
    mend_triangles(mesh_, input_, curve_points_, sizes_, counts_);
  }

 private:
  template <class Test>
  std::vector<HalfEdge> edges_that(const Test& test) const {
    return parallel_select(mesh_.start.size(),
                           [&](HalfEdge h) { return mesh_.start[h] != kNone && h < mesh_.twin[h] && test(h); });
  }

  void delaunay() {
    const auto may_have_turned = [&](VertexIndex v) { return mesh_.is_marked(v, WorkingMesh::kForFlips); };
    std::vector<HalfEdge> edges =
        edges_that([&](HalfEdge h) { return may_have_turned(mesh_.start[h]) && may_have_turned(mesh_.end(h)); });
    mesh_.clear_marks(WorkingMesh::kForFlips);
    counts_.flips += make_delaunay(mesh_, blocks_, std::move(edges), kFlipLimits);
  }

  /// Valence minus the one wanted: six inside a patch, on features one triangle for each 60 degrees of a sector.
  void count_valences() {
    excess_.resize(mesh_.points.size());
    parallel_for(mesh_.points.size(), [&](std::size_t i) {
      const auto v = static_cast<VertexIndex>(i);
      if (mesh_.outgoing[v] == kNone) return;
      excess_[v] = mesh_.on_curve(v) ? -wanted_valence(v) : -6;
      mesh_.for_each_outgoing(v, [&](HalfEdge h) { excess_[v] += !mesh_.is_back(h / 3); });
    });
  }

  int wanted_valence(VertexIndex v) const {
    int wanted = 0;
    double angle = 0;
    const auto close_sector = [&] {
      if (angle > 0) wanted += std::max(1, static_cast<int>(std::lround(angle * 3 / std::numbers::pi)));
      angle = 0;
    };
    HalfEdge first = mesh_.outgoing[v];
    mesh_.for_each_outgoing(v, [&](HalfEdge h) {
      if (mesh_.is_feature[h]) first = h;
    });
    HalfEdge h = first;
    do {
      if (mesh_.is_feature[h]) close_sector();
      if (mesh_.is_back(h / 3)) {
        h = mesh_.rotated(h);
        continue;
      }
      const Vec3 p = mesh_.points[v], a = mesh_.points[mesh_.end(h)] - p, b = mesh_.points[mesh_.apex(h)] - p;
      angle += elementary::atan2(length(cross(a, b)), dot(a, b));
      h = mesh_.rotated(h);
    } while (h != first);
    close_sector();
    return wanted;
  }

  void equalize_valences() {
    std::atomic<std::uint64_t> flips = 0;
    blocks_.run(
        edges_that([&](HalfEdge h) { return !mesh_.is_feature[h]; }), [&](HalfEdge h) { return mesh_.start[h]; },
        [&](const SurfaceBlocks::Block& block, std::span<const HalfEdge> edges, std::vector<HalfEdge>& later) {
          for (const HalfEdge h : edges)
            if (block.has_both(h))
              flips += equalize_valences(h);
            else
              later.push_back(h);
        });
    counts_.flips += flips;
  }

  bool equalize_valences(HalfEdge h) {
    const VertexIndex a = mesh_.start[h], b = mesh_.end(h), c = mesh_.apex(h), d = mesh_.apex(mesh_.twin[h]);
    // (e - 1)^2 - e^2 = 1 - 2 e and (e + 1)^2 - e^2 = 1 + 2 e.
    if (4 - 2 * (excess_[a] + excess_[b]) + 2 * (excess_[c] + excess_[d]) >= 0) return false;
    if (mesh_.is_feature[h] || !valence_flip_is_good(h) || !mesh_.may_flip(h)) return false;
    mesh_.flip(h);
    --excess_[a], --excess_[b], ++excess_[c], ++excess_[d];
    return true;
  }

  bool valence_flip_is_good(HalfEdge h) const {
    const Vec3 a = mesh_.points[mesh_.start[h]], b = mesh_.points[mesh_.end(h)];
    const Vec3 c = mesh_.points[mesh_.apex(h)], d = mesh_.points[mesh_.apex(mesh_.twin[h])];
    if (squared_quality(a, d, c) < kValenceFlipQuality || squared_quality(b, c, d) < kValenceFlipQuality) return false;
    return flip_is_sound(mesh_, h, kFlipLimits);
  }

  void smooth() {
    std::vector<VertexIndex> vertices = parallel_select(mesh_.points.size(), [&](VertexIndex v) {
      return mesh_.is_marked(v, WorkingMesh::kForSmoothing) && mesh_.outgoing[v] != kNone;
    });
    std::atomic<std::uint64_t> moves = 0;
    blocks_.run(
        std::move(vertices), [](VertexIndex v) { return v; },
        [&](const SurfaceBlocks::Block& block, std::span<const VertexIndex> of_block, std::vector<VertexIndex>& later) {
          context_.check();
          VertexSmoother& smoother =
              smoothers_.local([&] { return VertexSmoother(mesh_, input_, sizes_, curve_points_); });
          for (const VertexIndex v : of_block) {
            if (!block.has_star(v)) {
              later.push_back(v);
              continue;
            }
            mesh_.changed[v] &= static_cast<std::uint8_t>(~WorkingMesh::kForSmoothing);
            moves += smoother.move(v);
          }
        });
    counts_.moves += moves;
  }

  WorkingMesh& mesh_;
  const InputSurface& input_;
  const SizeField& sizes_;
  const RunContext& context_;
  ImproveCounts& counts_;
  CurvePoints curve_points_;
  SurfaceBlocks blocks_;
  PerThread<VertexSmoother> smoothers_;
  std::vector<int> excess_;
};

}  // namespace

void improve_surface(WorkingMesh& mesh, const InputSurface& input, const std::vector<Curve>& curves,
                     const SizeField& sizes, const RunContext& context, ImproveCounts& counts) {
  SurfaceImprover(mesh, input, curves, sizes, context, counts).run();
}

}  // namespace octafront::surface
