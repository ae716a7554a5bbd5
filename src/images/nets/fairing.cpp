#include "base/core/parallel.h"
#include "images/nets/net_steps.h"

#include <algorithm>
#include <cmath>

namespace octafront::nets {

namespace {

// What bends over this many voxels takes about as many sweeps times 15: terraces of twenty become slopes.
constexpr int kSweeps = 300;
// One over the norm of the second differences' operator squared: 4 on even nets, somewhat more at curves.
constexpr float kStep = 1 / 4.5f;

/// A way from a corner, in what the compiler maps to the vector unit of any x86-64 or arm64; the last one is 0. Ways in
/// voxels need no more than single precision, half of whose memory traffic is what sweeps cost.
using Way = float __attribute__((vector_size(16)));

Way narrowed(Vec3 p) {
  return Way{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0};
}

Vec3 over_unit(Vec3 p, Vec3 unit) {
  return {p.x / unit.x, p.y / unit.y, p.z / unit.z};
}

Vec3 times_unit(Vec3 p, Vec3 unit) {
  return {p.x * unit.x, p.y * unit.y, p.z * unit.z};
}

/// VertexCells::Room in voxels.
struct Room {
  Way lo, hi, half_over_below, half_over_above;
};

/// The vertices as ways from their corners.
class Sweeps {
 public:
  Sweeps(const Stencils& stencils, const VertexCells& cells, const std::vector<Vec3>& start)
      : cells_(cells), n_(start.size()), x_(n_), ahead_(n_ + 1), weighted_(n_ + 1), vertices_(n_), rows_(n_) {
    // Axes do not mix: each may have a unit of its own.
    for (const VertexCells::Room& room : cells.rooms()) unit_ = max(unit_, room.hi - room.lo);
    for (int a = 0; a < 3; ++a) unit_[a] = unit_[a] > 0 ? unit_[a] : 1;
    for (const VertexCells::Room& room : cells.rooms())
      rooms_.push_back({narrowed(over_unit(room.lo, unit_)), narrowed(over_unit(room.hi, unit_)),
                        narrowed(times_unit(room.half_over_below, unit_)),
                        narrowed(times_unit(room.half_over_above, unit_))});
    parallel_for(n_, [&](std::size_t v) { place(stencils, static_cast<VertexIndex>(v), start[v]); });
    for (VertexIndex v = 0; v < n_; ++v) {
      fill_row(v, stencils.of(v));
      rows_[v].users = v;
      if (std::ranges::equal(stencils.of(v), stencils.users(v))) continue;
      rows_[v].users = static_cast<std::uint32_t>(rows_.size());
      rows_.emplace_back();
      fill_row(rows_.size() - 1, stencils.users(v));
    }
  }

  void sweep(float momentum) {
    parallel_for(n_, [&](std::size_t v) {
      const Vertex& vertex = vertices_[v];
      const float weight = vertex.of_corners[3];
      weighted_[v] = (sum_of(ahead_, v) * weight - ahead_[v] + vertex.of_corners) * weight;
    });
    parallel_for(n_, [&](std::size_t v) {
      const Vertex& vertex = vertices_[v];
      const Way gradient = sum_of(weighted_, rows_[v].users) - weighted_[v] * vertex.size;
      const Way next = clamped(rooms_[vertex.room], ahead_[v] - gradient * kStep);
      ahead_[v] = next + (next - x_[v]) * momentum;
      x_[v] = next;
    });
  }

  Vec3 at(VertexIndex v) const {
    const Vec3 way{x_[v][0], x_[v][1], x_[v][2]};
    return cells_.clamped(v, cells_.corner(v) + times_unit(way, unit_));
  }

 private:
  /// Most stencils are of three to six vertices: what is missing names one that does not move, since which size comes
  /// next nobody can foresee.
  static constexpr int kWidth = 6;
  struct Row {
    std::array<VertexIndex, kWidth> of;
    std::uint32_t next = 0;   ///< where it goes on; 0: nowhere
    std::uint32_t users = 0;  ///< the row of those in whose stencils the vertex is
  };
  struct Vertex {
    Way of_corners;  ///< what its difference were if all vertices lay at their corners; the last: one over `size`
    std::uint32_t room;
    float size;  ///< of its stencil
  };

  void place(const Stencils& stencils, VertexIndex v, Vec3 start) {
    const auto stencil = stencils.of(v);
    Vec3 sum;
    for (const VertexIndex to : stencil) sum += cells_.corner(to) - cells_.corner(v);
    const auto size = static_cast<double>(stencil.size());
    Vertex& vertex = vertices_[v];
    vertex.of_corners = narrowed(over_unit(sum / size, unit_));
    vertex.of_corners[3] = static_cast<float>(1 / size);
    vertex.room = cells_.room_number(v);
    vertex.size = static_cast<float>(size);
    x_[v] = ahead_[v] = narrowed(over_unit(start - cells_.corner(v), unit_));
  }

  void fill_row(std::size_t row, std::span<const VertexIndex> with) {
    rows_[row].of.fill(static_cast<VertexIndex>(n_));
    std::copy_n(with.begin(), std::min<std::size_t>(with.size(), kWidth), rows_[row].of.begin());
    if (with.size() <= kWidth) return;
    const std::size_t next = rows_.size();
    rows_[row].next = static_cast<std::uint32_t>(next);
    rows_.emplace_back();
    fill_row(next, with.subspan(kWidth));
  }

  Way sum_of(const std::vector<Way>& ways, std::size_t row) const {
    const Way* way = ways.data();
    const Row* r = &rows_[row];
    Way sum = ((way[r->of[0]] + way[r->of[1]]) + (way[r->of[2]] + way[r->of[3]])) + (way[r->of[4]] + way[r->of[5]]);
    while (r->next != 0) {
      r = &rows_[r->next];
      for (const VertexIndex v : r->of) sum += way[v];
    }
    return sum;
  }

  Way clamped(const Room& room, Way p) const {
    p = p > room.lo ? p : room.lo;
    p = p < room.hi ? p : room.hi;
    const Way below = p * room.half_over_below, above = p * room.half_over_above;
    const Way way = below > above ? below : above, squares = way * way;
    const float squared_way = squares[0] + squares[1] + squares[2];
    if (squared_way <= squared_farthest_) return p;
    return p * (farthest_ / std::sqrt(squared_way));
  }

  const VertexCells& cells_;
  std::size_t n_;
  Vec3 unit_;
  float farthest_ = static_cast<float>(cells_.farthest()), squared_farthest_ = farthest_ * farthest_;
  std::vector<Way> x_, ahead_, weighted_;  ///< the last of `ahead_` and `weighted_` are of no vertex and stay 0
  std::vector<Room> rooms_;
  std::vector<Vertex> vertices_;
  std::vector<Row> rows_;  ///< the stencils by vertex, then what did not fit into these
};

}  // namespace

void fair(const Stencils& stencils, const VertexCells& cells, std::vector<Vec3>& x, const RunContext& context) {
  Sweeps sweeps(stencils, cells, x);
  double t = 1;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    context.check();
    const double t_next = (1 + std::sqrt(1 + 4 * t * t)) / 2;
    sweeps.sweep(static_cast<float>((t - 1) / t_next));
    t = t_next;
  }
  parallel_for(x.size(), [&](std::size_t v) { x[v] = sweeps.at(static_cast<VertexIndex>(v)); });
}

}  // namespace octafront::nets
