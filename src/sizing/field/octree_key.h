#pragma once

#include "base/core/morton.h"

#include <array>
#include <bit>
#include <compare>
#include <cstdint>

namespace octafront {

/// A cell of the octree as one integer: its level and its place on the Z-order (Morton) curve.
///
///   bit   63 ... 61   60 ...................................................... 0
///          0  0  0    ddd ddd ddd ... ddd   1   000 000 ... 000
///                     level digits, root    |   three zeros for each level
///                     first, zyx each       |   that the cell is above kMaxLevel
///                                        marker
///
/// Digit k names the child taken on the way from level k - 1 to level k: bit 0 of it is the half along x, bit 1 along
/// y, bit 2 along z. The root has no digits: its id is the marker alone, 1 << 60. Id 0 is no cell.
///
/// Order. Ids are unique over all levels. Cells of one level sort along the curve; the cells inside a cell have ids in
/// [range_min(), range_max()], and its own id lies in the middle of them: children 0-3 before it, 4-7 behind. Leaves
/// that cover the root cube without overlap, sorted by id, are in the order of the curve.
///
/// Coordinates. The root cube has kSide units along each axis; a cell of level l has side kSide >> l. A cell is the
/// half-open box [x, x + side) x [y, y + side) x [z, z + side).
///
/// (The scheme of a level marker behind a curve position is that of S2 cell ids; the curve here is plain Morton order.)
class OctreeKey {
 public:
  static constexpr int kMaxLevel = 20;
  static constexpr std::uint32_t kSide = 1u << kMaxLevel;

  constexpr OctreeKey() = default;
  static constexpr OctreeKey root() { return OctreeKey(std::uint64_t{1} << (3 * kMaxLevel)); }
  static constexpr OctreeKey from_id(std::uint64_t id) { return OctreeKey(id); }
  /// The cell of `level` that contains the unit (x, y, z). REQUIRES: x, y, z < kSide, 0 <= level <= kMaxLevel.
  static constexpr OctreeKey containing(std::uint32_t x, std::uint32_t y, std::uint32_t z, int level = kMaxLevel) {
    const std::uint64_t position = morton_code(x, y, z) << 1 | 1;
    const std::uint64_t marker = marker_of(level);
    return OctreeKey((position & (0 - marker)) | marker);
  }

  constexpr std::uint64_t id() const { return id_; }
  /// True if the id is that of a cell.
  constexpr bool is_valid() const {
    return id_ != 0 && id_ < std::uint64_t{2} << (3 * kMaxLevel) && std::countr_zero(id_) % 3 == 0;
  }
  constexpr int level() const { return kMaxLevel - std::countr_zero(id_) / 3; }
  /// Side in units: kSide >> level().
  constexpr std::uint32_t side() const { return kSide >> level(); }
  /// Lower corner in units.
  constexpr std::array<std::uint32_t, 3> corner() const {
    const std::uint64_t digits = (id_ - marker()) >> 1;
    return {gather_bits(digits), gather_bits(digits >> 1), gather_bits(digits >> 2)};
  }

  /// The cell one level up. REQUIRES: level() > 0.
  constexpr OctreeKey parent() const {
    const std::uint64_t up = marker() << 3;
    return OctreeKey((id_ & (0 - up)) | up);
  }
  /// The cell of `level` that contains this one. REQUIRES: level <= this->level().
  constexpr OctreeKey ancestor(int level) const {
    const std::uint64_t up = marker_of(level);
    return OctreeKey((id_ & (0 - up)) | up);
  }
  /// Child i, with the halves x = i & 1, y = i >> 1 & 1, z = i >> 2. REQUIRES: level() < kMaxLevel.
  constexpr OctreeKey child(int i) const {
    const std::uint64_t m = marker();
    return OctreeKey(id_ - m + (2 * static_cast<std::uint64_t>(i) + 1) * (m >> 3));
  }
  /// Which child of its parent it is. REQUIRES: level() > 0.
  constexpr int child_number() const { return static_cast<int>(id_ / (marker() << 1) & 7); }

  /// Least and greatest id of the cells inside, itself included.
  constexpr std::uint64_t range_min() const { return id_ - (marker() - 1); }
  constexpr std::uint64_t range_max() const { return id_ + (marker() - 1); }
  /// True if `other` is this cell or lies inside it.
  constexpr bool contains(OctreeKey other) const { return range_min() <= other.id_ && other.id_ <= range_max(); }

  /// The cell of the same level `dx, dy, dz` cells away; an invalid key (id 0) outside the root cube. REQUIRES: each is
  /// -1, 0 or 1.
  constexpr OctreeKey neighbour(int dx, int dy, int dz) const {
    // Digits are added where they lie: the bits of the other axes are filled, so that carries run over them.
    std::uint64_t beside = marker();
    const std::array<int, 3> steps{dx, dy, dz};
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t bits = kBitsOfX << axis, mine = id_ & ~marker() & bits, one = marker() << 1 << axis;
      const std::uint64_t above = ((mine | ~bits) + one) & bits, below = (mine - one) & bits;
      if (steps[axis] > 0 && above <= mine) return OctreeKey();
      if (steps[axis] < 0 && below >= mine) return OctreeKey();
      beside |= steps[axis] == 0 ? mine : steps[axis] > 0 ? above : below;
    }
    return OctreeKey(beside);
  }

  friend constexpr bool operator==(OctreeKey, OctreeKey) = default;
  friend constexpr auto operator<=>(OctreeKey, OctreeKey) = default;

 private:
  /// Of the digits of all levels.
  static constexpr std::uint64_t kBitsOfX = 0x492492492492492;  // 1, 4 ... 3 kMaxLevel - 2

  constexpr explicit OctreeKey(std::uint64_t id) : id_(id) {}
  constexpr std::uint64_t marker() const { return id_ & (0 - id_); }
  static constexpr std::uint64_t marker_of(int level) { return std::uint64_t{1} << (3 * (kMaxLevel - level)); }

  std::uint64_t id_ = 0;
};

}  // namespace octafront
