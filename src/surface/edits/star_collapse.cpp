#include "surface/edits/star_collapse.h"

#include <algorithm>

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

}  // namespace octafront::surface
