#pragma once

// images/labels: images of whole numbers: labels told from grey values, cleaned of specks and holes, closed,
// resampled. Takes and leaves images.

#include <octafront/image.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace octafront::image {

/// Voxels of one region side by side along i.
struct Run {
  std::uint32_t begin = 0, end = 0;  ///< i of the first one, and behind the last one
  std::uint16_t region = 0;
};

/// An image as runs, and the pieces that they form with neighbours across faces. Pieces are numbered by their first
/// voxel.
class Runs {
 public:
  Runs(const std::array<std::uint32_t, 3>& size, const std::vector<std::uint16_t>& regions);

  std::size_t rows() const { return first_.size() - 1; }
  /// The runs of row j + nj k are those from first(row) to first(row + 1).
  std::size_t first(std::size_t row) const { return first_[row]; }
  const Run& run(std::size_t r) const { return runs_[r]; }
  std::size_t size() const { return runs_.size(); }

  /// Calls visit(r, s, n) for runs r < s of neighbouring rows that have n voxels side by side.
  template <class Visit>
  void for_each_contact(const Visit& visit) const {
    for (std::size_t row = 0; row < rows(); ++row) {
      if (row % size_[1] + 1 < size_[1]) meet(row, row + 1, visit);
      if (row + size_[1] < rows()) meet(row, row + size_[1], visit);
    }
  }

  /// The piece of each run.
  const std::vector<std::uint32_t>& piece() const { return piece_; }
  std::uint32_t pieces() const { return pieces_; }

 private:
  template <class Visit>
  void meet(std::size_t a, std::size_t b, const Visit& visit) const {
    std::size_t r = first_[a], s = first_[b];
    while (r < first_[a + 1] && s < first_[b + 1]) {
      const std::uint32_t lo = std::max(runs_[r].begin, runs_[s].begin), hi = std::min(runs_[r].end, runs_[s].end);
      if (lo < hi) visit(r, s, hi - lo);
      ++(runs_[r].end <= runs_[s].end ? r : s);
    }
  }

  void find_runs(const std::vector<std::uint16_t>& regions);
  void find_pieces();

  std::array<std::uint32_t, 3> size_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_;  ///< per row, and the end
  std::vector<std::uint32_t> piece_;
  std::uint32_t pieces_ = 0;
};

}  // namespace octafront::image
