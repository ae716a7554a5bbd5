#pragma once

#include <array>
#include <cstddef>

namespace octafront {

/// The best triangulation of the ring around an edge that goes, each triangle standing for the two tets that it makes
/// with the ends of the edge: by dynamic programming over diagonals (Klincsek 1980; Shewchuk, "Two discrete
/// optimization algorithms for the topological improvement of tetrahedral meshes", 2002).
template <std::size_t kMost>
class RingFilling {
 public:
  /// The greatest worth of a triangulation of n vertices, at most kMost; the triangles are kept. `nothing`: the worth
  /// of none. worth(i, k, j, low, high, best): of all from i to j with the triangle (i, k, j), the best between i and k
  /// being worth `low`, that between k and j `high`; `never`, or anything up to `best`, if that is no better.
  /// may_have(i, j): whether the diagonal may be.
  template <class Worth, class MayHave>
  float best(int n, float nothing, float never, const Worth& worth, const MayHave& may_have) {
    for (int span = 1; span < n; ++span)
      for (int i = 0; i + span < n; ++i) {
        const int j = i + span;
        float& best = best_[i][j];
        best = span == 1 ? nothing : never;
        if (span > 1 && span < n - 1 && !may_have(i, j)) continue;
        for (int k = i + 1; k < j; ++k)
          if (const float w = worth(i, k, j, best_[i][k], best_[k][j], best); w > best) best = w, apex_[i][j] = k;
      }
    return best_[0][n - 1];
  }

  /// visit(i, k, j) for the triangles of the best triangulation of n vertices.
  template <class Visit>
  void for_each(int n, const Visit& visit) const {
    for_each_between(0, n - 1, visit);
  }

 private:
  template <class Visit>
  void for_each_between(int i, int j, const Visit& visit) const {
    if (j - i < 2) return;
    const int k = apex_[i][j];
    visit(i, k, j);
    for_each_between(i, k, visit), for_each_between(k, j, visit);
  }

  std::array<std::array<float, kMost>, kMost> best_;
  std::array<std::array<int, kMost>, kMost> apex_;
};

}  // namespace octafront
