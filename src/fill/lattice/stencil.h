#pragma once

#include "fill/lattice/graded_bcc.h"

#include <array>
#include <cstdint>

namespace octafront {

/// A corner of a lattice tetrahedron as the stencils see it.
struct StencilCorner {
  std::uint32_t vertex;  ///< of the output mesh; unused where side is -1
  int side;              ///< +1 inside, 0 on the boundary, -1 outside
};

/// Which of two cut points of a face gets the diagonal of the quadrilateral that the cut leaves there: the one with the
/// greater rank. It depends on the cut edge alone, so the two tetrahedra of a face agree, and no diagonals run in a
/// circle. Longer edges come first; among equal ones those with an even number of coordinates that grow towards the
/// inside (the parity rule of Labelle & Shewchuk 2007).
struct CutRank {
  std::uint64_t squared_length;
  bool even;
  LatticeSite inside;

  friend auto operator<=>(const CutRank&, const CutRank&) = default;
};

inline CutRank rank_of_cut(LatticeSite inside, LatticeSite outside) {
  const auto a = unpack_site(inside), b = unpack_site(outside);
  CutRank rank{0, true, inside};
  for (int k = 0; k < 3; ++k) {
    const std::int64_t d = static_cast<std::int64_t>(a[k]) - static_cast<std::int64_t>(b[k]);
    rank.squared_length += static_cast<std::uint64_t>(d * d);
    if (d > 0) rank.even = !rank.even;
  }
  return rank;
}

/// The part of a tetrahedron that lies inside, as at most three tetrahedra; their orientation is the caller's to mend.
/// cut(i, j) is the vertex between inside corner i and outside corner j; ranks as above. better(first, second) says
/// which of two pairs of tetrahedra to take where the choice is free.
class Stencil {
 public:
  using Corners = std::array<std::uint32_t, 4>;

  Stencil(const std::array<StencilCorner, 4>& corners, const std::array<LatticeSite, 4>& sites)
      : corners_(corners), sites_(sites) {}

  template <class Cut, class Better, class Emit>
  void apply(const Cut& cut, const Better& better, const Emit& emit) const {
    std::array<int, 4> in{}, zero{}, out{};
    int ins = 0, zeros = 0, outs = 0;
    for (int i = 0; i < 4; ++i) {
      const int s = corners_[i].side;
      (s > 0 ? in[ins++] : s < 0 ? out[outs++] : zero[zeros++]) = i;
    }
    if (ins == 0) return;
    if (outs == 0) return emit({vertex(0), vertex(1), vertex(2), vertex(3)});
    if (ins == 1) {
      Corners tet;
      for (int i = 0; i < 4; ++i) tet[i] = corners_[i].side < 0 ? cut(in[0], i) : vertex(i);
      return emit(tet);
    }
    if (outs == 1) return cut_one_corner(in, ins, zeros > 0 ? vertex(zero[0]) : 0, out[0], cut, emit);
    cut_two_corners(in, out, cut, better, emit);
  }

 private:
  std::uint32_t vertex(int i) const { return corners_[i].vertex; }
  bool comes_first(int in1, int out1, int in2, int out2) const {
    return rank_of_cut(sites_[in1], sites_[out1]) > rank_of_cut(sites_[in2], sites_[out2]);
  }

  /// A prism (three corners inside) or a pyramid (two inside, `apex` on the boundary) remains.
  template <class Cut, class Emit>
  void cut_one_corner(std::array<int, 4> in, int ins, std::uint32_t apex, int out, const Cut& cut,
                      const Emit& emit) const {
    // Sorted by rank, at most three.
    for (int i = 1; i < ins; ++i)
      for (int j = i; j > 0 && comes_first(in[j], out, in[j - 1], out); --j) std::swap(in[j], in[j - 1]);
    const std::uint32_t x0 = vertex(in[0]), x1 = vertex(in[1]), x2 = ins == 3 ? vertex(in[2]) : apex;
    const std::uint32_t c0 = cut(in[0], out), c1 = cut(in[1], out);
    emit({x0, x1, x2, c0});
    emit({c0, x1, x2, c1});
    if (ins == 3) emit({c0, c1, x2, cut(in[2], out)});
  }

  /// A wedge remains: triangles at both inside corners, joined by two quadrilaterals on faces of the tetrahedron and
  /// one on the boundary, whose diagonal is free.
  template <class Cut, class Better, class Emit>
  void cut_two_corners(const std::array<int, 4>& in, const std::array<int, 4>& out, const Cut& cut,
                       const Better& better, const Emit& emit) const {
    const int a = in[0], b = in[1], c = out[0], d = out[1];
    const std::array<std::uint32_t, 3> top{vertex(a), cut(a, c), cut(a, d)}, bottom{vertex(b), cut(b, c), cut(b, d)};
    const bool c_first = comes_first(a, c, b, c), d_first = comes_first(a, d, b, d);
    // order[0] of the top joins both others of the bottom, order[1] joins order[2].
    const auto tets = [&](std::array<int, 3> o) {
      return std::array<Corners, 3>{{{bottom[o[0]], bottom[o[1]], bottom[o[2]], top[o[0]]},
                                     {top[o[0]], bottom[o[1]], bottom[o[2]], top[o[1]]},
                                     {top[o[0]], top[o[1]], bottom[o[2]], top[o[2]]}}};
    };
    std::array<Corners, 3> made;
    if (c_first && !d_first) {
      made = tets({1, 0, 2});
    } else if (d_first && !c_first) {
      made = tets({2, 0, 1});
    } else {
      const auto one = c_first ? tets({1, 2, 0}) : tets({0, 1, 2}), two = c_first ? tets({2, 1, 0}) : tets({0, 2, 1});
      made = better(one, two) ? one : two;
    }
    for (const Corners& tet : made) emit(tet);
  }

  std::array<StencilCorner, 4> corners_;
  std::array<LatticeSite, 4> sites_;
};

}  // namespace octafront
