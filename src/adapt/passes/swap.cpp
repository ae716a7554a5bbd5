// Other connections between the same vertices: an edge goes, its ring is triangulated anew (RingFilling) for the least
// sum of what its elements lack, or a face goes (2-3 flip). An edge inside a wall turns to the other diagonal of its
// two triangles.

#include "adapt/passes/metric_passes.h"
#include "adapt/passes/worth.h"
#include "base/mesh/ring_filling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octafront::adapt {
namespace {

/// A swap must gain at least this in the sum of what elements lack, so that equal fillings do not replace each other
/// for ever.
constexpr float kLeastGainOfSwap = 0.01f;
/// It makes no element of a lower score than this, or than the poorest one that it takes away.
constexpr float kGuardOfSwap = 0.5f;
constexpr std::size_t kLongestRingOfSwap = 7, kLongestRingOfMending = 10;
/// Swaps make no edge longer than this, unless they take a longer one away.
constexpr double kLongestOfSwap = kLongest;
constexpr int kCheckSwapEvery = 512;
constexpr float kImpossible = HUGE_VALF;

class Swapper {
 public:
  Swapper(Piece& piece, const Guide& guide, bool mends) : piece_(piece), guide_(guide), mends_(mends) {}

  PassCount run(float threshold) {
    PassCount count;
    std::vector<TetIndex> queue;
    for (TetIndex t = 0; t < piece_.complex.slots(); ++t)
      if (piece_.complex.alive(t) && (mends_ ? is_to_mend(piece_, t) : piece_.is_active(t))) queue.push_back(t);
    for (std::size_t k = 0; k < queue.size(); ++k) {
      if (++steps_ % kCheckSwapEvery == 0) guide_.context.check();
      const TetIndex t = queue[k];
      if (!piece_.complex.alive(t) || value_of(t) >= threshold) continue;
      ++count.tried;
      if (!improve(t)) continue;
      ++count.done;
      for (const TetIndex made : piece_.created())
        if (value_of(made) < threshold) queue.push_back(made);
    }
    return count;
  }

 private:
  /// What is to become better: the score, or what is mended.
  float value_of(TetIndex t) const { return mends_ ? worth_of(piece_, piece_.tet(t)) : piece_.score[t]; }
  float value_of(const Tet& c) const { return mends_ ? worth_of(piece_, c) : piece_.score_of(c); }
  double longest_beside(VertexIndex a, VertexIndex b) const {
    if (mends_) return HUGE_VAL;
    return piece_.is_longer(a, b, kLongestOfSwap) ? piece_.edge_length(a, b) : kLongestOfSwap;
  }

  bool improve(TetIndex t) {
    gain_ = kLeastGainOfSwap;
    old_.clear();
    const Tet c = piece_.tet(t);
    const unsigned closed = closed_faces(t);
    for (const auto& [i, j] : kTetEdges)
      if ((closed & ~(1u << i | 1u << j)) == 0) try_edge(t, c[i], c[j]);
    for (int i = 0; i < 4; ++i) try_face(t, i);
    if (old_.empty()) return false;
    piece_.replace(old_, fresh_, walls_);
    return true;
  }

  /// A bit for each face of t that no ring it asks for goes through: what lies behind is beyond the rim, or poorer.
  unsigned closed_faces(TetIndex t) const {
    unsigned faces = 0;
    for (HalfFace i = 0; i < 4 && !mends_; ++i) {
      const HalfFace o = piece_.complex.across[4 * t + i];
      if (o == kBeyondRim || (!is_outside(o) && piece_.score[o / 4] < piece_.score[t])) faces |= 1u << i;
    }
    return faces;
  }

  bool are_frozen(VertexIndex a, VertexIndex b) const { return piece_.vertices[a].frozen && piece_.vertices[b].frozen; }

