#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/flat_map.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/face_table.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace octafront {

/// What lies across a face where no tet is: kFirstOutside + a number that says what, such as a boundary triangle. Below
/// it there is room for the half-faces of 7 * 2^27 tets.
inline constexpr HalfFace kFirstOutside = 0xe0000000u;
inline constexpr bool is_outside(HalfFace across) {
  return across >= kFirstOutside;
}

/// The tetrahedra around an edge, in order, with the other two corners of each.
struct EdgeRing {
  std::vector<TetIndex> tets;
  /// Corners around the edge (a, b), counter-clockwise seen from b: tet k is positive as (a, b, ring[k], ring[k + 1]).
  /// As many as tets if closed, one more if the edge lies on the boundary.
  std::vector<VertexIndex> ring;
  bool closed = true;
};

class TetComplex;

/// The outer faces of tets that make place for others, each with what lies across it: new tets are tied to that, and to
/// each other.
class TetRim {
 public:
  /// Makes room for `faces`, and forgets all others.
  void reset(std::size_t faces) {
    across_.reset(faces);
    outer_.clear(), parted_.clear();
    open_ = 0;
  }
  /// Adds the faces of a tet that goes; those between two of them vanish.
  void open(const TetComplex& complex, TetIndex t);
  /// Ties the faces of a new tet to what lies across, or leaves them for the new tets to come.
  void tie(TetComplex& complex, TetIndex t);
  /// Adds a face with what lies across it; one that is there already goes. Returns what lay across that, or kNone. Both
  /// sides of a face that parts the tets stay, each for the new tet on its side: around the rim of a sheet tets of both
  /// sides may go.
  HalfFace toggle(const Triangle& face, HalfFace across) {
    HalfFace& there = across_.find_or_add(face_key(face), kNone);
    open_ += there == kNone ? 1 : -1;
    if (is_outer(across)) {
      if (is_outer(there)) keep_sides(face, across);
      outer_.push_back({face, across});
    }
    return std::exchange(there, there == kNone ? across : kNone);
  }
  /// Whether the new tets fill the space of the old ones.
  bool closed() const { return open_ == 0; }

 private:
  struct OuterFace {
    Triangle corners;  ///< counter-clockwise seen from outside the tet
    HalfFace across;
  };

  static bool is_outer(HalfFace across) { return across != kNone && is_outside(across); }
  void keep_sides(const Triangle& face, HalfFace across);
  /// What lies across a face of which both sides are kept; kNone of others.
  HalfFace take_side(const Triangle& face);

  FlatMap<Triangle, HalfFace> across_;  ///< kNone: of a face that is no longer on the rim
  std::vector<OuterFace> outer_, parted_;
  std::ptrdiff_t open_ = 0;
};

/// How the tets of a mesh that is being changed hang together: neighbours by half-faces, a tet of each vertex, free
/// slots. It knows nothing of coordinates: whoever changes it sees to the signs. Plain arrays, for a room may keep more
/// beside them, and let threads work on parts of them.
class TetComplex {
 public:
  std::vector<Tet> tets;             ///< tets[t][0] == kNone: the slot is free
  std::vector<HalfFace> across;      ///< per half-face: the same face seen from the neighbour, or what is outside
  std::vector<TetIndex> tet_at;      ///< per vertex: one of its tets, or kNone
  std::vector<TetIndex> free;        ///< slots of no tet, the next one to be used last
  std::vector<std::uint32_t> marks;  ///< per tet: of walks, see new_mark()
  std::uint32_t last_mark = 0;

  /// Fills `across` and `tet_at`: neighbours by their common faces, kFirstOutside + b across a face on which triangle b
  /// of the boundary lies. kNone stays across faces of which neither, or too much, is known.
  void connect(std::size_t vertices, std::span<const Triangle> boundary);

  /// Parts the tets on the two sides of each of these triangles: what lies across for both becomes `outside`.
  void part(std::size_t vertices, std::span<const Triangle> triangles, HalfFace outside);

  TetIndex slots() const { return static_cast<TetIndex>(tets.size()); }
  bool alive(TetIndex t) const { return tets[t][0] != kNone; }
  /// The corners of a half-face, counter-clockwise seen from outside its tet.
  Triangle face(HalfFace h) const { return face_of(tets[h / 4], static_cast<int>(h % 4)); }
  VertexIndex apex(HalfFace h) const { return tets[h / 4][h % 4]; }
  /// The corner of t at which v lies. Requires that it does.
  int corner_of(TetIndex t, VertexIndex v) const {
    const Tet& c = tets[t];
    return c[0] == v ? 0 : c[1] == v ? 1 : c[2] == v ? 2 : 3;
  }
  bool has(TetIndex t, VertexIndex v) const {
    const Tet& c = tets[t];
    return c[0] == v || c[1] == v || c[2] == v || c[3] == v;
  }
  /// The half-face of t opposite v.
  HalfFace opposite(TetIndex t, VertexIndex v) const { return 4 * t + static_cast<HalfFace>(corner_of(t, v)); }

