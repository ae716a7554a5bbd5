#pragma once

#include <octafront/surface_mesh.h>

#include "base/core/shared_value.h"
#include "surface/edits/walk.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront::surface {

// surface/edits: the surface while it is changed, and single sound edits of it: edges that turn and collapse
// (star_collapse, coarsen), of lines too (line_edits), guarded (local_guards), in blocks of parallel work (blocks). A
// closed manifold exists at every moment.

/// What a vertex of the working mesh is, and so what may happen to it.
enum class VertexKind : std::uint8_t {
  kRemovable,       ///< of the input, inside a patch: to be collapsed away
  kRemovableCurve,  ///< of the input, on a curve: to be collapsed away along it
  kFree,            ///< placed by the front: may move on the surface
  kCurve,           ///< division point of a curve
  kCorner,
};

/// A place on a divided curve.
struct CurvePlace {
  std::uint32_t curve = kNone;
  double along = 0;  ///< length of the curve up to there
};

/// The surface on its way from the input triangulation to the new one: a closed manifold of the same topology after
/// every operation. Removed triangles and vertices leave holes in the numbering until compact().
struct WorkingMesh : HalfEdgeMesh {
  /// The input triangulation: every vertex is the input's own, every triangle a whole input face.
  explicit WorkingMesh(const InputSurface& input);

  std::vector<VertexKind> kind;       ///< per vertex
  std::vector<Vec3> normal;           ///< per vertex: of the input surface there; zero on curves, and at tips
  std::vector<double> size;           ///< per vertex: wanted there
  std::vector<std::uint32_t> face;    ///< per vertex: an input face that it lies in
  std::vector<std::uint32_t> patch;   ///< per triangle
  std::vector<std::uint32_t> origin;  ///< per triangle: while inserting, the input face it is a part of
  std::vector<CurvePlace> place;      ///< per vertex: where on a curve it lies, if it may slide there
  std::vector<std::uint8_t> changed;  ///< per vertex: kForSmoothing ..., set by whatever changes around it

  /// Triangles of patches from here on are backs: see seams.h. What lies on seams stays as it is.
  std::uint32_t first_back = kNone;
  std::vector<std::uint8_t> pinned;  ///< by vertex: may have copies, on a seam or not; those beyond its end do not

  bool is_back(std::size_t t) const { return patch[t] >= first_back; }
  bool is_seam(HalfEdge h) const { return is_back(h / 3) != is_back(twin[h] / 3); }
  /// Whether the edge has backs on both of its sides.
  bool is_behind(HalfEdge h) const { return is_back(h / 3) && is_back(twin[h] / 3); }
  bool on_seam(VertexIndex v) const {
    bool found = false;
    if (first_back != kNone) for_each_outgoing(v, [&](HalfEdge h) { found = found || is_seam(h); });
    return found;
  }
  /// Whether the vertex may have copies that are to be sewn to it.
  bool is_sewn(VertexIndex v) const { return (v < pinned.size() && pinned[v] != 0) || on_seam(v); }

  /// Marks for passes that skip what did not change since they last saw it.
  static constexpr std::uint8_t kForSmoothing = 1, kForFlips = 2, kForSweep = 4;
  static constexpr std::uint8_t kForAll = kForSmoothing | kForFlips | kForSweep;
  /// Vertices beside what a block changes may be marked by several threads.
  void mark_changed(VertexIndex v) { SharedValue(changed[v]).store(kForAll); }
  void mark_star_changed(VertexIndex v) {
    mark_changed(v);
    for_each_outgoing(v, [&](HalfEdge h) { mark_changed(end(h)); });
  }

  bool is_marked(VertexIndex v, std::uint8_t mark) const { return (changed[v] & mark) != 0; }
  void clear_marks(std::uint8_t mark);

  std::size_t gone = 0;  ///< triangles that compact() has left out

  /// All triangles that were ever made, which is what the work so far has cost.
  std::size_t made_triangles() const { return triangle_count() + gone; }
  bool is_removed(std::size_t triangle) const { return start[3 * triangle] == kNone; }
  Triangle triangle(std::uint32_t t) const { return {start[3 * t], start[3 * t + 1], start[3 * t + 2]}; }
  /// The triangles that are not removed, in their order.
  std::vector<std::uint32_t> alive_triangles() const;
  bool is_free(VertexIndex v) const { return kind[v] == VertexKind::kFree || kind[v] == VertexKind::kRemovable; }
  bool on_curve(VertexIndex v) const { return !is_free(v); }
  bool has_normal(VertexIndex v) const { return is_free(v) && normal[v] != Vec3{}; }
  int valence(VertexIndex v) const {
    int n = 0;
    for_each_outgoing(v, [&](HalfEdge) { ++n; });
    return n;
  }

  /// Numbers what is left anew, in its order; returns the former number of each vertex. Of surfaces without backs.
  std::vector<VertexIndex> compact();
  /// Room for so many vertices and triangles in all.
  void reserve(std::size_t vertices, std::size_t triangles);
  VertexIndex add_vertex(Vec3 p, VertexKind k, Vec3 n, double h, std::uint32_t in_face);
  /// Puts x into the triangle: three triangles in its place; the first keeps the number.
  void split_triangle(std::uint32_t t, VertexIndex x);
  /// Puts x on the edge of h. Afterwards h runs from its start to x.
  void split_edge(HalfEdge h, VertexIndex x);
  /// Whether the edge may turn as far as connections and features go; those of backs do not.
  bool may_flip(HalfEdge h) const { return !is_feature[h] && !is_back(h / 3) && can_turn(h); }
  /// The same, features aside.
  bool can_turn(HalfEdge h) const;
  /// Turns the edge of h; returns a half-edge of the new edge.
  HalfEdge flip(HalfEdge h);
  /// Whether the start of h may move to its end and vanish, as far as connections and features go (link condition;
  /// feature vertices only along their curve; no two curves merge; a corner only if `corners_too`, for it is lost).
  bool may_collapse(HalfEdge h, bool corners_too = false) const;
  /// Whether the surface stays a manifold if the start of h vanishes at its end (link condition), features aside.
  bool keeps_manifold(HalfEdge h) const;
  /// Whether more than three edges meet at v: tips of backs have as many as a seam is long.
  bool has_more_than_three(VertexIndex v) const;
  bool are_joined(VertexIndex a, VertexIndex b) const;
  /// Moves the start of h to its end, where it vanishes with the two triangles beside h.
  void collapse(HalfEdge h);

  /// Where the surface is no closed manifold, a feature ends off the curves, or patches meet without a feature between
  /// them (base/core/validate.h).
  std::optional<std::string> first_inconsistency() const;
  /// The same in the stars of these vertices.
  std::optional<std::string> first_inconsistency(std::span<const VertexIndex> touched) const;
};

/// Pairs of triangles that meet in more than what they share, exactly; the smaller id first, sorted. Degenerate
/// triangles pair with themselves.
std::vector<std::array<std::uint32_t, 2>> find_crossings(const SurfaceMesh& surface);

}  // namespace octafront::surface