  void try_edge(TetIndex t, VertexIndex a, VertexIndex b) {
    if (are_frozen(a, b) || piece_.line(a, b)) return;
    // The poorest tet of a ring is the one that asks for all.
    if (!piece_.ring(t, a, b, ring_, mends_ ? 0 : piece_.score[t])) return;
    if (ring_.tets.size() > (mends_ ? kLongestRingOfMending : kLongestRingOfSwap)) return;
    had_ = 0;
    for (const TetIndex r : ring_.tets) had_ += lack_of(value_of(r));
    if (!(had_ > gain_)) return;
    guard_ = std::min(value_of(t), kGuardOfSwap);
    piece_.walls_of(a, b, ring_, walls_at_);
    if (walls_at_.empty() && ring_.closed) return fill_ring(t, a, b);
    if (walls_at_.size() == 2) turn_in_wall(a, b);
  }

  void fill_ring(TetIndex t, VertexIndex a, VertexIndex b) {
    if (ring_.ring.size() < 3) return;
    poly_.assign(ring_.ring.begin(), ring_.ring.end());
    if (!may_fill(a, b)) return;
    const float lack = triangulate(a, b, longest_beside(a, b), had_ - gain_);
    if (!(lack < had_ - gain_)) return;
    take_old(lack);
    emit(a, b, piece_.region[t]);
  }

  /// Whether some triangle on the outer edge of the tet that asks, one of which is in each filling, will do by itself.
  bool may_fill(VertexIndex a, VertexIndex b) {
    const VertexIndex p = poly_[0], q = poly_[1];
    most_ = had_ - gain_;
    return std::any_of(poly_.begin() + 2, poly_.end(), [&](VertexIndex r) {
      float sum = 0;
      return add_lack(sum, {a, p, q, r}) && add_lack(sum, {b, p, r, q});
    });
  }

  /// The edge inside a wall goes: on each side of the wall the ring is triangulated for itself, with the new diagonal
  /// as an edge.
  void turn_in_wall(VertexIndex a, VertexIndex b) {
    const auto& [i, p, label] = walls_at_[0];
    const auto& [j, q, other] = walls_at_[1];
    const std::size_t n = ring_.ring.size();
    if (guide_.keeps(label) || are_frozen(p, q) || (piece_.vertices[p].rim && piece_.vertices[q].rim)) return;
    const bool outer = !ring_.closed;
    if (outer != ((label & kOuter) != 0) || (outer && (i != 0 || j + 1 != n))) return;
    if (other != label || (outer && ring_.tets.size() < 2)) return;
    if (piece_.tet_with(piece_.vertices[p].rim ? q : p, piece_.vertices[p].rim ? p : q, kNone) != kNone) return;
    const double longest = longest_beside(a, b);
    if (piece_.is_longer(p, q, longest)) return;
    if (!wall_stays_true(a, b, p, q, label)) return;
    // Polygons on the two sides: from p on to q, and from q on to p.
    std::vector<Piece::NewTet> made;
    float lack = 0;
    for (int side = 0; side < (outer ? 1 : 2); ++side) {
      poly_.clear();
      const std::size_t from = side == 0 ? i : j, to = side == 0 ? j : i;
      for (std::size_t k = from;; k = (k + 1) % n) {
        poly_.push_back(ring_.ring[k]);
        if (k == to) break;
      }
      if (poly_.size() < 3) return;
      lack += triangulate(a, b, longest, had_ - gain_ - lack);
      if (!(lack < had_ - gain_)) return;
      std::swap(fresh_, made);
      emit(a, b, piece_.region[ring_.tets[from]]);
      std::swap(fresh_, made);
    }
    take_old(lack);
    fresh_ = std::move(made);
    walls_.push_back({{a, p, q}, label}), walls_.push_back({{b, p, q}, label});
  }

  bool wall_stays_true(VertexIndex a, VertexIndex b, VertexIndex p, VertexIndex q, Wall label) const {
    const auto corners = [&](VertexIndex u, VertexIndex v, VertexIndex w) {
      return TriangleCorners{piece_.point(u), piece_.point(v), piece_.point(w)};
    };
    // Outward: behind the first wall of the ring, (a, b, p).
    const std::array before{corners(b, a, p), corners(a, b, q)}, after{corners(a, p, q), corners(b, q, p)};
    return keeps_walls_true(guide_, before, after, label, piece_.vertices[p].near);
  }

