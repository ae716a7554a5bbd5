#include "soup/cells/side_graph.h"

#include "base/core/disjoint_sets.h"
#include "base/geometry/predicates.h"
#include "base/mesh/edge_table.h"

namespace octafront::cells {
namespace {

/// The triangles around one edge, in the order in which a turn about it meets them.
class Turn {
 public:
  Turn(std::span<const Vec3> points, std::span<const Triangle> triangles, Edge edge)
      : points_(points), triangles_(triangles), edge_(edge) {}

  /// Sorts half-edges along the edge.
  void sort(std::vector<HalfEdge>& around) const {
    if (around.size() < 3) return;
    const HalfEdge first = around.front();
    std::sort(around.begin() + 1, around.end(), [&](HalfEdge a, HalfEdge b) {
      const int side_a = side(first, a), side_b = side(first, b);
      if (side_a != side_b) return rank(side_a) < rank(side_b);
      return side(a, b) > 0;
    });
  }

  /// The side of the triangle that a turn leaves it from.
  Side leaving(HalfEdge h) const { return start_of(triangles_, h) == edge_[0] ? front_of(h / 3) : behind(h / 3); }

 private:
  Vec3 apex(HalfEdge h) const { return points_[start_of(triangles_, previous_of(h))]; }
  int side(HalfEdge a, HalfEdge b) const { return orient3d(points_[edge_[0]], points_[edge_[1]], apex(a), apex(b)); }
  /// Within half a turn, opposite, beyond.
  static int rank(int side) { return side > 0 ? 0 : side == 0 ? 1 : 2; }

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  Edge edge_;
};

}  // namespace

SideGraph make_side_graph(std::span<const Vec3> points, std::span<const Triangle> triangles,
                          const RunContext& context) {
  const EdgeTable table = make_edge_table(points.size(), triangles, context);
  SideGraph graph;
  graph.next.resize(2 * triangles.size());
  DisjointSets piece(triangles.size());
  std::vector<HalfEdge> around;
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (e % 4096 == 0) context.check();
    around.assign(table.uses(e).begin(), table.uses(e).end());
    const Turn turn(points, triangles, table.edges[e]);
    turn.sort(around);
    for (std::size_t k = 0; k < around.size(); ++k) {
      const HalfEdge h = around[k], g = around[(k + 1) % around.size()];
      const Side from = turn.leaving(h), to = turn.leaving(g) ^ 1u;
      graph.next[from][h % 3] = to;
      graph.next[to][g % 3] = from;
      piece.join(h / 3, g / 3);
    }
  }
  graph.piece.resize(triangles.size());
  std::vector<std::uint32_t> number(triangles.size(), kNone);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    std::uint32_t& n = number[piece.find(t)];
    if (n == kNone) n = graph.pieces++;
    graph.piece[t] = n;
  }
  return graph;
}

}  // namespace octafront::cells
