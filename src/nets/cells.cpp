#include "nets/cells.h"

#include "core/parallel.h"

#include <algorithm>
#include <limits>

namespace octafront::nets {

namespace {

// A slope passes up to half a voxel from the terraces that it becomes, and must have room for that; but vertices that
// reach the wall of their cell could meet their neighbours there.
constexpr float kMostRoom = 0.998f;

struct RoomBySize {
  std::uint64_t voxels;
  float share;
};
constexpr RoomBySize kRoom[] = {{8, 0.35f}, {27, 0.6f}, {64, 0.8f}};

float room_of(std::uint64_t voxels) {
  for (const RoomBySize& r : kRoom)
    if (voxels < r.voxels) return r.share;
  return kMostRoom;
}

}  // namespace

VertexCells::VertexCells(const Lattice& lattice, const Net& net, std::span<const std::uint64_t> voxels)
    : lattice_(lattice), net_(net), share_(net.corner.size(), kMostRoom) {
  std::vector<float> of_label(voxels.size());
  std::transform(voxels.begin(), voxels.end(), of_label.begin(), room_of);
  if (std::find_if(of_label.begin(), of_label.end(), [](float s) { return s < kMostRoom; }) == of_label.end()) return;
  for (const Quad& q : net.quads)
    for (const Label label : {q.lower, q.upper})
      if (label != LabelImage::kNoRegion && of_label[label] < kMostRoom)
        for (const VertexIndex v : q.v) share_[v] = std::min(share_[v], of_label[label]);
}

Vec3 VertexCells::clamped(VertexIndex v, Vec3 p) const {
  const Corner& c = net_.corner[v];
  for (int a = 0; a < 3; ++a) {
    const double wall = lattice_.wall(a, c[a]);
    if (lattice_.on_box(c, a)) {
      p[a] = wall;
      continue;
    }
    const double share = share_[v];
    p[a] = std::clamp(p[a], wall + share * (lattice_.middle(a, c[a] - 1) - wall),
                      wall + share * (lattice_.middle(a, c[a]) - wall));
  }
  return p;
}

}  // namespace octafront::nets
