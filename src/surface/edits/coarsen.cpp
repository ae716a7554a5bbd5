#include "surface/edits/coarsen.h"

#include "base/core/parallel.h"
#include "surface/edits/surface_blocks.h"

#include <algorithm>
#include <span>
#include <utility>

namespace octafront::surface {

void StarCollapse::gather(VertexIndex v) {
  ring_.clear();
  mesh_.for_each_outgoing(v, [&](HalfEdge h) { ring_.push_back(h); });
  if (mesh_.on_curve(v)) {
    const auto first = std::find_if(ring_.begin(), ring_.end(), [&](HalfEdge h) { return mesh_.is_feature[h]; });
    if (first != ring_.end()) std::rotate(ring_.begin(), first, ring_.end());
  }
  stars_.resize(ring_.size());
  for (std::size_t i = 0; i < ring_.size();) {
    std::size_t j = i;
    Vec3 sum;
    do {
      sum += mesh_.area_vector(ring_[j++] / 3);
    } while (j < ring_.size() && !mesh_.is_feature[ring_[j]]);
    for (; i < j; ++i) stars_[i] = sum;
  }
}

double StarCollapse::quality_now() const {
  double worst = 1;
  for (const HalfEdge h : ring_) {
    if (mesh_.is_back(h / 3)) continue;
    worst = std::min(
        worst, squared_quality(mesh_.points[mesh_.start[h]], mesh_.points[mesh_.end(h)], mesh_.points[mesh_.apex(h)]));
  }
  return worst;
}

double StarCollapse::quality_after(std::size_t towards, const TurnLimits& limits, double least) const {
  const VertexIndex w = mesh_.end(ring_[towards]);
  const Vec3 pw = mesh_.points[w];
  double worst = 1;
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    const VertexIndex p = mesh_.end(ring_[i]), q = mesh_.apex(ring_[i]);
    if (p == w || q == w || mesh_.is_back(ring_[i] / 3)) continue;
    const Vec3 pp = mesh_.points[p], pq = mesh_.points[q];
    const Vec3 area_vector = cross(pp - pw, pq - pw);
    worst = std::min(worst, squared_quality(pw, pp, pq));
    if (!(worst > least)) return 0;
    if (!turns_little(area_vector, stars_[i], limits.star)) return 0;
    if (!faces_outward(mesh_, area_vector, {w, p, q}, limits.surface)) return 0;
  }
  return worst;
}

double StarCollapse::longest_after(std::size_t towards) const {
  const VertexIndex w = mesh_.end(ring_[towards]);
  double longest = 0;
  for (const HalfEdge h : ring_) {
    const VertexIndex p = mesh_.end(h);
    if (p == w || mesh_.is_behind(h)) continue;
    const double size = 0.5 * (mesh_.size[w] + mesh_.size[p]);
    longest = std::max(longest, distance(mesh_.points[w], mesh_.points[p]) / size);
  }
  return longest;
}

namespace {

/// One pass over what is left: how far triangles may turn, and how many triangles may meet at a vertex.
struct PassLimits {
  TurnLimits turn;
  int valence;
};

/// Strict while there is much to choose from, loose for the last few (on scans the normals at the vertices are noise
/// at the scale of an element; refusing left hundreds of input vertices). A pass is repeated while it removes a tenth.
constexpr PassLimits kPasses[] = {
    {{0.8, 0.5}, 9}, {{0.6, 0.3}, 12}, {{0.4, 0.1}, 24}, {{0.2, 0.0}, 1000}, {{0.1, -0.6}, 1000}};
constexpr int kMostRepeats = 60;

class Coarsener {
 public:
  Coarsener(WorkingMesh& mesh, const SizeField& sizes, const RunContext& context, CoarsenCounts& counts)
      : mesh_(mesh),
        sizes_(sizes),
        context_(context),
        counts_(counts),
        merged_into_(mesh.points.size()),
        blocks_(mesh) {
    left_ = parallel_select(mesh.points.size(), [&](VertexIndex v) {
      const bool is_input = mesh.kind[v] == VertexKind::kRemovable || mesh.kind[v] == VertexKind::kRemovableCurve;
      return is_input && mesh.outgoing[v] != kNone && !mesh.is_sewn(v);
    });
  }

