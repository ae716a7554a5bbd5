// Incremental Delaunay tetrahedralisation (A. Bowyer and D. F. Watson, 1981) in a biased randomised insertion order (N.
// Amenta, S. Choi, G. Rote, "Incremental constructions con BRIO", 2003) with rounds sorted along a Hilbert curve
// (coding after J. Skilling, "Programming the Hilbert curve", 2004).
//
// A tet conflicts with p if p lies strictly inside its sphere. For a Delaunay mesh with cospherical points this needs
// no perturbation: if p lies behind a face of a conflicting tet, or on it, then strictly inside the neighbour's sphere
// too. So the conflict region is connected and p sees its rim strictly.

#include "fill/recovery/delaunay.h"

#include "base/core/random.h"
#include "base/geometry/predicates.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace octafront::recovery {

namespace {

// Position along a Hilbert curve of 2^16 cells a side; coordinates in [0, 2^16).
std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t kTop = 1u << 15;
  for (std::uint32_t q = kTop; q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (auto& xi : x) {
      if (xi & q) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ xi) & p;
        x[0] ^= t;
        xi ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = kTop; q > 1; q >>= 1) {
    if (x[2] & q) t ^= q - 1;
  }
  for (auto& xi : x) xi ^= t;
  std::uint64_t key = 0;
  for (int bit = 15; bit >= 0; --bit) {
    for (const auto xi : x) key = key << 1 | (xi >> bit & 1);
  }
  return key;
}

std::vector<VertexIndex> insertion_order(const ExactPoints& points, const std::vector<bool>& used, const Box3& box) {
  struct Entry {
    int round;
    std::uint64_t key;
    VertexIndex vertex;
  };
  std::vector<Entry> entries;
  std::size_t count = 0;
  for (const bool u : used) count += u;
  entries.reserve(count);
  const Vec3 extent = box.extent();
  const double side = std::max({extent.x, extent.y, extent.z, 1e-300});
  const int rounds = count < 64 ? 1 : static_cast<int>(std::bit_width(count)) - 5;
  for (VertexIndex v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    const Vec3 p = (points.at(v) - box.lo) / side * 65535.0;
    const auto cell = [](double c) { return static_cast<std::uint32_t>(std::clamp(c, 0.0, 65535.0)); };
    // The last round has half of the vertices, the one before a quarter, and so on.
    const int back = std::countr_zero(mixed_bits(v) | 1ull << 40);
    entries.push_back({std::max(0, rounds - 1 - back), hilbert_key({cell(p.x), cell(p.y), cell(p.z)}), v});
  }
  std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
    return a.round != b.round ? a.round < b.round : a.key != b.key ? a.key < b.key : a.vertex < b.vertex;
  });
  std::vector<VertexIndex> order;
  order.reserve(count);
  for (const Entry& e : entries) order.push_back(e.vertex);
  return order;
}

class Builder {
 public:
  Builder(ExactPoints& points, TetComplex& mesh) : points_(points), mesh_(mesh) {}

  // A large tetrahedron around the box, of odd shape: one aligned with the axes would be coplanar with parts of many
  // models.
  VertexIndex start(const Box3& box) {
    const Vec3 c = box.center(), e = box.extent();
    const double tiny = 1e-12 * (std::abs(c.x) + std::abs(c.y) + std::abs(c.z)) + 1e-300;
    const double r = 8 * std::max({e.x, e.y, e.z, tiny});
    const VertexIndex first = points_.size();
    constexpr std::array<Vec3, kFrameVertices> kCorners{
        {{1.0137, 0.9421, 0.8911}, {-1.1073, -0.8837, 0.9719}, {-0.9347, 1.0531, -1.0973}, {1.0391, -0.9689, -0.9133}}};
    for (const Vec3& k : kCorners) points_.add(c + r * k);
    mesh_.tet_at.assign(points_.size(), kNone);
    last_ = mesh_.create({first, first + 1, first + 2, first + 3});
    std::ranges::fill(mesh_.across, kFirstOutside);
    return first;
  }

  // The vertex that is there: v, or an earlier one with the same coordinates.
  VertexIndex insert(VertexIndex v) {
    p_ = points_.at(v);
    const TetIndex t = locate(last_);
    for (const VertexIndex c : mesh_.tets[t]) {
      if (points_.at(c) == p_) return c;
    }
    collect_conflicts(t);
    fill(v);
    return v;
  }

