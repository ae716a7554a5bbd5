#pragma once

// A part of a mesh that one worker changes all by himself, with its vertices, walls and lines. Pieces are
// taken from a mesh of parts by cells of space, changed, and put together again; what lies on their rims stays.

#include <octafront/tet_mesh.h>

#include "adapt/metric/metric.h"
#include "base/core/flat_map.h"
#include "base/geometry/predicates.h"
#include "base/mesh/tet_complex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront::adapt {

/// How free a vertex is.
enum class Kind : std::uint8_t { kInner, kSurface, kCurve, kFixed };

/// What passes ask about most lies in one line of the cache.
struct alignas(64) Vertex {
  Vec3 at;
  Kind kind = Kind::kInner;
  bool rim = false;       ///< of a piece: some of its tets are not there, so it stays
  bool active = true;     ///< something may be left to connect, split or collapse around it
  bool loose = true;      ///< it may have to move
  bool touched = true;    ///< of a piece: it was active when that was taken, or something around it changed since
  bool exact = true;      ///< the metric is that of the place, not one on the way to it
  bool frozen = false;    ///< asked to stay as it is, with all that is between vertices that are
  bool held = false;      ///< asked to stay as it is, alone
  bool off = false;       ///< on a wall, beside the surface that was given: it is to go there
  bool balanced = false;  ///< nothing around it changed since walls were balanced
  /// For what mends: kStirred, something around it changed; kSettling, just before the cycle that is under way; kCalm,
  /// all that could be tried around it has been, in vain.
  enum Calmness : std::uint8_t { kCalm, kSettling, kStirred } calmness = kStirred;
  std::uint32_t id = kNone;    ///< in the mesh that was given; kNone: new
  std::uint32_t hint = 0;      ///< where the metric was looked up (MetricField::at)
  std::uint32_t near = kNone;  ///< of a wall: a triangle of the ground that may be near; spares searches only
  double density = 1;          ///< density_of(metric)
  Metric metric;

  bool stays() const { return rim || frozen || held || kind == Kind::kFixed; }
};
static_assert(offsetof(Vertex, metric) + sizeof(double) <= 64);

/// The label of a half-face that lies on a wall, else 0: one more than the number of the part, and kOuter where nothing
/// lies across.
using Wall = std::uint32_t;
inline constexpr Wall kOuter = 0x80000000u;

/// What lies across outer walls, and across the rim of a piece.
inline constexpr HalfFace kOutside = kFirstOutside, kBeyondRim = kFirstOutside + 1;

/// The corner whose metric an element is measured in.
OCTAFRONT_KERNEL const Vertex& densest_of(const std::array<const Vertex*, 4>& corners) {
  const Vertex* densest = corners[0];
  for (int i = 1; i < 4; ++i)
    if (corners[i]->density > densest->density) densest = corners[i];
  return *densest;
}

/// The length of an edge; in metrics of size without the tensors.
OCTAFRONT_KERNEL double length_between(const Vertex& p, const Vertex& q, bool isotropic) {
  const Vec3 e = q.at - p.at;
  if (!isotropic) return metric_length(e, p.metric, q.metric);
  const double squared = dot(e, e);
  return log_mean(std::sqrt(p.metric.xx * squared), std::sqrt(q.metric.xx * squared));
}
/// Bounds of the squared length of an edge: most of them need no more to be told short, long or neither.
struct SquaredBounds {
  double least, most;

  bool surely_within(double length) const { return most <= (1 - kSlack) * length * length; }
  bool surely_beyond(double length) const { return least >= (1 + kSlack) * length * length; }

 private:
  static constexpr double kSlack = 1e-9;  ///< more than lengths and their squares differ by rounding
};
/// A length lies between those in the metrics of the two ends.
OCTAFRONT_KERNEL SquaredBounds squared_bounds(const Vertex& p, const Vertex& q, bool isotropic) {
  const Vec3 e = q.at - p.at;
  const double squared = dot(e, e), a = isotropic ? p.metric.xx * squared : adapt::squared(p.metric, e),
               b = isotropic ? q.metric.xx * squared : adapt::squared(q.metric, e);
  return {std::min(a, b), std::max(a, b)};
}
/// A vertex on the way between two, without a place or a kind: with its metric where it does not get its own.
Vertex between(const Vertex& a, const Vertex& b, double part);
/// The score of a positive tet that is worth so much.
OCTAFRONT_KERNEL float positive_score(double worth) {
  return std::max(static_cast<float>(worth), 1e-30f);
}
/// The score of a tet, 0 if it is not positive by exact sign, in metrics of size, which make all lengths longer alike:
/// the shape alone counts. `worth`: its metric_score().
OCTAFRONT_KERNEL float score_by_shape(double worth, Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
  // Of elements of a better score the sign of the volume is beyond doubt: rounding is 1e-14 of the edges at most.
  constexpr double kCertainScore = 1e-9;
  if (worth > kCertainScore) return static_cast<float>(worth);
  return orient3d(p, q, r, s) > 0 ? positive_score(worth) : 0;
}
/// The score of a tet with these corners, 0 if it is not positive by exact sign.
OCTAFRONT_KERNEL float score_of_corners(const std::array<const Vertex*, 4>& c, bool isotropic) {
  const Vec3 p = c[0]->at, q = c[1]->at, r = c[2]->at, s = c[3]->at;
  const double det = detail::orient3d_det(p, q, r, s);
  if (isotropic) return score_by_shape(metric_score(det, p, q, r, s), p, q, r, s);
  if (orient3d(p, q, r, s) <= 0) return 0;
  const Vertex& d = densest_of(c);
  return positive_score(metric_score(det, d.metric, d.density, p, q, r, s));
}