  void run() {
    flip_all(kPasses[0].turn);
    for (const PassLimits& limits : kPasses) {
      for (int i = 0; i < kMostRepeats && !left_.empty(); ++i) {
        const std::size_t before = left_.size();
        pass(limits);
        if (10 * (before - left_.size()) < before) break;
      }
    }
    counts_.input_vertices_left += left_.size();
    adopt_left();
  }

 private:
  /// What could not be collapsed away is a vertex like others from here on.
  void adopt_left() {
    for (const VertexIndex v : left_) {
      const bool on_curve = mesh_.kind[v] == VertexKind::kRemovableCurve;
      mesh_.kind[v] = on_curve ? VertexKind::kCurve : VertexKind::kFree;
    }
    parallel_for(mesh_.points.size(), [&](std::size_t v) {
      if (mesh_.outgoing[v] != kNone && !(mesh_.size[v] > 0)) mesh_.size[v] = sizes_.at(mesh_.points[v]);
    });
  }

  void flip_all(const TurnLimits& limits) {
    const auto is_first = [&](HalfEdge h) { return h < mesh_.twin[h]; };
    counts_.flips += make_delaunay(mesh_, blocks_, parallel_select(mesh_.start.size(), is_first), limits);
  }

  void pass(const PassLimits& limits) {
    blocks_.run(
        left_, [](VertexIndex v) { return v; },
        [&](const SurfaceBlocks::Block& block, std::span<const VertexIndex> of_block, std::vector<VertexIndex>& later) {
          context_.check();
          StarCollapse& star = stars_.local([&] { return StarCollapse(mesh_); });
          for (const VertexIndex v : of_block)
            if (block.has_star(v))
              remove(v, limits, star);
            else
              later.push_back(v);
        });
    counts_.flips += make_delaunay(mesh_, blocks_, edges_of_collapses(), limits.turn);
    const auto removed = std::erase_if(left_, [&](VertexIndex v) { return mesh_.outgoing[v] == kNone; });
    counts_.collapses += removed;
  }

  /// The edges of the triangles around vertices that others have merged into.
  std::vector<HalfEdge> edges_of_collapses() const {
    std::vector<HalfEdge> edges;
    for (const VertexIndex v : left_) {
      if (mesh_.outgoing[v] != kNone || mesh_.outgoing[merged_into_[v]] == kNone) continue;
      mesh_.for_each_outgoing(merged_into_[v], [&](HalfEdge h) {
        edges.push_back(h);
        edges.push_back(next_of(h));
      });
    }
    return edges;
  }

  void remove(VertexIndex v, const PassLimits& limits, StarCollapse& star) {
    star.gather(v);
    const std::vector<HalfEdge>& ring = star.ring();
    double best = 0;
    HalfEdge chosen = kNone;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const HalfEdge h = ring[i];
      if (mesh_.kind[v] == VertexKind::kRemovableCurve && !mesh_.is_feature[h]) continue;
      const double quality = star.quality_after(i, limits.turn, best);
      if (quality > best && fits(ring.size(), h, limits.valence) && mesh_.may_collapse(h)) {
        best = quality;
        chosen = h;
      }
    }
    if (chosen == kNone) return;
    merged_into_[v] = mesh_.end(chosen);
    mesh_.collapse(chosen);
  }

  bool fits(std::size_t valence, HalfEdge h, int most) const {
    return static_cast<int>(valence) + mesh_.valence(mesh_.end(h)) - 4 <= most;
  }

  WorkingMesh& mesh_;
  const SizeField& sizes_;
  const RunContext& context_;
  CoarsenCounts& counts_;
  std::vector<VertexIndex> left_;
  std::vector<VertexIndex> merged_into_;  ///< per vertex that vanished
  SurfaceBlocks blocks_;
  PerThread<StarCollapse> stars_;
};

}  // namespace

void remove_input_vertices(WorkingMesh& mesh, const SizeField& sizes, const RunContext& context,
                           CoarsenCounts& counts) {
  Coarsener(mesh, sizes, context, counts).run();
}

}  // namespace octafront::surface
