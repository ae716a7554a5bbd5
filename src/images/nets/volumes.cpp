
#include "base/core/conjugate_gradients.h"
#include "base/core/parallel.h"
#include "images/nets/net_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace octafront::nets {

namespace {

constexpr std::size_t kChunks = 64;  // parts of a sum: the same on any number of threads

/// sum[i] of part(begin, end) over chunks of [0, n), added up in their order.
template <class Sum, class Part, class Add>
Sum chunked_sum(std::size_t n, const Part& part, const Add& add) {
  std::array<Sum, kChunks> parts;
  parallel_for(kChunks, [&](std::size_t c) { parts[c] = part(n * c / kChunks, n * (c + 1) / kChunks); });
  for (std::size_t c = 1; c < kChunks; ++c) add(parts[0], parts[c]);
  return std::move(parts[0]);
}

Vec3 twice_area(std::span<const Vec3> x, const Triangle& t) {
  return cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]);
}

/// How the volumes of the labels around a vertex change as it moves.
struct Gradients {
  struct OfLabel {
    Label label;
    Vec3 way;
  };
  std::array<OfLabel, 8> of;
  int count = 0;

  void add(Label label, Vec3 way) {
    if (label == LabelImage::kNoRegion) return;
    for (int i = 0; i < count; ++i)
      if (of[i].label == label) {
        of[i].way += way;
        return;
      }
    of[count++] = {label, way};
  }
};

Gradients gradients_at(const Net& net, const Groups<>& quads_at, const Lattice& lattice, std::span<const Vec3> x,
                       VertexIndex v) {
  Gradients g;
  for (const std::uint32_t q : quads_at[v]) {
    const Quad& quad = net.quads[q];
    Vec3 area;
    for (const Triangle& t : triangles_of(quad))
      if (std::find(t.begin(), t.end(), v) != t.end()) area += twice_area(x, t) / 6;
    g.add(quad.lower, area);
    g.add(quad.upper, -area);
  }
  for (int a = 0; a < 3; ++a)
    if (lattice.on_box(net.corner[v], a))
      for (int i = 0; i < g.count; ++i) g.of[i].way[a] = 0;
  return g;
}

/// A symmetric matrix of labels, by its entries that are not zero.
class LabelMatrix {
 public:
  using Entries = std::map<std::uint32_t, double>;
  LabelMatrix(Entries entries, std::size_t size) : size_(size) {
    for (const auto& [key, value] : entries) entries_.push_back({key >> 16, key & 0xffff, value});
  }
  static std::uint32_t key(Label row, Label column) { return std::uint32_t{row} << 16 | column; }

  /// Where labels fill the image's box the matrix is singular, and the right side fits: their volumes have one sum.
  std::vector<double> solve(const std::vector<double>& right) const {
    // Newton's next step looks at what is left.
    constexpr SolverLimits kSolved{.steps = 1000, .enough = 1e-12};
    std::vector<double> diagonal(size_, 0);
    for (const Entry& e : entries_)
      if (e.row == e.column) diagonal[e.row] = e.value;
    return solved_by_conjugate_gradients(
        diagonal, right, [&](const std::vector<double>& x) { return times(x); }, kSolved);
  }

 private:
  struct Entry {
    std::uint32_t row, column;
    double value;
  };
  std::vector<double> times(const std::vector<double>& x) const {
    std::vector<double> y(size_, 0);
    for (const Entry& e : entries_) {
      y[e.row] += e.value * x[e.column];
      if (e.row != e.column) y[e.column] += e.value * x[e.row];
    }
    return y;
  }
  std::size_t size_;
  std::vector<Entry> entries_;  // row <= column
};

}  // namespace

std::vector<double> volumes_of(const Net& net, std::span<const Vec3> x, std::size_t labels) {
  using Sums = std::vector<double>;
  return chunked_sum<Sums>(
      net.quads.size(),
      [&](std::size_t begin, std::size_t end) {
        Sums sums(labels, 0);
        for (std::size_t q = begin; q < end; ++q) {
          const Quad& quad = net.quads[q];
          double below = 0;
          for (const Triangle& t : triangles_of(quad)) below += dot(x[t[0]], twice_area(x, t)) / 6;
          if (quad.lower != LabelImage::kNoRegion) sums[quad.lower] += below;
          if (quad.upper != LabelImage::kNoRegion) sums[quad.upper] -= below;
        }
        return sums;
      },
      [](Sums& all, const Sums& part) {
        for (std::size_t l = 0; l < all.size(); ++l) all[l] += part[l];
      });
}

