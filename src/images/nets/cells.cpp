#include "images/nets/cells.h"

#include "base/core/parallel.h"
#include "images/nets/fans.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace octafront::nets {

namespace {

// A slope passes up to half a voxel from the terraces that it becomes, and must have room for that; but vertices that
// reach the wall of their cell could meet their neighbours there.
constexpr float kMostRoom = 0.998f;

// The corners of the box, .87 voxels away, are middles of voxels: a surface that elements draw a little off it would
// have them on the wrong side. Balls are as round and terraces as sloped with .79 as with all of the box, not with .76.
constexpr double kFarthest = 0.79;

// Layers stay half a voxel thick; where three labels meet each has an edge, which may be thinner: at .5 lines of
// three labels lay .29 voxels off, at .75 .20, and
// none of both .16.
constexpr float kRoomInLayers = 0.5f, kRoomAtLines = 0.75f;

struct RoomBySize {
  std::uint64_t voxels;
  float share;
};
constexpr RoomBySize kRoom[] = {{8, 0.35f}, {27, 0.6f}};

float room_of(std::uint64_t voxels) {
  for (const RoomBySize& r : kRoom)
    if (voxels < r.voxels) return r.share;
  return kMostRoom;
}

int label_count(Octants octants) {
  std::sort(octants.begin(), octants.end());
  return static_cast<int>(std::unique(octants.begin(), octants.end()) - octants.begin());
}

/// Whether other labels lie on both sides of a voxel.
bool is_layer(const Lattice& lattice, Corner voxel, int axis) {
  const Label label = lattice.label(voxel);
  Corner before = voxel, behind = voxel;
  --before[axis];
  ++behind[axis];
  return lattice.label(before) != label && lattice.label(behind) != label;
}

}  // namespace

VertexCells::VertexCells(const Lattice& lattice, const Net& net)
    : farthest_(HUGE_VAL), net_(net), share_(net.corner.size()) {
  for (int a = 0; a < 3; ++a)
    for (std::int32_t i = 0; i <= lattice.size(a); ++i) {
      const double at = lattice.wall(a, i), below = lattice.middle(a, i - 1) - at, above = lattice.middle(a, i) - at;
      walls_[a].push_back({at, below, above, 0.5 / below, 0.5 / above});
    }
  // Flat on the image's box.
  for (int a = 0; a < 3; ++a)
    for (std::int32_t i = 0; i <= lattice.size(a); ++i)
      if (Corner c{}; c[a] = i, lattice.on_box(c, a)) walls_[a][i].to_below = walls_[a][i].to_above = 0;
  parallel_for(net.corner.size(), [&](std::size_t v) { keep_layers_apart(lattice, static_cast<VertexIndex>(v)); });
}

VertexCells::VertexCells(const Lattice& lattice, const Net& net, std::span<const std::uint64_t> voxels)
    : VertexCells(lattice, net) {
  farthest_ = kFarthest;
  std::vector<float> of_label(voxels.size());
  std::transform(voxels.begin(), voxels.end(), of_label.begin(), room_of);
  if (std::find_if(of_label.begin(), of_label.end(), [](float s) { return s < kMostRoom; }) == of_label.end()) return;
  for (const Quad& q : net.quads)
    for (const Label label : {q.lower, q.upper})
      if (label != LabelImage::kNoRegion && of_label[label] < kMostRoom)
        for (const VertexIndex v : q.v)
          for (auto& sides : share_[v])
            for (float& share : sides) share = std::min(share, of_label[label]);
}

void VertexCells::keep_layers_apart(const Lattice& lattice, VertexIndex v) {
  const Corner& c = net_.corner[v];
  const bool joins_three = label_count(octants_at(lattice, c)) > 2;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      float& share = share_[v][axis][side];
      share = kMostRoom;
      for (int o = 0; o < 4; ++o) {
        Corner voxel;
        voxel[axis] = c[axis] - 1 + side;
        voxel[(axis + 1) % 3] = c[(axis + 1) % 3] - (o & 1);
        voxel[(axis + 2) % 3] = c[(axis + 2) % 3] - (o >> 1);
        if (is_layer(lattice, voxel, axis)) share = joins_three ? kRoomAtLines : kRoomInLayers;
      }
    }
}

Vec3 VertexCells::clamped(VertexIndex v, Vec3 p) const {
  const Corner& c = net_.corner[v];
  Vec3 corner;
  double squared_way = 0;  // in voxels
  for (int a = 0; a < 3; ++a) {
    const Wall& wall = walls_[a][static_cast<std::size_t>(c[a])];
    const auto [below, above] = share_[v][a];
    // No branches: which side a vertex moves to nobody can foresee.
    const double move = std::min(std::max(p[a] - wall.at, below * wall.to_below), above * wall.to_above);
    const double way = std::max(move * wall.half_over_below, move * wall.half_over_above);
    squared_way += way * way;
    corner[a] = wall.at;
    p[a] = move;
  }
  if (squared_way <= farthest_ * farthest_) return corner + p;
  return corner + p * (farthest_ / std::sqrt(squared_way));
}

}  // namespace octafront::nets
