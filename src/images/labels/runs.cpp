#include "images/labels/runs.h"

#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"

namespace octafront::image {

Runs::Runs(const std::array<std::uint32_t, 3>& size, const std::vector<std::uint16_t>& regions) : size_(size) {
  find_runs(regions);
  find_pieces();
}

void Runs::find_runs(const std::vector<std::uint16_t>& regions) {
  const std::size_t ni = size_[0], rows = std::size_t{size_[1]} * size_[2];
  // Both passes go through each row alike.
  const auto for_each_run = [&](std::size_t row, const auto& visit) {
    const std::uint16_t* const r = regions.data() + row * ni;
    for (std::uint32_t i = 0; i < ni;) {
      const std::uint32_t begin = i;
      while (i < ni && r[i] == r[begin]) ++i;
      visit(Run{begin, i, r[begin]});
    }
  };
  first_.assign(rows + 1, 0);
  parallel_for(rows, [&](std::size_t row) { for_each_run(row, [&](const Run&) { ++first_[row + 1]; }); });
  for (std::size_t row = 0; row < rows; ++row) first_[row + 1] += first_[row];
  runs_.resize(first_[rows]);
  parallel_for(rows, [&](std::size_t row) {
    std::size_t at = first_[row];
    for_each_run(row, [&](const Run& run) { runs_[at++] = run; });
  });
}

void Runs::find_pieces() {
  DisjointSets sets(runs_.size());
  for_each_contact([&](std::size_t r, std::size_t s, std::uint32_t) {
    if (runs_[r].region == runs_[s].region) sets.join(static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(s));
  });
  piece_.resize(runs_.size());
  for (std::uint32_t r = 0; r < runs_.size(); ++r) {
    const std::uint32_t root = sets.find(r);  // the least: it has its number already
    piece_[r] = root == r ? pieces_++ : piece_[root];
  }
}

}  // namespace octafront::image