namespace {

/// One step of Newton's method after another.
class VolumeKeeper {
 public:
  VolumeKeeper(Net& net, const Groups<>& quads_at, const VertexCells& cells, const Lattice& lattice,
               const std::vector<double>& wanted, std::vector<Vec3>& x, std::span<const std::uint8_t> pinned)
      : net_(net),
        quads_at_(quads_at),
        cells_(cells),
        lattice_(lattice),
        wanted_(wanted),
        pinned_(pinned),
        x_(x),
        next_(x.size()) {}

  /// False if the volumes are right already.
  bool step() {
    constexpr double kEnough = 1e-5;  // of a label's volume
    choose_diagonals(net_, lattice_, x_);
    std::vector<double> missing = volumes_of(net_, x_, wanted_.size());
    double worst = 0;
    for (std::size_t l = 0; l < wanted_.size(); ++l) {
      missing[l] = has_pressure(l) ? wanted_[l] - missing[l] : 0;
      if (has_pressure(l)) worst = std::max(worst, std::abs(missing[l]) / wanted_[l]);
    }
    if (worst < kEnough) return false;
    move_by(LabelMatrix(entries(), wanted_.size()).solve(std::move(missing)));
    return true;
  }

 private:
  bool has_pressure(std::size_t label) const { return wanted_[label] > 0; }
  Gradients gradients(std::size_t v) const {
    if (!pinned_.empty() && pinned_[v]) return {};
    return gradients_at(net_, quads_at_, lattice_, x_, static_cast<VertexIndex>(v));
  }

  /// How each label's volume follows each label's pressure.
  LabelMatrix::Entries entries() const {
    using Entries = LabelMatrix::Entries;
    const auto of_vertices = [&](std::size_t begin, std::size_t end) {
      Entries entries;
      for (std::size_t v = begin; v < end; ++v) {
        const Gradients g = gradients(v);
        for (int i = 0; i < g.count; ++i)
          for (int j = 0; j < g.count; ++j)
            if (g.of[i].label <= g.of[j].label && has_pressure(g.of[i].label) && has_pressure(g.of[j].label))
              entries[LabelMatrix::key(g.of[i].label, g.of[j].label)] += dot(g.of[i].way, g.of[j].way);
      }
      return entries;
    };
    return chunked_sum<Entries>(x_.size(), of_vertices, [](Entries& all, const Entries& part) {
      for (const auto& [key, value] : part) all[key] += value;
    });
  }

  void move_by(const std::vector<double>& pressure) {
    parallel_for(x_.size(), [&](std::size_t v) {
      const Gradients g = gradients(v);
      Vec3 move;
      for (int i = 0; i < g.count; ++i)
        if (has_pressure(g.of[i].label)) move += g.of[i].way * pressure[g.of[i].label];
      // What is pinned may have had more room.
      next_[v] = g.count == 0 ? x_[v] : cells_.clamped(static_cast<VertexIndex>(v), x_[v] + move);
    });
    x_.swap(next_);
  }

  Net& net_;
  const Groups<>& quads_at_;
  const VertexCells& cells_;
  const Lattice& lattice_;
  const std::vector<double>& wanted_;
  const std::span<const std::uint8_t> pinned_;
  std::vector<Vec3>& x_;
  std::vector<Vec3> next_;
};

}  // namespace

void keep_volumes(Net& net, const Groups<>& quads_at, const VertexCells& cells, const Lattice& lattice,
                  const std::vector<double>& wanted, std::vector<Vec3>& x, const RunContext& context,
                  std::span<const std::uint8_t> pinned) {
  constexpr int kSteps = 5;
  VolumeKeeper keeper(net, quads_at, cells, lattice, wanted, x, pinned);
  for (int step = 0; step < kSteps; ++step) {
    context.check();
    if (!keeper.step()) return;
  }
}

}  // namespace octafront::nets
