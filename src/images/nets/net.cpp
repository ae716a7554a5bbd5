#include "images/nets/net.h"

#include <octafront/error.h>

#include "base/core/parallel.h"
#include "images/nets/lattice.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

namespace octafront::nets {

namespace {

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

constexpr std::size_t kRange = 16384;  // corners for a thread at a time

/// A corner with several vertices: that of group 0 has the corner's number, the others follow `extra`.
struct SharedCorner {
  std::uint32_t corner;
  Fans fans;
  VertexIndex extra = 0;
};

class Builder {
 public:
  explicit Builder(const Lattice& lattice) : lattice_(lattice), set_(lattice) { net_.corner = set_.corners(); }

  Net build() && {
    find_shared_corners();
    place_vertices();
    net_.quads = parallel_collect<Quad>(set_.size(), kRange, [&](std::size_t begin, std::size_t end, auto& out) {
      for (std::size_t c = begin; c < end; ++c)
        for (int axis = 0; axis < 3; ++axis) add_quad(net_.corner[c], axis, out);
    });
    return std::move(net_);
  }

 private:
  void find_shared_corners() {
    shared_ = parallel_collect<SharedCorner>(set_.size(), kRange, [&](std::size_t begin, std::size_t end, auto& out) {
      for (std::size_t c = begin; c < end; ++c) {
        const Fans fans(lattice_, net_.corner[c], octants_at(lattice_, net_.corner[c]));
        if (fans.count > 1) out.push_back({static_cast<std::uint32_t>(c), fans});
      }
    });
    VertexIndex next = set_.size();
    for (SharedCorner& s : shared_) {
      s.extra = next;
      next += static_cast<VertexIndex>(s.fans.count - 1);
    }
    vertices_ = next;
  }

  static VertexIndex vertex(const SharedCorner& s, int group) {
    return group == 0 ? s.corner : s.extra + static_cast<VertexIndex>(group - 1);
  }

  void place_vertices() {
    net_.corner.resize(vertices_);
    net_.start.resize(vertices_);
    net_.shares_corner.assign(vertices_, 0);
    parallel_for(set_.size(), [&](std::size_t c) { net_.start[c] = lattice_.at(net_.corner[c]); });
    for (const SharedCorner& s : shared_) {
      const Corner c = net_.corner[s.corner];
      for (int group = 0; group < s.fans.count; ++group) {
        const VertexIndex v = vertex(s, group);
        net_.corner[v] = c;
        net_.start[v] = lattice_.at(c) + s.fans.way_out(lattice_, c, group);
        net_.shares_corner[v] = 1;
      }
    }
  }

  void add_quad(const Corner& c, int axis, std::vector<Quad>& out) const {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    if (c[next] == lattice_.size(next) || c[last] == lattice_.size(last)) return;
    Corner below = c;
    --below[axis];
    Quad q{{}, lattice_.label(below), lattice_.label(c), static_cast<std::uint8_t>(axis)};
    if (q.lower == q.upper) return;
    if (lattice_.on_box(c, axis)) q.box = static_cast<std::uint8_t>(1 + 2 * axis + (c[axis] != 0));
    // Of each corner: on which side of it the quad lies, along the next axis and the last.
    constexpr int kSide[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
    for (int i = 0; i < 4; ++i) {
      Corner at = c;
      at[next] += 1 - kSide[i][0];
      at[last] += 1 - kSide[i][1];
      q.v[i] = vertex_at(at, slot_of(axis, kSide[i][0], kSide[i][1]));
    }
    out.push_back(q);
  }

  VertexIndex vertex_at(const Corner& c, int slot) const {
    const std::uint32_t number = set_.number(c);
    if (!net_.shares_corner[number]) return number;
    const auto s = std::lower_bound(shared_.begin(), shared_.end(), number,
                                    [](const SharedCorner& a, std::uint32_t b) { return a.corner < b; });
    return vertex(*s, s->fans.of_slot[slot]);
  }

  const Lattice& lattice_;
  CornerSet set_;
  std::vector<SharedCorner> shared_;  // ascending
  VertexIndex vertices_ = 0;
  Net net_;
};

}  // namespace

Net make_net(const Lattice& lattice) {
  return Builder(lattice).build();
}

Groups<> quads_at_vertices(const Net& net) {
  return {net.corner.size(), [&](const auto& add) {
            for (std::uint32_t q = 0; q < net.quads.size(); ++q)
              for (const VertexIndex v : net.quads[q].v) add(v, q);
          }};
}

}  // namespace octafront::nets