  /// What an element lacks to be regular.
  float lack_of(float score) const {
    if (mends_) return 1 / (score * score * score);  // the worst one counts
    const float lack = 1 / score - 1;
    return lack * (1 + 0.5f * lack);
  }

  void take_old(float lack) {
    gain_ = had_ - lack;
    old_.assign(ring_.tets.begin(), ring_.tets.end());
    fresh_.clear(), walls_.clear();
  }

  /// The least that triangles of the polygon, each with a and b, lack together, if that is below `most`.
  float triangulate(VertexIndex a, VertexIndex b, double longest, float most) {
    return -filling_.best(
        static_cast<int>(poly_.size()), 0, -kImpossible,
        [&](int i, int k, int j, float low, float high, float best) {
          float sum = -(low + high);
          most_ = std::min(-best, most);
          const bool is_less = sum < most_ && add_lack(sum, {a, poly_[i], poly_[k], poly_[j]}) &&
                               add_lack(sum, {b, poly_[i], poly_[j], poly_[k]});
          return is_less ? -sum : -kImpossible;
        },
        [&](int i, int j) {
          return !are_frozen(poly_[i], poly_[j]) && !piece_.is_longer(poly_[i], poly_[j], longest);
        });
  }

  /// False if the tet must not be, or the sum is too large.
  bool add_lack(float& sum, const Tet& c) const {
    const float s = value_of(c);
    if (!(s > 0) || s < guard_) return false;
    sum += lack_of(s);
    return sum < most_;
  }

  void emit(VertexIndex a, VertexIndex b, std::uint32_t region) {
    filling_.for_each(static_cast<int>(poly_.size()), [&](int i, int k, int j) {
      for (const Tet& c : {Tet{a, poly_[i], poly_[k], poly_[j]}, Tet{b, poly_[i], poly_[j], poly_[k]}})
        fresh_.push_back({c, region, piece_.score_of(c)});
    });
  }

  void try_face(TetIndex t, int i) {
    const HalfFace h = 4 * t + static_cast<HalfFace>(i), o = piece_.complex.across[h];
    if (is_outside(o) || piece_.wall[h] != 0) return;
    const VertexIndex u = piece_.complex.apex(h), w = piece_.complex.apex(o);
    const Triangle f = piece_.complex.face(h);
    if (are_frozen(u, w) || (are_frozen(f[0], f[1]) && are_frozen(f[1], f[2]))) return;
    const float poorest = value_of(t), other = value_of(o / 4);
    if (other < poorest) return;  // it asks itself
    if (!mends_ && piece_.is_longer(u, w, kLongestOfSwap)) return;
    const float had = lack_of(poorest) + lack_of(other), guard = std::min(poorest, kGuardOfSwap);
    float lack = 0;
    std::array<Piece::NewTet, 3> made;
    for (int k = 0; k < 3; ++k) {
      // The face runs counter-clockwise seen from w: a ring around (u, w).
      const Tet c{u, w, f[k], f[(k + 1) % 3]};
      const float s = value_of(c);
      if (!(s > 0) || s < guard) return;
      lack += lack_of(s);
      if (!(lack < had - gain_)) return;
      made[static_cast<std::size_t>(k)] = {c, piece_.region[t], mends_ ? piece_.score_of(c) : s};
    }
    gain_ = had - lack;
    old_ = {t, o / 4};
    fresh_.assign(made.begin(), made.end());
    walls_.clear();
  }

  Piece& piece_;
  const Guide& guide_;
  bool mends_;
  EdgeRing ring_;
  std::vector<Piece::WallAt> walls_at_;
  std::vector<VertexIndex> poly_;
  RingFilling<kLongestRingOfMending + 2> filling_;
  float gain_ = 0, had_ = 0, guard_ = 0, most_ = 0;
  std::vector<TetIndex> old_;
  std::vector<Piece::NewTet> fresh_;
  std::vector<Piece::NewWall> walls_;
  int steps_ = 0;
};

}  // namespace

PassCount swap_edges(Piece& piece, const Guide& guide, float threshold) {
  return Swapper(piece, guide, false).run(threshold);
}

PassCount swap_poor(Piece& piece, const Guide& guide) {
  return Swapper(piece, guide, true).run(1);
}

}  // namespace octafront::adapt
