#pragma once

#include "images/nets/lattice.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace octafront::nets {

/// The corners at which voxels of different labels meet, numbered along i, then j, then k. A bit for each corner of the
/// lattice, and for each 64 of them how many come before.
class CornerSet {
 public:
  explicit CornerSet(const Lattice& lattice);

  std::uint32_t size() const { return before_.back(); }
  /// REQUIRES a corner of the set.
  std::uint32_t number(const Corner& c) const {
    const std::size_t word = first_word(c[1], c[2]) + static_cast<std::size_t>(c[0]) / 64;
    const std::uint64_t below = (std::uint64_t{1} << (c[0] % 64)) - 1;
    return before_[word] + static_cast<std::uint32_t>(std::popcount(bits_[word] & below));
  }
  /// All of them, by number.
  std::vector<Corner> corners() const;

 private:
  std::size_t first_word(std::int32_t y, std::int32_t z) const {
    return words_ * (static_cast<std::size_t>(y) + rows_ * static_cast<std::size_t>(z));
  }
  std::size_t words_, rows_, planes_;  ///< words in a row along i, rows in a plane
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint32_t> before_;  ///< one per word and one more
};

}  // namespace octafront::nets
