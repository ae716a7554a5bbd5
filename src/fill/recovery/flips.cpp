#include "fill/recovery/flips.h"

#include "fill/recovery/segment_walk.h"

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
  const HalfFace o = mesh_.across[h];
  if (is_outside(o) || mesh_.label(h) != kNone) return false;
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
  fresh.push_back({ring_.ring[i], ring_.ring[k], ring_.ring[j], q});
  fresh.push_back({ring_.ring[i], ring_.ring[j], ring_.ring[k], p});
  collect_triangles(i, k, fresh, p, q);
  collect_triangles(k, j, fresh, p, q);
}

bool Flipper::remove_edge(const EdgeOfTet& edge, const Hindrance& hindrance, double limit, VertexIndex ear) {
  const auto [t, p, q] = edge;
  if (kept_.contains(p, q) || !mesh_.closed_ring(t, p, q, ring_, kMaxRing)) return false;
  const std::size_t n = ring_.ring.size();
  double before = hindrance.of_edge(p, q);
  for (const VertexIndex r : ring_.ring) before += hindrance.of_face(p, q, r);
  constexpr double kImpossible = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < n; ++i) best_[i][i + 1] = 0;
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      best_[i][j] = kImpossible;
      double diagonal = 0;
      if (span + 1 < n) {
        if (ring_.ring[i] == ear || ring_.ring[j] == ear) continue;
        diagonal = hindrance.of_edge(ring_.ring[i], ring_.ring[j]) +
                   hindrance.of_face(ring_.ring[i], ring_.ring[j], p) +
                   hindrance.of_face(ring_.ring[i], ring_.ring[j], q);
      }
      for (std::size_t k = i + 1; k < j; ++k) {
        const double parts = best_[i][k] + best_[k][j] + diagonal;
        if (parts >= best_[i][j] || parts - before > limit) continue;
        if (points_.orient(ring_.ring[i], ring_.ring[k], ring_.ring[j], q) <= 0) continue;
        if (points_.orient(ring_.ring[i], ring_.ring[k], ring_.ring[j], p) >= 0) continue;
        const double sum = parts + hindrance.of_face(ring_.ring[i], ring_.ring[k], ring_.ring[j]);
        if (sum >= best_[i][j]) continue;
        best_[i][j] = sum;
        middle_[i][j] = k;
      }
    }
  }
  if (best_[0][n - 1] - before > limit || best_[0][n - 1] == kImpossible) return false;
  fresh_.clear();
  collect_triangles(0, n - 1, fresh_, p, q);
  mesh_.replace(ring_.tets, fresh_);
  return true;
}

TetIndex Flipper::find_tet(TetIndex guess, VertexIndex p, VertexIndex q) {
  if (mesh_.alive(guess) && mesh_.has(guess, p) && mesh_.has(guess, q)) return guess;
  return tet_with_edge(points_, mesh_, p, q);
}

// Takes one vertex out of the ring around (p, q).
bool Flipper::shrink_ring(const EdgeOfTet& edge, const Hindrance& hindrance, VertexIndex ear, int depth) {
  const auto [t, p, q] = edge;
  constexpr std::size_t kMaxTried = 40;
  EdgeRing ring;
  if (!mesh_.closed_ring(t, p, q, ring, kMaxTried)) return false;
  const std::vector<TetIndex>& tets = ring.tets;
  const std::vector<VertexIndex>& link = ring.ring;
  const std::size_t n = link.size();
  for (std::size_t i = 0; i < n && n > 3; ++i) {
    if (link[i] == ear) continue;
    const VertexIndex next = link[(i + 1) % n];
    if (flip_face(mesh_.opposite(tets[i], next), hindrance, 0)) return true;
  }
  for (std::size_t i = 0; i < n && n > 3 && depth > 0; ++i) {
    if (link[i] == ear) continue;
    for (const auto& [end, other] : {Edge{p, q}, Edge{q, p}}) {
      const TetIndex u = find_tet(tets[i], end, link[i]);
      if (u == kNone) return false;
      if (remove_with_budget({u, end, link[i]}, hindrance, 0, other, depth - 1)) return true;
      // A failed attempt may have changed the ring: then it is searched anew.
      if (!mesh_.alive(tets[i]) || !mesh_.has(tets[i], p) || !mesh_.has(tets[i], q)) return true;
    }
  }
  return false;
}

bool Flipper::remove_with_budget(EdgeOfTet edge, const Hindrance& hindrance, double limit, VertexIndex ear, int depth) {
  while (!kept_.contains(edge.p, edge.q) && budget_-- > 0) {
    if (remove_edge(edge, hindrance, limit, ear)) return true;
    if (!shrink_ring(edge, hindrance, ear, depth)) return false;
    edge.tet = find_tet(edge.tet, edge.p, edge.q);
    if (edge.tet == kNone) return true;
  }
  return false;
}

bool Flipper::remove_edge_deep(const EdgeOfTet& edge, const Hindrance& hindrance, double limit, int depth) {
  constexpr int kAttempts = 40;
  budget_ = kAttempts;
  return remove_with_budget(edge, hindrance, limit, kNone, depth);
}

}  // namespace octafront::recovery