 private:
  TetIndex locate(TetIndex t) {
    HalfFace from = kNone;
    for (;;) {
      bool moved = false;
      random_ = random_ * 1664525u + 1013904223u;
      const unsigned shift = random_ >> 30;
      for (unsigned k = 0; k < 4 && !moved; ++k) {
        const HalfFace h = 4 * t + ((k + shift) & 3);
        if (h == from) continue;
        const Triangle f = mesh_.face(h);
        if (orient3d(points_.at(f[0]), points_.at(f[1]), points_.at(f[2]), p_) <= 0) continue;
        from = mesh_.across[h];
        t = from / 4;
        moved = true;
      }
      if (!moved) return t;
    }
  }

  bool conflicts(TetIndex t) const {
    const Tet& c = mesh_.tets[t];
    return insphere(points_.at(c[0]), points_.at(c[1]), points_.at(c[2]), points_.at(c[3]), p_) > 0;
  }

  void collect_conflicts(TetIndex start) {
    const std::uint32_t in = mesh_.new_mark(), out = mesh_.new_mark();
    conflict_.assign(1, start);
    rim_.clear();
    mesh_.marks[start] = in;
    for (std::size_t k = 0; k < conflict_.size(); ++k) {
      const TetIndex t = conflict_[k];
      for (int i = 0; i < 4; ++i) {
        const HalfFace o = mesh_.across[4 * t + i];
        if (!is_outside(o) && mesh_.marks[o / 4] == in) continue;
        if (!is_outside(o) && mesh_.marks[o / 4] != out) {
          if (conflicts(o / 4)) {
            mesh_.marks[o / 4] = in;
            conflict_.push_back(o / 4);
            continue;
          }
          mesh_.marks[o / 4] = out;
        }
        rim_.push_back({mesh_.tets[t], i, o});
      }
    }
  }

  void fill(VertexIndex v) {
    for (const TetIndex t : conflict_) mesh_.destroy(t);
    const std::size_t wanted = std::max<std::size_t>(64, std::bit_ceil(4 * rim_.size()));
    if (table_.size() < wanted) table_.resize(wanted, {0, 0, 0});
    ++stamp_;
    for (Rim& r : rim_) {
      r.corners[r.face] = v;
      const TetIndex t = mesh_.create(r.corners);
      mesh_.join(4 * t + r.face, r.outer);
      for (int i = 0; i < 4; ++i) {
        if (i != r.face) join(4 * t + i, r, i);
      }
      last_ = t;
    }
  }

  struct Rim {
    Tet corners;
    int face;
    HalfFace outer;
  };
  struct Side {
    std::uint64_t key;
    HalfFace half;
    std::uint32_t stamp;
  };

  // Face i of a new tet holds v and the edge of the two corners that are neither i nor v: the second tet to come with
  // the same edge is the neighbour.
  void join(HalfFace h, const Rim& r, int i) {
    VertexIndex a = kNone, b = kNone;
    for (int k = 0; k < 4; ++k) {
      if (k == i || k == r.face) continue;
      b = a;
      a = r.corners[k];
    }
    const std::uint64_t key = a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
    const std::size_t mask = table_.size() - 1;
    for (std::size_t s = key * 0x9E3779B97F4A7C15u >> 40 & mask;; s = (s + 1) & mask) {
      Side& side = table_[s];
      if (side.stamp != stamp_) {
        side = {key, h, stamp_};
        return;
      }
      if (side.key == key) {
        mesh_.join(h, side.half);
        return;
      }
    }
  }

  ExactPoints& points_;
  TetComplex& mesh_;
  TetIndex last_ = 0;
  Vec3 p_;
  std::uint32_t random_ = 1, stamp_ = 0;
  std::vector<TetIndex> conflict_;
  std::vector<Rim> rim_;
  std::vector<Side> table_;
};

}  // namespace

VertexIndex delaunay(ExactPoints& points, const std::vector<bool>& used, TetComplex& mesh,
                     std::vector<VertexIndex>& same_as, const RunContext& context) {
  Box3 box;
  for (VertexIndex v = 0; v < used.size(); ++v) {
    if (used[v]) box.add(points.at(v));
  }
  const std::vector<VertexIndex> order = insertion_order(points, used, box);
  Builder builder(points, mesh);
  const VertexIndex first_box_vertex = builder.start(box);
  same_as.resize(used.size());
  for (VertexIndex v = 0; v < used.size(); ++v) same_as[v] = v;
  std::size_t done = 0;
  for (const VertexIndex v : order) {
    if (++done % 1024 == 0) context.check();
    same_as[v] = builder.insert(v);
  }
  return first_box_vertex;
}

}  // namespace octafront::recovery
