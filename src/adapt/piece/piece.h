#pragma once

// adapt/piece: a part of a mesh that one worker changes all by himself, with its vertices, walls and lines. Pieces are
// taken from a mesh of parts by cells of space, changed, and put together again; what lies on their rims stays.

#include <octafront/tet_mesh.h>

#include "adapt/metric/metric.h"
#include "base/core/flat_map.h"
#include "base/mesh/tet_complex.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront::adapt {

/// How free a vertex is.
enum class Kind : std::uint8_t { kInner, kSurface, kCurve, kFixed };

struct Vertex {
  Vec3 at;
  Metric metric;
  double density = 1;        ///< density_of(metric)
  std::uint32_t id = kNone;  ///< in the mesh that was given; kNone: new
  std::uint32_t hint = 0;    ///< where the metric was looked up (MetricField::at)
  Kind kind = Kind::kInner;
  bool rim = false;     ///< of a piece: some of its tets are not there, so it stays
  bool active = true;   ///< something may be left to do around it
  bool exact = true;    ///< the metric is that of the place, not one on the way to it
  bool frozen = false;  ///< asked to stay as it is, with all that is between vertices that are
};

/// The label of a half-face that lies on a wall, else 0: one more than the number of the part, and kOuter where nothing
/// lies across.
using Wall = std::uint32_t;
inline constexpr Wall kOuter = 0x80000000u;

/// What lies across outer walls, and across the rim of a piece.
inline constexpr HalfFace kOutside = kFirstOutside, kBeyondRim = kFirstOutside + 1;

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
};

/// The tets of a Parts that one worker may change, and those vertices, walls and lines that they have.
class Piece {
 public:
  /// Takes these tets; `here` has kNone for each vertex of the mesh, and has it again afterwards.
  Piece(const Parts& mesh, std::span<const TetIndex> tets, std::span<const Parts::Line> lines,
        std::vector<VertexIndex>& here);

  std::vector<Vertex> vertices;
  TetComplex complex;
  std::vector<std::uint32_t> region;  ///< per slot
  std::vector<Wall> wall;             ///< per half-face
  std::vector<float> score;           ///< per slot: metric_score()

  const Tet& tet(TetIndex t) const { return complex.tets[t]; }
  Vec3 point(VertexIndex v) const { return vertices[v].at; }
  /// The path of the line that the edge lies on; nullptr: none.
  const std::uint32_t* line(VertexIndex a, VertexIndex b) const { return lines_.find(sorted_edge(a, b)); }
  void set_line(VertexIndex a, VertexIndex b, std::uint32_t path) { lines_.find_or_add(sorted_edge(a, b)) = path; }
  void drop_line(VertexIndex a, VertexIndex b) { lines_.erase(sorted_edge(a, b)); }

  double edge_length(VertexIndex a, VertexIndex b) const {
    const Vertex &p = vertices[a], &q = vertices[b];
    return metric_length(q.at - p.at, p.metric, q.metric);
  }
  /// The score of a tet on these vertices, exactly 0 or below if it is not positive by exact sign.
  float score_of(const Tet& t) const { return score_with(t, kNone, Vertex{}); }
  /// The same with another place and metric of vertex v.
  float score_with(const Tet& t, VertexIndex v, const Vertex& as) const;

  /// The tets around v, of those in the piece. Valid until the next call.
  const std::vector<TetIndex>& star(VertexIndex v) { return complex.star(v); }
  /// The tets around the edge (a, b) of t, from one wall or rim to the other if there are any. False if tets beyond the
  /// rim may be around it too.
  bool ring(TetIndex t, VertexIndex a, VertexIndex b, EdgeRing& out) const;
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

  /// Moves a vertex whose star is given, with the scores there.
  void move(VertexIndex v, const Vertex& to, std::span<const TetIndex> star, std::span<const float> scores);

  std::vector<Parts::Line> lines() const;

  /// What is wrong with neighbours, walls or scores.
  std::optional<std::string> first_inconsistency() const;

 private:
  struct Rim {
    HalfFace across = kNone;
    Wall wall = 0;
    bool open = false;
  };

  void connect();
  void toggle(const Triangle& corners, HalfFace across, Wall wall);
  void tie(TetIndex t);
  TetIndex slot();

  FlatMap<Edge, std::uint32_t> lines_;
  FlatMap<Triangle, Rim> rim_;
  std::vector<TetIndex> created_;
};

}  // namespace octafront::adapt
