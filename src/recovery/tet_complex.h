#pragma once

#include <octafront/tet_mesh.h>

#include <array>
#include <span>
#include <vector>

namespace octafront::recovery {

/// Half-face h = 4 * tet + i is face i of that tet, as in tet_mesh.h.
using HalfFace = std::uint32_t;

/// A triangle with a label.
struct LabelledFace {
  Triangle corners;
  std::uint32_t label;
};

/// A tetrahedral mesh that is being edited: corners, neighbours and a label per face. Slots of removed tets are reused.
/// Positive tets only; it is the editor who checks signs.
class TetComplex {
 public:
  std::vector<Tet> corner;                          ///< corner[t][0] == kNone: the slot is free
  std::vector<std::array<HalfFace, 4>> across;      ///< the same face seen from the neighbour; kNone at the boundary
  std::vector<std::array<std::uint32_t, 4>> label;  ///< the facet that lies on the face, or kNone; equal on both sides
  std::vector<TetIndex> tet_at;                     ///< per vertex one of its tets, or kNone

  bool alive(TetIndex t) const { return corner[t][0] != kNone; }
  TetIndex slots() const { return static_cast<TetIndex>(corner.size()); }
  /// A slot for a new tet; neighbours and labels are kNone.
  TetIndex create(const Tet& corners);
  void destroy(TetIndex t);
  void glue(HalfFace a, HalfFace b) {
    across[a / 4][a % 4] = b;
    across[b / 4][b % 4] = a;
  }
  HalfFace opposite(HalfFace h) const { return across[h / 4][h % 4]; }
  /// The corners of a half-face, counter-clockwise seen from outside its tet.
  Triangle face(HalfFace h) const {
    const Tet& c = corner[h / 4];
    const auto& f = kTetFaces[h % 4];
    return {c[f[0]], c[f[1]], c[f[2]]};
  }
  VertexIndex apex(HalfFace h) const { return corner[h / 4][h % 4]; }
  void set_label(HalfFace h, std::uint32_t value);
  /// Which corner of t is v; 4 if none.
  int corner_of(TetIndex t, VertexIndex v) const {
    const Tet& c = corner[t];
    return c[0] == v ? 0 : c[1] == v ? 1 : c[2] == v ? 2 : c[3] == v ? 3 : 4;
  }
  bool has(TetIndex t, VertexIndex v) const { return corner_of(t, v) < 4; }

  /// Replaces the tets `old` by `fresh`, which must fill the same space. Faces on the rim of the space keep neighbours
  /// and labels. Boundary faces of `old` that contain `gone` are not carried over; `boundary` are new ones in their
  /// place. The new tets are in created(). Throws std::logic_error if the faces do not match.
  void replace(std::span<const TetIndex> old, std::span<const Tet> fresh, VertexIndex gone = kNone,
               std::span<const LabelledFace> boundary = {});
  const std::vector<TetIndex>& created() const { return created_; }

  /// All tets around vertex v that are connected through faces that contain it, from tet_at[v] on.
  const std::vector<TetIndex>& star(VertexIndex v) { return star_from(v, tet_at[v]); }
  const std::vector<TetIndex>& star_from(VertexIndex v, TetIndex start);
  /// The tets around edge (p, q), one of which is `start`, in turn: ring[i] follows after start as (p, q, a, b), then
  /// (p, q, b, c), ... Returns false if the edge lies on the boundary or has more than `limit` tets.
  /// `link` receives a, b, c, ...
  bool ring(VertexIndex p, VertexIndex q, TetIndex start, std::size_t limit, std::vector<TetIndex>& tets,
            std::vector<VertexIndex>& link) const;

  /// A fresh mark: no tet carries it yet.
  std::uint32_t new_mark();
  std::uint32_t& mark(TetIndex t) { return mark_[t]; }
  std::uint32_t mark_of(TetIndex t) const { return mark_[t]; }

 private:
  struct RimFace {
    Triangle key;  ///< sorted
    HalfFace half = kNone;
    std::uint32_t label = kNone;
    bool open = false;
  };
  RimFace& rim_slot(Triangle sorted);
  void clear_rim(std::size_t faces);

  std::vector<TetIndex> free_, created_, star_;
  std::vector<std::uint32_t> mark_;
  std::uint32_t last_mark_ = 0;
  std::vector<RimFace> rim_;  ///< open addressing, power of two
};

}  // namespace octafront::recovery
