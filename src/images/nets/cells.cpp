#include "images/nets/cells.h"

#include "base/core/parallel.h"
#include "images/nets/lattice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

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

/// A wall between voxels, and the signed ways to the middles of those below and above.
struct Wall {
  double to_below, to_above;
  double half_over_below, half_over_above;  ///< a half over each way
};

std::vector<Wall> walls_of(const Lattice& lattice, int axis) {
  std::vector<Wall> walls;
  for (std::int32_t i = 0; i <= lattice.size(axis); ++i) {
    const double at = lattice.wall(axis, i);
    const double below = lattice.middle(axis, i - 1) - at, above = lattice.middle(axis, i) - at;
    walls.push_back({below, above, 0.5 / below, 0.5 / above});
    Corner c{};
    c[axis] = i;
    if (lattice.on_box(c, axis)) walls[i].to_below = walls[i].to_above = 0;
  }
  return walls;
}

struct HashOfRoom {
  std::size_t operator()(const VertexCells::Room& room) const {
    std::uint64_t hash = 0;
    for (const Vec3& p : {room.lo, room.hi, room.half_over_below, room.half_over_above})
      for (int a = 0; a < 3; ++a)
        hash = (hash ^ std::bit_cast<std::uint64_t>(p[a])) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return hash;
  }
};

/// Part of the way to the middles on one side of a corner that keeps layers apart.
float share_between_layers(const Lattice& lattice, const Corner& c, int axis, int side, bool joins_three) {
  for (int o = 0; o < 4; ++o) {
    Corner voxel;
    voxel[axis] = c[axis] - 1 + side;
    voxel[(axis + 1) % 3] = c[(axis + 1) % 3] - (o & 1);
    voxel[(axis + 2) % 3] = c[(axis + 2) % 3] - (o >> 1);
    if (is_layer(lattice, voxel, axis)) return joins_three ? kRoomAtLines : kRoomInLayers;
  }
  return kMostRoom;
}

/// Less room at labels of few voxels.
template <class Shares>
void narrow_at_small(const Net& net, std::span<const std::uint64_t> voxels, Shares& shares) {
  std::vector<float> of_label(voxels.size());
  std::transform(voxels.begin(), voxels.end(), of_label.begin(), room_of);
  if (std::find_if(of_label.begin(), of_label.end(), [](float s) { return s < kMostRoom; }) == of_label.end()) return;
  for (const Quad& q : net.quads)
    for (const Label label : {q.lower, q.upper})
      if (label != LabelImage::kNoRegion && of_label[label] < kMostRoom)
        for (const VertexIndex v : q.v)
          for (auto& sides : shares[v])
            for (float& share : sides) share = std::min(share, of_label[label]);
}

}  // namespace

VertexCells::VertexCells(const Lattice& lattice, const Net& net, const Shares& shares)
    : farthest_(HUGE_VAL), net_(net) {
  number_rooms(lattice, shares);
}

VertexCells::VertexCells(const Lattice& lattice, const Net& net)
    : VertexCells(lattice, net, shares_between_layers(lattice, net)) {}

VertexCells VertexCells::without_layers(const Lattice& lattice, const Net& net) {
  Shares::value_type all;
  for (auto& sides : all) sides.fill(kMostRoom);
  return {lattice, net, Shares(net.corner.size(), all)};
}

VertexCells::VertexCells(const Lattice& lattice, const Net& net, std::span<const std::uint64_t> voxels)
    : farthest_(kFarthest), net_(net) {
  Shares shares = shares_between_layers(lattice, net);
  narrow_at_small(net, voxels, shares);
  number_rooms(lattice, shares);
}

VertexCells::Shares VertexCells::shares_between_layers(const Lattice& lattice, const Net& net) {
  Shares shares(net.corner.size());
  parallel_for(shares.size(), [&](std::size_t v) {
    const Corner& c = net.corner[v];
    const bool joins_three = label_count(octants_at(lattice, c)) > 2;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side)
        shares[v][axis][side] = share_between_layers(lattice, c, axis, side, joins_three);
  });
  return shares;
}

void VertexCells::number_rooms(const Lattice& lattice, const Shares& shares) {
  std::array<std::vector<Wall>, 3> walls;
  for (int a = 0; a < 3; ++a) {
    walls[a] = walls_of(lattice, a);
    for (std::int32_t i = 0; i <= lattice.size(a); ++i) wall_[a].push_back(lattice.wall(a, i));
  }
  std::unordered_map<Room, std::uint32_t, HashOfRoom> numbers;
  room_of_.resize(shares.size());
  for (std::size_t v = 0; v < shares.size(); ++v) {
    Room room;
    for (int a = 0; a < 3; ++a) {
      const Wall& wall = walls[a][static_cast<std::size_t>(net_.corner[v][a])];
      const auto [below, above] = shares[v][a];
      room.lo[a] = below * wall.to_below;
      room.hi[a] = above * wall.to_above;
      room.half_over_below[a] = wall.half_over_below;
      room.half_over_above[a] = wall.half_over_above;
    }
    const auto [at, is_new] = numbers.try_emplace(room, static_cast<std::uint32_t>(rooms_.size()));
    if (is_new) rooms_.push_back(room);
    room_of_[v] = at->second;
  }
}

Vec3 VertexCells::clamped(VertexIndex v, Vec3 p) const {
  const Vec3 from = corner(v);
  const Room& room = rooms_[room_of_[v]];
  // No branches: which side a vertex moves to nobody can foresee.
  const Vec3 move = min(max(p - from, room.lo), room.hi);
  double squared_way = 0;  // in voxels
  for (int a = 0; a < 3; ++a) {
    const double way = std::max(move[a] * room.half_over_below[a], move[a] * room.half_over_above[a]);
    squared_way += way * way;
  }
  if (squared_way <= farthest_ * farthest_) return from + move;
  return from + move * (farthest_ / std::sqrt(squared_way));
}

}  // namespace octafront::nets