/// A mesh whose every part carries a number: tets, half-faces on walls, edges on lines. Flat arrays.
struct Parts {
  std::vector<Vertex> vertices;
  std::vector<Tet> tets;
  std::vector<std::uint32_t> region;      ///< per tet: the number of its part
  std::vector<std::array<Wall, 4>> wall;  ///< per tet and face
  struct Line {
    Edge edge;           ///< sorted
    std::uint32_t path;  ///< the line that it belongs to, between two corners; kStays: it must not be divided
  };
  static constexpr std::uint32_t kStays = kNone;
  std::vector<Line> lines;
  bool isotropic = false;  ///< all metrics are those of sizes
  float poor = 0;          ///< elements of a lower score are mended

  /// Adds a tet of another mesh of the same vertices.
  void add(const Parts& other, TetIndex t) {
    tets.push_back(other.tets[t]), region.push_back(other.region[t]), wall.push_back(other.wall[t]);
  }
};

/// The lines of a mesh that is changed: the path of each edge that lies on one.
class LineEdges {
 public:
  explicit LineEdges(std::size_t expected) : edges_(expected) {}

  const std::uint32_t* find(VertexIndex a, VertexIndex b) const { return edges_.find(sorted_edge(a, b)); }
  void set(VertexIndex a, VertexIndex b, std::uint32_t path) { edges_.find_or_add(sorted_edge(a, b)) = path; }
  void drop(VertexIndex a, VertexIndex b) { edges_.erase(sorted_edge(a, b)); }
  /// The edge ab is divided at v.
  void divide(VertexIndex a, VertexIndex b, VertexIndex v, std::uint32_t path) {
    drop(a, b);
    set(a, v, path), set(v, b, path);
  }
  /// The line that led through u to w leads to w; `beside`: vertices, those next to u on the line among them.
  template <class Vertices>
  void shorten(VertexIndex u, VertexIndex w, const Vertices& beside) {
    const std::uint32_t path = *find(u, w);
    for (const VertexIndex v : beside) {
      if (!find(u, v)) continue;
      drop(u, v);
      if (v != w) set(v, w, path);
    }
  }
  template <class Visit>
  void for_each(const Visit& visit) const {
    edges_.for_each(visit);
  }

 private:
  FlatMap<Edge, std::uint32_t> edges_;
};

/// The tets of a Parts that one worker may change, and those vertices, walls and lines that they have.
class Piece {
 public:
  /// Takes these tets; `here` has kNone for each vertex of the mesh, and has it again afterwards. `number` becomes that
  /// in the mesh of each vertex.
  Piece(const Parts& mesh, std::span<const TetIndex> tets, std::span<const Parts::Line> lines,
        std::vector<VertexIndex>& here, std::vector<VertexIndex>& number);

  std::vector<Vertex> vertices;
  TetComplex complex;
  std::vector<std::uint32_t> region;  ///< per slot
  std::vector<Wall> wall;             ///< per half-face
  std::vector<float> score;           ///< per slot: metric_score()
  bool isotropic = false;             ///< Parts::isotropic
  float poor = 0;                     ///< Parts::poor
  LineEdges line_edges;

  const Tet& tet(TetIndex t) const { return complex.tets[t]; }
  Vec3 point(VertexIndex v) const { return vertices[v].at; }
  /// The path of the line that the edge lies on; nullptr: none.
  const std::uint32_t* line(VertexIndex a, VertexIndex b) const {
    if (vertices[a].kind < Kind::kCurve || vertices[b].kind < Kind::kCurve) return nullptr;
    return line_edges.find(a, b);
  }