  /// Puts a tet into a free slot, or a new one. Nothing is known of what lies across its faces.
  TetIndex create(const Tet& corners);
  void destroy(TetIndex t) {
    tets[t][0] = kNone;
    free.push_back(t);
  }
  /// Sets what lies across h; of a neighbour too.
  void join(HalfFace h, HalfFace other) {
    across[h] = other;
    if (!is_outside(other)) across[other] = h;
  }

  /// A boundary face, and what shall lie across it.
  struct BoundaryFace {
    Triangle corners;
    HalfFace across;
  };
  /// Replaces the tets `old` by `fresh`, which must fill the same space; they are in created(). Boundary faces of `old`
  /// that contain `gone` go too: those in `boundary` take their place. Throws std::logic_error if the faces do not
  /// match.
  void replace(std::span<const TetIndex> old, std::span<const Tet> fresh, VertexIndex gone = kNone,
               std::span<const BoundaryFace> boundary = {});
  const std::vector<TetIndex>& created() const { return created_; }

  /// A mark that no tet carries yet.
  std::uint32_t new_mark();

  /// All tets around v that are connected through faces that contain it, from tet_at[v] or `start` on.
  const std::vector<TetIndex>& star(VertexIndex v) { return star_from(v, tet_at[v]); }
  const std::vector<TetIndex>& star_from(VertexIndex v, TetIndex start);

  enum class Turn { kClosed, kOpen, kGivenUp };
  /// Turns around the edge between corners i and j of t, from t on, one way, as long as accept(next tet) says so.
  template <class Accept>
  Turn turn_around(TetIndex t, int i, int j, EdgeRing& out, const Accept& accept) const {
    out.tets.clear();
    out.ring.clear();
    out.closed = true;
    const auto [p, q] = other_corners(i, j);
    // Turning from p to q leaves each tet through the face opposite its first ring corner.
    VertexIndex from = tets[t][p], to = tets[t][q];
    for (const VertexIndex start = from;;) {
      out.tets.push_back(t);
      out.ring.push_back(from);
      if (to == start) return Turn::kClosed;
      const HalfFace o = across[opposite(t, from)];
      if (is_outside(o)) break;
      if (!accept(o / 4)) return Turn::kGivenUp;
      t = o / 4;
      from = std::exchange(to, apex(o));
    }
    out.ring.push_back(to);
    out.closed = false;
    return Turn::kOpen;
  }
  /// The same both ways: of an open ring what lies on the other side of t goes before it.
  template <class Accept>
  Turn whole_ring(TetIndex t, int i, int j, EdgeRing& out, const Accept& accept) const {
    if (const Turn turn = turn_around(t, i, j, out, accept); turn != Turn::kOpen) return turn;
    VertexIndex from = out.ring[0], to = out.ring[1];
    for (;;) {
      const HalfFace o = across[opposite(t, to)];
      if (is_outside(o)) return Turn::kOpen;
      t = o / 4;
      if (!accept(t)) return Turn::kGivenUp;
      to = std::exchange(from, apex(o));
      out.tets.insert(out.tets.begin(), t);
      out.ring.insert(out.ring.begin(), from);
    }
  }
  /// The ring of the edge (p, q) of t, from t on. False if the edge lies on the boundary or has more than `most` tets.
  bool closed_ring(TetIndex t, VertexIndex p, VertexIndex q, EdgeRing& out, std::size_t most = kNone) const {
    return turn_around(t, corner_of(t, p), corner_of(t, q), out, [&](TetIndex) { return out.tets.size() < most; }) ==
           Turn::kClosed;
  }

  /// The first thing that is wrong: neighbours that do not know each other or do not share the face, tets of vertices
  /// that do not have them, free slots that are none. O(tets).
  std::optional<std::string> first_inconsistency() const;
  /// Looks at these tets and their vertices only.
  std::optional<std::string> first_inconsistency(std::span<const TetIndex> touched) const;

 private:
  /// The two other corners p and q of a tet, named so that (i, j, p, q) is positive.
  static std::array<int, 2> other_corners(int i, int j) {
    int p = 0;
    while (p == i || p == j) ++p;
    const int q = 6 - i - j - p;
    const bool odd = ((i > j) + (i > p) + (i > q) + (j > p) + (j > q) + (p > q)) % 2 != 0;
    return odd ? std::array<int, 2>{q, p} : std::array<int, 2>{p, q};
  }

  std::vector<TetIndex> created_, star_;
  TetRim rim_;
};

inline void TetRim::open(const TetComplex& complex, TetIndex t) {
  for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) toggle(complex.face(h), complex.across[h]);
}

inline void TetRim::tie(TetComplex& complex, TetIndex t) {
  for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
    const Triangle face = complex.face(h);
    const HalfFace side = parted_.empty() ? kNone : take_side(face);
    complex.join(h, side != kNone ? side : toggle(face, h));
  }
}

}  // namespace octafront
