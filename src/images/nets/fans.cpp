#include "images/nets/lattice.h"

namespace octafront::nets {

Octants octants_at(const Lattice& lattice, const Corner& c) {
  Octants octants;
  for (int o = 0; o < 8; ++o)
    octants[o] = lattice.label(c[0] - 1 + (o & 1), c[1] - 1 + (o >> 1 & 1), c[2] - 1 + (o >> 2 & 1));
  return octants;
}

namespace {

/// The four voxels around half an edge of the lattice, in turn, and the faces between each and the next.
struct Spokes {
  std::array<Label, 4> label;
  std::array<int, 4> slot;

  Spokes(const Octants& octants, int axis, int side) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    constexpr int kTurn[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 4; ++i) label[i] = octants[side << axis | kTurn[i][0] << next | kTurn[i][1] << last];
    slot = {slot_of(next, 0, side), slot_of(last, side, 1), slot_of(next, 1, side), slot_of(last, side, 0)};
  }
  bool has_face(int i) const { return label[i] != label[(i + 1) % 4]; }
};

enum class Join { kAll, kEven, kOdd };

/// Which of two labels is the rarer around an edge: in the voxels beside it and the next ones along it.
bool is_rarer(const Lattice& lattice, const Corner& c, int axis, int side, Label a, Label b) {
  Corner voxel;
  int more = 0;  // of a than of b
  for (int o = 0; o < 12; ++o) {
    voxel[axis] = c[axis] - 2 + side + o / 4;
    voxel[(axis + 1) % 3] = c[(axis + 1) % 3] - 1 + (o & 1);
    voxel[(axis + 2) % 3] = c[(axis + 2) % 3] - 1 + (o >> 1 & 1);
    const Label label = lattice.label(voxel);
    more += (label == a) - (label == b);
  }
  return more < 0 || (more == 0 && a < b);
}

Join join_at(const Lattice& lattice, const Corner& c, int axis, int side, const Spokes& s) {
  for (int i = 0; i < 4; ++i)
    if (!s.has_face(i)) return Join::kAll;
  const bool even = s.label[0] == s.label[2], odd = s.label[1] == s.label[3];
  if (even && odd) return is_rarer(lattice, c, axis, side, s.label[0], s.label[1]) ? Join::kEven : Join::kOdd;
  return even ? Join::kEven : odd ? Join::kOdd : Join::kAll;
}

}  // namespace

Fans::Fans(const Lattice& lattice, const Corner& c, const Octants& octants) {
  of_slot.fill(kNoFace);
  std::array<std::uint8_t, 12> group;
  for (int i = 0; i < 12; ++i) group[i] = static_cast<std::uint8_t>(i);
  const auto join = [&](int s, int t) {
    const std::uint8_t from = group[s], to = group[t];
    for (std::uint8_t& g : group)
      if (g == from) g = to;
  };
  std::array<bool, 12> present{};
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const Spokes s(octants, axis, side);
      const Join rule = join_at(lattice, c, axis, side, s);
      int last = -1;
      for (int i = 0; i < 4; ++i) {
        if (!s.has_face(i)) continue;
        present[s.slot[i]] = true;
        if (rule == Join::kAll && last >= 0) join(s.slot[i], last);
        last = s.slot[i];
      }
      // The faces around voxel i are those before and behind it.
      if (rule == Join::kEven) join(s.slot[0], s.slot[1]), join(s.slot[2], s.slot[3]);
      if (rule == Join::kOdd) join(s.slot[1], s.slot[2]), join(s.slot[3], s.slot[0]);
    }
  std::array<std::uint8_t, 12> number;
  number.fill(kNoFace);
  for (int i = 0; i < 12; ++i) {
    if (!present[i]) continue;
    if (number[group[i]] == kNoFace) number[group[i]] = static_cast<std::uint8_t>(count++);
    of_slot[i] = number[group[i]];
  }
}

Vec3 Fans::way_out(const Lattice& lattice, const Corner& c, int group) const {
  Vec3 sum;
  int faces = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int sides = 0; sides < 4; ++sides) {
      if (of_slot[4 * axis + sides] != group) continue;
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      const auto half = [&](int a, int side) {
        const std::int32_t other = c[a] + (side != 0 ? 1 : -1);
        return other < 0 || other > lattice.size(a) ? 0 : (lattice.wall(a, other) - lattice.wall(a, c[a])) / 2;
      };
      sum[next] += half(next, sides & 1);
      sum[last] += half(last, sides >> 1);
      ++faces;
    }
  for (int a = 0; a < 3; ++a)
    if (lattice.on_box(c, a)) sum[a] = 0;
  return sum / faces;
}

}  // namespace octafront::nets
