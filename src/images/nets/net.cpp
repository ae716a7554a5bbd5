#include "images/nets/net.h"

#include "base/core/parallel.h"
#include "images/nets/corner_set.h"
#include "images/nets/fans.h"

#include <algorithm>

namespace octafront::nets {

namespace {

constexpr std::size_t kRange = 16384;  // corners for a thread at a time

/// A corner with several vertices: that of group 0 has the corner's number, the others follow `extra`.
struct SharedCorner {
  std::uint32_t corner;
  Fans fans;
  VertexIndex extra = 0;
};

class Builder {
 public:
  explicit Builder(const Lattice& lattice) : lattice_(lattice), set_(lattice) { net_.corner = set_.corners(); }

  Net build() && {
    find_shared_corners();
    place_vertices();
    net_.quads = parallel_collect<Quad>(set_.size(), kRange, [&](std::size_t begin, std::size_t end, auto& out) {
      for (std::size_t c = begin; c < end; ++c)
        for (int axis = 0; axis < 3; ++axis) add_quad(net_.corner[c], axis, out);
    });
    return std::move(net_);
  }

 private:
  void find_shared_corners() {
    shared_ = parallel_collect<SharedCorner>(set_.size(), kRange, [&](std::size_t begin, std::size_t end, auto& out) {
      for (std::size_t c = begin; c < end; ++c) {
        const Fans fans(lattice_, net_.corner[c], octants_at(lattice_, net_.corner[c]));
        if (fans.count > 1) out.push_back({static_cast<std::uint32_t>(c), fans});
      }
    });
    VertexIndex next = set_.size();
    for (SharedCorner& s : shared_) {
      s.extra = next;
      next += static_cast<VertexIndex>(s.fans.count - 1);
    }
    vertices_ = next;
  }

  static VertexIndex vertex(const SharedCorner& s, int group) {
    return group == 0 ? s.corner : s.extra + static_cast<VertexIndex>(group - 1);
  }

  void place_vertices() {
    net_.corner.resize(vertices_);
    net_.start.resize(vertices_);
    net_.shares_corner.assign(vertices_, 0);
    parallel_for(set_.size(), [&](std::size_t c) { net_.start[c] = lattice_.at(net_.corner[c]); });
    for (const SharedCorner& s : shared_) {
      const Corner c = net_.corner[s.corner];
      for (int group = 0; group < s.fans.count; ++group) {
        const VertexIndex v = vertex(s, group);
        net_.corner[v] = c;
        net_.start[v] = lattice_.at(c) + s.fans.way_out(lattice_, c, group);
        net_.shares_corner[v] = 1;
      }
    }
  }

  void add_quad(const Corner& c, int axis, std::vector<Quad>& out) const {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    if (c[next] == lattice_.size(next) || c[last] == lattice_.size(last)) return;
    Corner below = c;
    --below[axis];
    Quad q{{}, lattice_.label(below), lattice_.label(c), static_cast<std::uint8_t>(axis)};
    if (q.lower == q.upper) return;
    if (lattice_.on_box(c, axis)) q.box = static_cast<std::uint8_t>(1 + 2 * axis + (c[axis] != 0));
    // Of each corner: on which side of it the quad lies, along the next axis and the last.
    constexpr int kSide[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
    for (int i = 0; i < 4; ++i) {
      Corner at = c;
      at[next] += 1 - kSide[i][0];
      at[last] += 1 - kSide[i][1];
      q.v[i] = vertex_at(at, slot_of(axis, kSide[i][0], kSide[i][1]));
    }
    out.push_back(q);
  }

  VertexIndex vertex_at(const Corner& c, int slot) const {
    const std::uint32_t number = set_.number(c);
    if (!net_.shares_corner[number]) return number;
    const auto s = std::lower_bound(shared_.begin(), shared_.end(), number,
                                    [](const SharedCorner& a, std::uint32_t b) { return a.corner < b; });
    return vertex(*s, s->fans.of_slot[slot]);
  }

  const Lattice& lattice_;
  CornerSet set_;
  std::vector<SharedCorner> shared_;  // ascending
  VertexIndex vertices_ = 0;
  Net net_;
};

}  // namespace

Net make_net(const Lattice& lattice) {
  return Builder(lattice).build();
}

Groups<> quads_at_vertices(const Net& net) {
  return {net.corner.size(), [&](const auto& add) {
            for (std::uint32_t q = 0; q < net.quads.size(); ++q)
              for (const VertexIndex v : net.quads[q].v) add(v, q);
          }};
}

}  // namespace octafront::nets
