#include "recovery/flips.h"

#include "recovery/segment_walk.h"

#include <algorithm>
#include <limits>

namespace octafront::recovery {

double SegmentHindrance::of_face(VertexIndex x, VertexIndex y, VertexIndex z) const {
  for (const VertexIndex v : {x, y, z}) {
    if (v == a_ || v == b_) return 0;
  }
  const int s = points_.orient(a_, b_, x, y);
  if (s == 0 || points_.orient(a_, b_, y, z) != s || points_.orient(a_, b_, z, x) != s) return 0;
  return points_.orient(x, y, z, a_) * points_.orient(x, y, z, b_) < 0 ? 1 : 0;
}

double SegmentHindrance::of_edge(VertexIndex x, VertexIndex y) const {
  if (x == a_ || x == b_ || y == a_ || y == b_) return 0;
  if (points_.orient(a_, b_, x, y) != 0) return 0;
  for (VertexIndex o = off_plane_; o < off_plane_ + 4; ++o) {
    const int sx = points_.orient(a_, b_, o, x);
    if (sx == 0) continue;
    return points_.orient(a_, b_, o, y) == -sx && points_.orient(x, y, o, a_) * points_.orient(x, y, o, b_) < 0 ? 3 : 0;
  }
  return 0;
}

double FacetHindrance::of_edge(VertexIndex x, VertexIndex y) const {
  for (const VertexIndex v : f_) {
    if (v == x || v == y) return 0;
  }
  if (points_.orient(f_[0], f_[1], f_[2], x) * points_.orient(f_[0], f_[1], f_[2], y) >= 0) return 0;
  const int s = points_.orient(x, y, f_[0], f_[1]);
  return s != 0 && points_.orient(x, y, f_[1], f_[2]) == s && points_.orient(x, y, f_[2], f_[0]) == s ? 1 : 0;
}

bool Flipper::flip_face(HalfFace h, const Hindrance& hindrance, double limit) {
  const HalfFace o = mesh_.opposite(h);
  if (o == kNone || mesh_.label[h / 4][h % 4] != kNone) return false;
  const Triangle f = mesh_.face(h);
  const VertexIndex d = mesh_.apex(h), e = mesh_.apex(o);
  for (int i = 0; i < 3; ++i) {
    if (points_.orient(d, e, f[i], f[(i + 1) % 3]) <= 0) return false;
  }
  double change = hindrance.of_edge(d, e) - hindrance.of_face(f[0], f[1], f[2]);
  for (const VertexIndex v : f) change += hindrance.of_face(d, e, v);
  if (change > limit) return false;
  const std::array<TetIndex, 2> old{h / 4, o / 4};
  const std::array<Tet, 3> fresh{Tet{d, e, f[0], f[1]}, Tet{d, e, f[1], f[2]}, Tet{d, e, f[2], f[0]}};
  mesh_.replace(old, fresh);
  return true;
}

void Flipper::collect_triangles(std::size_t i, std::size_t j, std::vector<Tet>& fresh, VertexIndex p,
                                VertexIndex q) const {
  if (j - i < 2) return;
  const std::size_t k = middle_[i][j];
  fresh.push_back({link_[i], link_[k], link_[j], q});
  fresh.push_back({link_[i], link_[j], link_[k], p});
  collect_triangles(i, k, fresh, p, q);
  collect_triangles(k, j, fresh, p, q);
}

bool Flipper::remove_edge(TetIndex t, VertexIndex p, VertexIndex q, const Hindrance& hindrance, double limit,
                          VertexIndex ear) {
  if (kept_.contains(p, q) || !mesh_.ring(p, q, t, kMaxRing, tets_, link_)) return false;
  const std::size_t n = link_.size();
  double before = hindrance.of_edge(p, q);
  for (const VertexIndex r : link_) before += hindrance.of_face(p, q, r);
  constexpr double kImpossible = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < n; ++i) best_[i][i + 1] = 0;
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      best_[i][j] = kImpossible;
      double diagonal = 0;
      if (span + 1 < n) {
        if (link_[i] == ear || link_[j] == ear) continue;
        diagonal = hindrance.of_edge(link_[i], link_[j]) + hindrance.of_face(link_[i], link_[j], p) +
                   hindrance.of_face(link_[i], link_[j], q);
      }
      for (std::size_t k = i + 1; k < j; ++k) {
        const double parts = best_[i][k] + best_[k][j] + diagonal;
        if (parts >= best_[i][j] || parts - before > limit) continue;
        if (points_.orient(link_[i], link_[k], link_[j], q) <= 0) continue;
        if (points_.orient(link_[i], link_[k], link_[j], p) >= 0) continue;
        const double sum = parts + hindrance.of_face(link_[i], link_[k], link_[j]);
        if (sum >= best_[i][j]) continue;
        best_[i][j] = sum;
        middle_[i][j] = k;
      }
    }
  }
  if (best_[0][n - 1] - before > limit || best_[0][n - 1] == kImpossible) return false;
  fresh_.clear();
  collect_triangles(0, n - 1, fresh_, p, q);
  mesh_.replace(tets_, fresh_);
  return true;
}

TetIndex Flipper::find_tet(TetIndex guess, VertexIndex p, VertexIndex q) {
  if (mesh_.alive(guess) && mesh_.has(guess, p) && mesh_.has(guess, q)) return guess;
  return tet_with_edge(points_, mesh_, p, q);
}

// Takes one vertex out of the ring around (p, q).
bool Flipper::shrink_ring(TetIndex t, VertexIndex p, VertexIndex q, const Hindrance& hindrance, VertexIndex ear,
                          int depth) {
  constexpr std::size_t kMaxTried = 40;
  std::vector<TetIndex> tets;
  std::vector<VertexIndex> link;
  if (!mesh_.ring(p, q, t, kMaxTried, tets, link)) return false;
  const std::size_t n = link.size();
  for (std::size_t i = 0; i < n && n > 3; ++i) {
    if (link[i] == ear) continue;
    const VertexIndex next = link[(i + 1) % n];
    if (flip_face(4 * tets[i] + static_cast<HalfFace>(mesh_.corner_of(tets[i], next)), hindrance, 0)) return true;
  }
  for (std::size_t i = 0; i < n && n > 3 && depth > 0; ++i) {
    if (link[i] == ear) continue;
    for (const auto& [end, other] : {Edge{p, q}, Edge{q, p}}) {
      const TetIndex u = find_tet(tets[i], end, link[i]);
      if (u == kNone) return false;
      if (remove_with_budget(u, end, link[i], hindrance, 0, other, depth - 1)) return true;
      // A failed attempt may have changed the ring: then it is searched anew.
      if (!mesh_.alive(tets[i]) || !mesh_.has(tets[i], p) || !mesh_.has(tets[i], q)) return true;
    }
  }
  return false;
}

bool Flipper::remove_with_budget(TetIndex t, VertexIndex p, VertexIndex q, const Hindrance& hindrance, double limit,
                                 VertexIndex ear, int depth) {
  while (!kept_.contains(p, q) && budget_-- > 0) {
    if (remove_edge(t, p, q, hindrance, limit, ear)) return true;
    if (!shrink_ring(t, p, q, hindrance, ear, depth)) return false;
    t = find_tet(t, p, q);
    if (t == kNone) return true;
  }
  return false;
}

bool Flipper::remove_edge_deep(TetIndex t, VertexIndex p, VertexIndex q, const Hindrance& hindrance, double limit,
                               int depth) {
  constexpr int kAttempts = 40;
  budget_ = kAttempts;
  return remove_with_budget(t, p, q, hindrance, limit, kNone, depth);
}

}  // namespace octafront::recovery
