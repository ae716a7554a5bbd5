#include "surface/lines/merge_lines.h"

#include "base/geometry/measures.h"
#include "surface/edits/coarsen.h"
#include "surface/edits/line_edits.h"
#include "surface/edits/sweep.h"

#include <algorithm>
#include <vector>

namespace octafront::surface {

namespace {

/// Triangles below this squared quality are bad (needles of 15 degrees, 2r/R of about 0.5).
constexpr double kBadBetweenLines = 0.2;
/// What is narrower than this, in wanted sizes, closes; an apex this near to its line takes it over.
constexpr double kNarrow = 0.25, kFlatApex = 0.2;
/// The worst triangle around must get better by this factor, so that no two operations undo each other.
constexpr double kGainOfMerging = 1.3;
/// Closing one triangle of a strip makes room for the next.
constexpr int kMergeRounds = 20;
constexpr TurnLimits kLineLimits{0.2, -0.3};

class LineMerger {
 public:
  LineMerger(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed, double tolerance, const Leeway& leeway)
      : mesh_(mesh), edits_(mesh, is_fixed), tolerance_(tolerance), leeway_(leeway), star_(mesh) {}

  std::uint64_t run() {
    const auto is_bad = [&](std::uint32_t t) { return !mesh_.is_removed(t) && quality(3 * t) < kBadBetweenLines; };
    std::uint64_t operations = 0;
    const auto mend = [&](std::uint32_t t) {
      const bool done = is_bad(t) && (close(t) || pass_line_on(t));
      operations += done;
      return done;
    };
    sweep(
        mesh_, [&, triangles = mesh_.triangle_count()] { return triangles; }, is_bad,
        [&](std::uint32_t t) {
          return !mesh_.is_removed(t) && std::ranges::any_of(mesh_.triangle(t), [&](VertexIndex v) {
            return mesh_.is_marked(v, WorkingMesh::kForSweep);
          });
        },
        mend);
    for (int round = 1; round < kMergeRounds && !changed_.empty(); ++round) {
      std::sort(changed_.begin(), changed_.end());
      changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
      const std::vector<std::uint32_t> here = std::move(changed_);
      changed_.clear();
      for (const std::uint32_t t : here) mend(t);
    }
    return operations;
  }

 private:
  Vec3 at(VertexIndex v) const { return mesh_.points[v]; }
  double quality(HalfEdge h) const { return squared_quality(at(mesh_.start[h]), at(mesh_.end(h)), at(mesh_.apex(h))); }
  double length_of(HalfEdge h) const { return distance(at(mesh_.start[h]), at(mesh_.end(h))); }
  bool is_small(double length, VertexIndex a, VertexIndex b, double part) const {
    return length <= tolerance_ && length < part * 0.5 * (mesh_.size[a] + mesh_.size[b]);
  }

  bool has_leeway(VertexIndex v, double move) const { return leeway_.at(at(v), move) >= move; }

  /// Collapses the shortest edge of the triangle if it joins two points of lines and is short.
  bool close(std::uint32_t t) {
    const HalfEdge first = 3 * t;
    HalfEdge h = first;
    for (const HalfEdge o : {first + 1, first + 2}) {
      if (length_of(o) < length_of(h)) h = o;
    }
    const VertexIndex u = mesh_.start[h], w = mesh_.end(h);
    if (!mesh_.on_curve(u) || !mesh_.on_curve(w) || !is_small(length_of(h), u, w, kNarrow)) return false;
    // Corners stay where they can.
    const bool backwards = mesh_.kind[u] == VertexKind::kCorner && mesh_.kind[w] != VertexKind::kCorner;
    const HalfEdge preferred = backwards ? mesh_.twin[h] : h;
    return collapse_if_better(preferred) || collapse_if_better(mesh_.twin[preferred]);
  }

  bool collapse_if_better(HalfEdge h) {
    star_.gather(mesh_.start[h]);
    const auto i = std::find(star_.ring().begin(), star_.ring().end(), h) - star_.ring().begin();
    const double least = kGainOfMerging * star_.quality_now();
    if (!(star_.quality_after(static_cast<std::size_t>(i), kLineLimits, least) > least)) return false;
    if (!edits_.may_collapse(h) || !has_leeway(mesh_.start[h], length_of(h))) return false;
    const VertexIndex w = mesh_.end(h);
    edits_.collapse(h);
    note_changed_around(w);
    return true;
  }

  /// Where the triangle is flat on a line, the line runs through its apex from now on.
  bool pass_line_on(std::uint32_t t) {
    const HalfEdge first = 3 * t;
    HalfEdge h = first;
    for (const HalfEdge o : {first + 1, first + 2}) {
      if (length_of(o) > length_of(h)) h = o;
    }
    if (!mesh_.is_feature[h]) return false;
    const HalfEdge g = mesh_.twin[h];
    const VertexIndex a = mesh_.start[h], b = mesh_.start[g], c = mesh_.apex(h), d = mesh_.apex(g);
    const double move = distance(at(c), closest_point_on_segment(at(c), at(a), at(b)));
    if (!is_small(move, a, b, kFlatApex) || !has_leeway(c, move)) return false;
    const double before = std::min(quality(h), quality(g));
    const double after = std::min(squared_quality(at(a), at(d), at(c)), squared_quality(at(b), at(c), at(d)));
    if (!(after > kGainOfMerging * before) || !flip_is_sound(mesh_, h, kLineLimits) || !edits_.may_flip(h))
      return false;
    edits_.flip(h);
    for (const VertexIndex v : {a, b, c, d}) note_changed_around(v);
    return true;
  }

  void note_changed_around(VertexIndex v) {
    mesh_.for_each_outgoing(v, [&](HalfEdge h) { changed_.push_back(h / 3); });
  }

  WorkingMesh& mesh_;
  LineEdits edits_;
  double tolerance_;
  const Leeway& leeway_;
  StarCollapse star_;
  std::vector<std::uint32_t> changed_;  ///< triangles to look at in the next round
};

}  // namespace

std::uint64_t merge_lines(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed, double tolerance,
                          const Leeway& leeway) {
  return LineMerger(mesh, is_fixed, tolerance, leeway).run();
}

}  // namespace octafront::surface
