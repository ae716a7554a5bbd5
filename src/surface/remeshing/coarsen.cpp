#include "surface/remeshing/coarsen.h"

#include "surface/remeshing/star_collapse.h"

#include <algorithm>

namespace octafront::remeshing {

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
      : mesh_(mesh), sizes_(sizes), context_(context), counts_(counts), star_(mesh) {
    for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
      const bool is_input = mesh.kind[v] == VertexKind::kRemovable || mesh.kind[v] == VertexKind::kRemovableCurve;
      if (is_input && mesh.outgoing[v] != kNone && !mesh.is_sewn(v)) left_.push_back(v);
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
    adopt_left();
  }

 private:
  /// What could not be collapsed away is a vertex like others from here on.
  void adopt_left() {
    for (const VertexIndex v : left_) {
      const bool on_curve = mesh_.kind[v] == VertexKind::kRemovableCurve;
      mesh_.kind[v] = on_curve ? VertexKind::kCurve : VertexKind::kFree;
    }
    for (VertexIndex v = 0; v < mesh_.points.size(); ++v) {
      if (mesh_.outgoing[v] != kNone && !(mesh_.size[v] > 0)) mesh_.size[v] = sizes_.at(mesh_.points[v]);
    }
  }

  void flip_all(const TurnLimits& limits) {
    edges_.clear();
    for (HalfEdge h = 0; h < mesh_.start.size(); ++h) {
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
    std::erase_if(edges_, [&](HalfEdge h) { return mesh_.start[h] == kNone; });
    counts_.flips += make_delaunay(mesh_, edges_, limits.turn);
  }

  bool remove(VertexIndex v, const PassLimits& limits) {
    star_.gather(v);
    const std::vector<HalfEdge>& ring = star_.ring();
    double best = 0;
    HalfEdge chosen = kNone;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const HalfEdge h = ring[i];
      if (mesh_.kind[v] == VertexKind::kRemovableCurve && !mesh_.is_feature[h]) continue;
      const double quality = star_.quality_after(i, limits.turn, best);
      if (quality > best && fits(h, limits.valence) && mesh_.may_collapse(h)) {
        best = quality;
        chosen = h;
      }
    }
    if (chosen == kNone) return false;
    const VertexIndex target = mesh_.end(chosen);
    mesh_.collapse(chosen);
    ++counts_.collapses;
    mesh_.for_each_outgoing(target, [&](HalfEdge h) {
      edges_.push_back(h);
      edges_.push_back(next_of(h));
    });
    return true;
  }

  bool fits(HalfEdge h, int most) const {
    return static_cast<int>(star_.ring().size()) + mesh_.valence(mesh_.end(h)) - 4 <= most;
  }

  WorkingMesh& mesh_;
  const SizeField& sizes_;
  const RunContext& context_;
  CoarsenCounts& counts_;
  std::vector<VertexIndex> left_;
  std::vector<HalfEdge> edges_;
  StarCollapse star_;
};

}  // namespace

void remove_input_vertices(WorkingMesh& mesh, const SizeField& sizes, const RunContext& context,
                           CoarsenCounts& counts) {
  Coarsener(mesh, sizes, context, counts).run();
}

}  // namespace octafront::remeshing