  double edge_length(VertexIndex a, VertexIndex b) const { return length_between(vertices[a], vertices[b]); }
  double length_between(const Vertex& p, const Vertex& q) const { return adapt::length_between(p, q, isotropic); }
  bool is_longer(const Vertex& p, const Vertex& q, double length) const {
    const SquaredBounds bounds = squared_bounds(p, q, isotropic);
    return !bounds.surely_within(length) && (bounds.surely_beyond(length) || length_between(p, q) > length);
  }
  bool is_longer(VertexIndex a, VertexIndex b, double length) const {
    return is_longer(vertices[a], vertices[b], length);
  }
  bool is_shorter(const Vertex& p, const Vertex& q, double length) const {
    const SquaredBounds bounds = squared_bounds(p, q, isotropic);
    return !bounds.surely_beyond(length) && (bounds.surely_within(length) || length_between(p, q) < length);
  }
  /// The score of a tet on these vertices, 0 if it is not positive by exact sign.
  float score_of(const Tet& t) const {
    return score_of_corners({&vertices[t[0]], &vertices[t[1]], &vertices[t[2]], &vertices[t[3]]});
  }
  float score_of_corners(const std::array<const Vertex*, 4>& c) const { return adapt::score_of_corners(c, isotropic); }

  /// The tets around v, of those in the piece. Valid until the next call.
  const std::vector<TetIndex>& star(VertexIndex v) { return complex.star(v); }
  /// The tets around the edge (a, b) of t, from one wall or rim to the other if there are any. False if tets beyond the
  /// rim may be around it too, or one of a score below `least` is.
  bool ring(TetIndex t, VertexIndex a, VertexIndex b, EdgeRing& out, float least = 0) const;
  /// A wall that the edge of a ring lies on, as the place in the ring that it leads to.
  struct WallAt {
    std::size_t place;
    VertexIndex tip;
    Wall wall;
  };
  void walls_of(VertexIndex a, VertexIndex b, const EdgeRing& ring, std::vector<WallAt>& out) const;
  /// visit(half-face) for the walls at a vertex, whose star is given, each once.
  template <class Visit>
  void for_each_wall(VertexIndex v, std::span<const TetIndex> star, const Visit& visit) const {
    for (const TetIndex t : star)
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
        if (wall[h] == 0 || complex.apex(h) == v) continue;
        if (is_outside(complex.across[h]) || complex.across[h] > h) visit(h);
      }
  }
  /// A tet of the piece that has both; kNone.
  TetIndex tet_with(VertexIndex a, VertexIndex b, TetIndex guess);

  struct NewTet {
    Tet corners;
    std::uint32_t region;
    float score;
  };
  /// A face that is to lie on a wall: with kOuter facing outward.
  struct NewWall {
    Triangle corners;
    Wall wall;
  };
  /// Puts new tets in the place of old ones; they are in created(). Outer walls of the old ones that none of the new
  /// has are gone. Their vertices become active.
  void replace(std::span<const TetIndex> old, std::span<const NewTet> fresh, std::span<const NewWall> walls);
  const std::vector<TetIndex>& created() const { return created_; }

  /// Moves a vertex whose star is given, with the scores there. Its neighbours become loose, and active if that is far.
  void move(VertexIndex v, const Vertex& to, std::span<const TetIndex> star, std::span<const float> scores);

  /// Whether something may be left to do around one of the corners.
  bool is_active(TetIndex t) const {
    const Tet& c = tet(t);
    return std::any_of(c.begin(), c.end(), [&](VertexIndex v) { return vertices[v].active; });
  }
  /// Something around the vertex changed.
  void touch(VertexIndex v) {
    loosen(v);
    vertices[v].active = true;
  }
  /// Something moved a little around it.
  void loosen(VertexIndex v) {
    vertices[v].loose = vertices[v].touched = true;
    vertices[v].balanced = false;
    vertices[v].calmness = Vertex::kStirred;
  }

  std::vector<Parts::Line> lines() const;

  /// What is wrong with neighbours, walls or scores.
  std::optional<std::string> first_inconsistency() const;

 private:
  struct Rim {
    HalfFace across = kNone;
    Wall wall = 0;
  };
  /// Faces that wait for the other of their two sides: open addressing, emptied by a count of its uses.
  class OpenFaces {
   public:
    /// Room for so many.
    void reset(std::size_t faces);
    /// Takes the face out, and says so, or puts it in with this.
    bool take_or_put(const Triangle& corners, const Rim& put, Rim& taken);

   private:
    struct Slot {
      Triangle key;
      std::uint32_t use = 0;
      bool waits = false;
      Rim rim;
    };
    std::vector<Slot> slots_;
    std::uint32_t use_ = 0;
    int shift_ = 0;
  };

  void connect();
  void tie(TetIndex t);
  TetIndex slot();

  OpenFaces rim_;
  std::vector<TetIndex> created_;
};

}  // namespace octafront::adapt
