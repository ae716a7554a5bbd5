#include "surface/coarsen.h"

#include "surface/local_guards.h"

#include <algorithm>

namespace octafront::remeshing {

namespace {

/// One pass over what is left: how far triangles may turn, and how many triangles may meet at a vertex.
struct PassLimits {
  TurnLimits turn;
  int valence;
};

/// Strict while there is much to choose from, loose for the last few. A pass is repeated while it removes a tenth.
constexpr PassLimits kPasses[] = {{{0.8, 0.5}, 9}, {{0.6, 0.3}, 12}, {{0.4, 0.1}, 24}, {{0.2, 0.0}, 1000}};
constexpr int kMostRepeats = 60;

class Coarsener {
 public:
  Coarsener(WorkingMesh& mesh, const RunContext& context, CoarsenCounts& counts)
      : mesh_(mesh), context_(context), counts_(counts) {
    for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
      const bool is_input = mesh.kind[v] == VertexKind::kRemovable || mesh.kind[v] == VertexKind::kRemovableCurve;
      if (is_input && mesh.outgoing[v] != kNone) left_.push_back(v);
    }
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
  }

 private:
  void flip_all(const TurnLimits& limits) {
    edges_.clear();
    for (HalfedgeIndex h = 0; h < mesh_.start.size(); ++h) {
      if (h < mesh_.twin[h]) edges_.push_back(h);
    }
    counts_.flips += make_delaunay(mesh_, edges_, limits);
  }

  void pass(const PassLimits& limits) {
    edges_.clear();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (i % 1024 == 0) context_.check();
      if (!remove(left_[i], limits)) left_[kept++] = left_[i];
    }
    left_.resize(kept);
    std::erase_if(edges_, [&](HalfedgeIndex h) { return mesh_.start[h] == kNone; });
    counts_.flips += make_delaunay(mesh_, edges_, limits.turn);
  }

  bool remove(VertexIndex v, const PassLimits& limits) {
    gather_stars(v);
    double best = 0;
    HalfedgeIndex chosen = kNone;
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const HalfedgeIndex h = ring_[i];
      if (mesh_.kind[v] == VertexKind::kRemovableCurve && !mesh_.is_feature[h]) continue;
      const double quality = quality_after(i, limits.turn, best);
      if (quality > best && fits(h, limits.valence) && mesh_.may_collapse(h)) {
        best = quality;
        chosen = h;
      }
    }
    if (chosen == kNone) return false;
    const VertexIndex target = mesh_.end(chosen);
    mesh_.collapse(chosen);
    ++counts_.collapses;
    mesh_.for_each_outgoing(target, [&](HalfedgeIndex h) {
      edges_.push_back(h);
      edges_.push_back(next_of(h));
    });
    return true;
  }

  bool fits(HalfedgeIndex h, int most) const {
    return static_cast<int>(ring_.size()) + mesh_.valence(mesh_.end(h)) - 4 <= most;
  }

  /// The outgoing half-edges of v, and for each triangle the area vector of the star between features that it is in.
  void gather_stars(VertexIndex v) {
    ring_.clear();
    mesh_.for_each_outgoing(v, [&](HalfedgeIndex h) { ring_.push_back(h); });
    if (mesh_.on_curve(v)) {
      const auto first = std::find_if(ring_.begin(), ring_.end(), [&](HalfedgeIndex h) { return mesh_.is_feature[h]; });
      std::rotate(ring_.begin(), first, ring_.end());
    }
    stars_.assign(ring_.size(), Vec3{});
    for (std::size_t i = 0; i < ring_.size();) {
      std::size_t j = i;
      Vec3 sum;
      do sum += mesh_.area_vector(ring_[j++] / 3);
      while (j < ring_.size() && !mesh_.is_feature[ring_[j]]);
      for (; i < j; ++i) stars_[i] = sum;
    }
  }

  /// Least quality of the triangles that the vertex's become when it moves along ring_[towards]; 0 if one would turn
  /// too far, or none would be better than `least`.
  double quality_after(std::size_t towards, const TurnLimits& limits, double least) const {
    const VertexIndex w = mesh_.end(ring_[towards]);
    const Vec3 pw = mesh_.points[w];
    double worst = 1;
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const VertexIndex p = mesh_.end(ring_[i]), q = mesh_.apex(ring_[i]);
      if (p == w || q == w) continue;
      const Vec3 pp = mesh_.points[p], pq = mesh_.points[q];
      const Vec3 area_vector = cross(pp - pw, pq - pw);
      worst = std::min(worst, squared_quality(pw, pp, pq));
      if (!(worst > least)) return 0;
      if (!turns_little(area_vector, stars_[i], limits.star)) return 0;
      if (!faces_outward(mesh_, area_vector, {w, p, q}, limits.surface)) return 0;
    }
    return worst;
  }

  WorkingMesh& mesh_;
  const RunContext& context_;
  CoarsenCounts& counts_;
  std::vector<VertexIndex> left_;
  std::vector<HalfedgeIndex> edges_, ring_;
  std::vector<Vec3> stars_;
};

}  // namespace

void remove_input_vertices(WorkingMesh& mesh, const RunContext& context, CoarsenCounts& counts) {
  Coarsener(mesh, context, counts).run();
}

}  // namespace octafront::remeshing
