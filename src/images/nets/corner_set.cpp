#include "images/nets/corner_set.h"

#include <octafront/error.h>

#include "base/core/parallel.h"

#include <array>
#include <limits>

namespace octafront::nets {

namespace {

/// The four voxels at one i around a row of corners: their label if they agree.
struct Column {
  bool uniform;
  Label label;
  friend bool operator==(const Column&, const Column&) = default;
};

class Columns {
 public:
  Columns(const Lattice& lattice, std::int32_t y, std::int32_t z)
      : rows_{lattice.row(y - 1, z - 1), lattice.row(y, z - 1), lattice.row(y - 1, z), lattice.row(y, z)} {}

  Column at(std::int32_t i) const {
    const Label a = label(0, i), b = label(1, i), c = label(2, i), d = label(3, i);
    return {a == b && a == c && a == d, a};
  }

 private:
  Label label(int row, std::int32_t i) const { return rows_[row] == nullptr ? LabelImage::kNoRegion : rows_[row][i]; }
  std::array<const Label*, 4> rows_;
};

}  // namespace

CornerSet::CornerSet(const Lattice& lattice)
    : words_(static_cast<std::size_t>(lattice.size(0)) / 64 + 1),
      rows_(static_cast<std::size_t>(lattice.size(1)) + 1),
      planes_(static_cast<std::size_t>(lattice.size(2)) + 1),
      bits_(words_ * rows_ * planes_, 0) {
  parallel_for(rows_ * planes_, [&](std::size_t row) {
    const Columns columns(lattice, static_cast<std::int32_t>(row % rows_), static_cast<std::int32_t>(row / rows_));
    const Column outside{true, LabelImage::kNoRegion};
    Column last = outside;
    for (std::int32_t x = 0; x <= lattice.size(0); ++x) {
      const Column next = x < lattice.size(0) ? columns.at(x) : outside;
      if (!next.uniform || !(next == last))
        bits_[row * words_ + static_cast<std::size_t>(x) / 64] |= std::uint64_t{1} << (x % 64);
      last = next;
    }
  });
  std::uint64_t sum = 0;
  before_.reserve(bits_.size() + 1);
  for (const std::uint64_t word : bits_) {
    before_.push_back(static_cast<std::uint32_t>(sum));
    sum += static_cast<std::uint64_t>(std::popcount(word));
    // Some corners get several vertices, quads are up to three a corner: numbers of both must fit.
    if (sum > std::numeric_limits<std::uint32_t>::max() / 8)
      throw InputError(
          "the labels of this image have more than 500 million corners of voxels between them: that is noise, "
          "or too much for one mesh. Resample or crop the image.");
  }
  before_.push_back(static_cast<std::uint32_t>(sum));
}

std::vector<Corner> CornerSet::corners() const {
  std::vector<Corner> all(size());
  parallel_for(rows_ * planes_, [&](std::size_t row) {
    for (std::size_t w = row * words_; w < (row + 1) * words_; ++w) {
      std::uint32_t next = before_[w];
      for (std::uint64_t bits = bits_[w]; bits != 0; bits &= bits - 1)
        all[next++] = {static_cast<std::int32_t>(64 * (w - row * words_)) + std::countr_zero(bits),
                       static_cast<std::int32_t>(row % rows_), static_cast<std::int32_t>(row / rows_)};
    }
  });
  return all;
}

}  // namespace octafront::nets
