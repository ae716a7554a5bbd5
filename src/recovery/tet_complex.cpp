#include "recovery/tet_complex.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace octafront::recovery {

namespace {

Triangle sorted(Triangle t) {
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  if (t[1] > t[2]) std::swap(t[1], t[2]);
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  return t;
}

constexpr std::array<HalfFace, 4> kNoNeighbours{kNone, kNone, kNone, kNone};

}  // namespace

TetIndex TetComplex::create(const Tet& corners) {
  TetIndex t = 0;
  if (free_.empty()) {
    t = slots();
    corner.push_back(corners);
    across.push_back(kNoNeighbours);
    label.push_back(kNoNeighbours);
    mark_.push_back(0);
  } else {
    t = free_.back();
    free_.pop_back();
    corner[t] = corners;
    across[t] = label[t] = kNoNeighbours;
  }
  for (const VertexIndex v : corners) tet_at[v] = t;
  return t;
}

void TetComplex::destroy(TetIndex t) {
  corner[t][0] = kNone;
  free_.push_back(t);
}

void TetComplex::set_label(HalfFace h, std::uint32_t value) {
  label[h / 4][h % 4] = value;
  if (const HalfFace o = opposite(h); o != kNone) label[o / 4][o % 4] = value;
}

std::uint32_t TetComplex::new_mark() {
  if (++last_mark_ == 0) {
    std::ranges::fill(mark_, 0);
    last_mark_ = 1;
  }
  return last_mark_;
}

TetComplex::RimFace& TetComplex::rim_slot(Triangle key) {
  const std::size_t mask = rim_.size() - 1;
  std::size_t i = (key[0] * 0x9E3779B1u ^ key[1] * 0x85EBCA6Bu ^ key[2] * 0xC2B2AE35u);
  i ^= i >> 15;
  for (i &= mask;; i = (i + 1) & mask) {
    RimFace& f = rim_[i];
    if (f.key[0] == kNone) f.key = key;
    if (f.key == key) return f;
  }
}

void TetComplex::clear_rim(std::size_t faces) {
  const std::size_t size = std::max<std::size_t>(64, std::bit_ceil(2 * faces));
  rim_.assign(size, RimFace{{kNone, kNone, kNone}, kNone, kNone, false});
}

void TetComplex::replace(std::span<const TetIndex> old, std::span<const Tet> fresh, VertexIndex gone,
                         std::span<const LabelledFace> boundary) {
  const std::uint32_t inside = new_mark();
  for (const TetIndex t : old) mark_[t] = inside;
  clear_rim(4 * (old.size() + fresh.size()) + boundary.size());
  std::size_t open = 0;
  const auto expect = [&](const Triangle& f, HalfFace half, std::uint32_t face_label) {
    RimFace& slot = rim_slot(sorted(f));
    slot.half = half;
    slot.label = face_label;
    slot.open = true;
    ++open;
  };
  for (const TetIndex t : old) {
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      const HalfFace o = opposite(h);
      if (o != kNone && mark_[o / 4] == inside) continue;
      const Triangle f = face(h);
      if (o == kNone && (f[0] == gone || f[1] == gone || f[2] == gone)) continue;
      expect(f, o, label[t][h % 4]);
    }
  }
  for (const LabelledFace& f : boundary) expect(f.corners, kNone, f.label);
  for (const TetIndex t : old) destroy(t);
  created_.clear();
  for (const Tet& c : fresh) {
    const TetIndex t = create(c);
    created_.push_back(t);
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      RimFace& slot = rim_slot(sorted(face(h)));
      if (slot.open) {
        slot.open = false;
        --open;
        if (slot.half != kNone) glue(h, slot.half);
        label[t][h % 4] = slot.label;
      } else {
        slot.half = h;
        slot.open = true;
        ++open;
      }
    }
  }
  if (open != 0) throw std::logic_error("tetrahedra that replace others do not fill the same space");
}

const std::vector<TetIndex>& TetComplex::star_from(VertexIndex v, TetIndex start) {
  const std::uint32_t seen = new_mark();
  star_.assign(1, start);
  mark_[start] = seen;
  for (std::size_t k = 0; k < star_.size(); ++k) {
    const TetIndex t = star_[k];
    const int at = corner_of(t, v);
    for (int i = 0; i < 4; ++i) {
      const HalfFace o = across[t][i];
      if (i == at || o == kNone || mark_[o / 4] == seen) continue;
      mark_[o / 4] = seen;
      star_.push_back(o / 4);
    }
  }
  return star_;
}

bool TetComplex::ring(VertexIndex p, VertexIndex q, TetIndex start, std::size_t limit, std::vector<TetIndex>& tets,
                      std::vector<VertexIndex>& link) const {
  tets.clear();
  link.clear();
  const int i = corner_of(start, p), j = corner_of(start, q);
  // The other two corners in the order that makes (p, q, a, b) positive: an even permutation of (0, 1, 2, 3).
  int k = 0;
  while (k == i || k == j) ++k;
  int l = 6 - i - j - k;
  const int inversions = (i > j) + (i > k) + (i > l) + (j > k) + (j > l) + (k > l);
  if (inversions % 2 == 1) std::swap(k, l);
  TetIndex t = start;
  VertexIndex a = corner[t][k], b = corner[t][l];
  do {
    tets.push_back(t);
    link.push_back(a);
    if (tets.size() > limit) return false;
    const HalfFace o = across[t][corner_of(t, a)];
    if (o == kNone) return false;
    a = b;
    b = apex(o);
    t = o / 4;
  } while (t != start);
  return true;
}

}  // namespace octafront::recovery
