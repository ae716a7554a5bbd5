#pragma once

#include "images/nets/lattice.h"

#include <array>
#include <cstdint>

namespace octafront::nets {

/// The labels of the eight voxels around a corner: bit a of the index is set for those on the upper side along axis a.
using Octants = std::array<Label, 8>;
Octants octants_at(const Lattice& lattice, const Corner& c);

/// The twelve faces of voxels at a corner: the one that lies across `axis`, on the upper side (1) or the lower one
/// along the next axis and the one after.
constexpr int slot_of(int axis, int next_side, int last_side) {
  return 4 * axis + next_side + 2 * last_side;
}

/// The faces between different labels at a corner, grouped by what hangs together: a vertex of the net for each group.
///
/// Faces hang together over the lattice's edges. Where voxels a, b, a, c lie around an edge, the two a hang together
/// across it, and two surfaces pass it: one around b, one around c. Of a, b, a, b those join that are fewer around the
/// edge, or else have the lower label.
struct Fans {
  static constexpr std::uint8_t kNoFace = 0xff;
  std::array<std::uint8_t, 12> of_slot;  ///< the group of each face
  int count = 0;

  Fans(const Lattice& lattice, const Corner& c, const Octants& octants);
  /// From the corner to the mean of the middles of a group's faces.
  Vec3 way_out(const Lattice& lattice, const Corner& c, int group) const;
};

}  // namespace octafront::nets
