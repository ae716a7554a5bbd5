
#include "base/geometry/measures.h"
#include "soup/mend/caps.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

namespace octafront::mend {
namespace {

constexpr std::uint32_t kRim = 0xffffffffu;

/// Triangles over a polygon, divided and flipped.
class Refinement {
 public:
  Refinement(std::span<const Vec3> polygon, const Cap& cap, const IsTaken& is_taken, std::size_t most)
      : rim_(polygon.size()), points_(polygon.begin(), polygon.end()), triangles_(cap), is_taken_(is_taken) {
    link();
    find_scales(most);
  }

  FairCap result() {
    flip_all();
    for (int round = 0; round < kRounds && divide_all(); ++round) flip_all();
    return {std::move(triangles_), {points_.begin() + static_cast<std::ptrdiff_t>(rim_), points_.end()}};
  }

 private:
  void link() {
    std::unordered_map<std::uint64_t, std::uint32_t> first;
    across_.assign(triangles_.size(), {kRim, kRim, kRim});
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto [at, is_new] = first.try_emplace(edge_key(triangles_[t][i], triangles_[t][(i + 1) % 3]), 3 * t + i);
        edges_.insert(at->first);
        if (is_new) continue;
        across_[t][i] = at->second / 3;
        across_[at->second / 3][at->second % 3] = t;
      }
  }

  /// Sizes at the corners: those of the rim's edges; inside they grow where there would be too many points.
  void find_scales(std::size_t most) {
    double area = 0, squares = 0;
    for (const Triangle& t : triangles_) area += triangle_area(points_, t);
    for (std::size_t i = 0; i < rim_; ++i) {
      const Vec3 p = points_[i];
      scale_.push_back(0.5 * (distance(p, points_[(i + 1) % rim_]) + distance(p, points_[(i + rim_ - 1) % rim_])));
      squares += scale_.back() * scale_.back() / static_cast<double>(rim_);
    }
    const double least = area / static_cast<double>(std::max<std::size_t>(most, 1));
    if (squares < least) growth_ = kGrowth;
  }

  bool divide_all() {
    bool any = false;
    const std::size_t n = triangles_.size();
    for (std::uint32_t t = 0; t < n; ++t) any = divide(t) || any;
    return any;
  }

  /// At the middle, if that is farther from the corners than the sizes there and in the middle.
  bool divide(std::uint32_t t) {
    const auto [a, b, c] = triangles_[t];
    const Vec3 middle = centroid(points_[a], points_[b], points_[c]);
    const double scale = growth_ * (scale_[a] + scale_[b] + scale_[c]) / 3;
    for (const std::uint32_t v : {a, b, c})
      if (std::numbers::sqrt2 * distance(middle, points_[v]) <= std::max(scale, scale_[v])) return false;
    const auto v = static_cast<std::uint32_t>(points_.size());
    points_.push_back(middle);
    scale_.push_back(scale);
    const auto u = static_cast<std::uint32_t>(triangles_.size()), w = u + 1;
    const auto [over_ab, over_bc, over_ca] = across_[t];
    triangles_[t] = {a, b, v};
    triangles_.push_back({b, c, v});
    triangles_.push_back({c, a, v});
    across_[t] = {over_ab, u, w};
    across_.push_back({over_bc, w, t});
    across_.push_back({over_ca, t, u});
    replace(over_bc, t, u);
    replace(over_ca, t, w);
    for (const std::uint32_t corner : {a, b, c}) edges_.insert(edge_key(corner, v));
    return true;
  }

  void replace(std::uint32_t of, std::uint32_t from, std::uint32_t to) {
    if (of == kRim) return;
    for (std::uint32_t& t : across_[of])
      if (t == from) t = to;
  }

  void flip_all() {
    for (int pass = 0; pass < kPasses; ++pass) {
      bool any = false;
      for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        for (std::uint32_t i = 0; i < 3; ++i) any = flip(t, i) || any;
      if (!any) return;
    }
  }

  /// Towards Delaunay; not where the surface would fold.
  bool flip(std::uint32_t t, std::uint32_t i) {
    const std::uint32_t u = across_[t][i];
    if (u == kRim) return false;
    const std::uint32_t a = triangles_[t][i], b = triangles_[t][(i + 1) % 3], c = triangles_[t][(i + 2) % 3];
    std::uint32_t j = 0;
    while (triangles_[u][j] != b || triangles_[u][(j + 1) % 3] != a)
      if (++j == 3) return false;
    const std::uint32_t d = triangles_[u][(j + 2) % 3];
    const Vec3 p = points_[a], q = points_[b], r = points_[c], s = points_[d];
    constexpr double kClearly = 1e-6;  // radians: nothing is flipped back and forth
    if (angle_at(r, p, q) + angle_at(s, p, q) <= std::numbers::pi + kClearly) return false;
    const double before = dot(unit_normal(p, q, r), unit_normal(q, p, s)),
                 after = dot(unit_normal(r, p, s), unit_normal(s, q, r));
    if (after < std::min(before, 0.0) || edges_.contains(edge_key(c, d)) || (c < rim_ && d < rim_ && is_taken_(c, d)))
      return false;
    const std::uint32_t over_bc = across_[t][(i + 1) % 3], over_ca = across_[t][(i + 2) % 3],
                        over_ad = across_[u][(j + 1) % 3], over_db = across_[u][(j + 2) % 3];
    triangles_[t] = {c, a, d};
    across_[t] = {over_ca, over_ad, u};
    triangles_[u] = {d, b, c};
    across_[u] = {over_db, over_bc, t};
    replace(over_ad, u, t);
    replace(over_bc, t, u);
    edges_.erase(edge_key(a, b));
    edges_.insert(edge_key(c, d));
    return true;
  }

  static constexpr int kRounds = 30, kPasses = 20;
  static constexpr double kGrowth = 1.3;

  std::size_t rim_;
  std::vector<Vec3> points_;
  std::vector<double> scale_;
  double growth_ = 1;  ///< of sizes, with each division
  Cap triangles_;
  std::vector<Triangle> across_;  ///< the triangle behind each edge
  std::unordered_set<std::uint64_t> edges_;
  const IsTaken& is_taken_;
};

/// Least squares of the umbrella operator, by conjugate gradients on its normal equations, one coordinate at a time.
class Fairing {
 public:
  Fairing(std::span<const Vec3> polygon, const FairCap& cap, std::span<const Spoke> beyond)
      : rim_(static_cast<std::uint32_t>(polygon.size())), points_(polygon.begin(), polygon.end()) {
    points_.insert(points_.end(), cap.inner.begin(), cap.inner.end());
    std::vector<std::vector<std::uint32_t>> neighbours(points_.size());
    for (const Triangle& t : cap.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        neighbours[t[i]].push_back(t[(i + 1) % 3]);
        neighbours[t[(i + 1) % 3]].push_back(t[i]);
      }
    for (const auto& [corner, p] : beyond) {
      neighbours[corner].push_back(static_cast<std::uint32_t>(points_.size()));
      points_.push_back(p);
    }
    for (std::uint32_t v = 0; v < neighbours.size(); ++v) add_row(v, neighbours[v]);
    inner_ = cap.inner.size();
  }

  std::vector<Vec3> result() {
    for (int k = 0; k < 3; ++k) solve(k);
    const auto from = points_.begin() + rim_;
    return {from, from + static_cast<std::ptrdiff_t>(inner_)};
  }

 private:
  struct Entry {
    std::uint32_t point;
    double weight;
  };
  using Values = std::vector<double>;

  void add_row(std::uint32_t v, std::vector<std::uint32_t>& neighbours) {
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    std::vector<Entry> row;
    double sum = 0;
    for (const std::uint32_t w : neighbours) {
      const double apart = distance(points_[v], points_[w]);
      if (!(apart > 0)) continue;
      row.push_back({w, -1 / apart});
      sum += 1 / apart;
    }
    for (Entry& e : row) e.weight /= sum;
    row.push_back({v, 1});
    rows_.push_back(std::move(row));
  }

  bool is_free(std::uint32_t point) const { return point >= rim_ && point < rim_ + inner_; }

  /// x: values of inner points; with `fixed` those of all others too, from the points' coordinate.
  void apply(const Values& x, Values& out, int fixed) const {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      double sum = 0;
      for (const Entry& e : rows_[r]) {
        if (is_free(e.point))
          sum += e.weight * x[e.point - rim_];
        else if (fixed >= 0)
          sum += e.weight * points_[e.point][fixed];
      }
      out[r] = sum;
    }
  }

  void apply_transposed(const Values& y, Values& out) const {
    std::fill(out.begin(), out.end(), 0.0);
    for (std::size_t r = 0; r < rows_.size(); ++r)
      for (const Entry& e : rows_[r])
        if (is_free(e.point)) out[e.point - rim_] += e.weight * y[r];
  }

  void solve(int k) {
    Values x(inner_), rows(rows_.size()), residual(inner_), way(inner_), image(inner_), scaled(inner_);
    Values diagonal(inner_, 0);
    for (std::size_t i = 0; i < inner_; ++i) x[i] = points_[rim_ + i][k];
    for (const auto& row : rows_)
      for (const Entry& e : row)
        if (is_free(e.point)) diagonal[e.point - rim_] += e.weight * e.weight;
    apply(x, rows, k);
    apply_transposed(rows, residual);
    for (double& r : residual) r = -r;
    const auto precondition = [&] {
      for (std::size_t i = 0; i < inner_; ++i) scaled[i] = residual[i] / diagonal[i];
      return std::inner_product(residual.begin(), residual.end(), scaled.begin(), 0.0);
    };
    double energy = precondition();
    const double enough = kReduction * kReduction * energy;
    way = scaled;
    for (std::size_t step = 0; step < kMostSteps && energy > enough; ++step) {
      apply(way, rows, -1);
      apply_transposed(rows, image);
      const double along = std::inner_product(way.begin(), way.end(), image.begin(), 0.0);
      if (!(along > 0)) break;
      const double alpha = energy / along;
      for (std::size_t i = 0; i < inner_; ++i) {
        x[i] += alpha * way[i];
        residual[i] -= alpha * image[i];
      }
      const double last = energy;
      energy = precondition();
      for (std::size_t i = 0; i < inner_; ++i) way[i] = scaled[i] + energy / last * way[i];
    }
    for (std::size_t i = 0; i < inner_; ++i) points_[rim_ + i][k] = x[i];
  }

  /// Of the residual, at which the solution is good enough for a surface that nobody knows.
  static constexpr double kReduction = 1e-5;
  static constexpr std::size_t kMostSteps = 3000;

  std::uint32_t rim_;
  std::size_t inner_ = 0;
  std::vector<Vec3> points_;  ///< of the polygon, inside, beyond
  std::vector<std::vector<Entry>> rows_;
};

}  // namespace

FairCap faired(std::span<const Vec3> polygon, const Cap& cap, std::span<const Spoke> beyond, const IsTaken& is_taken,
               std::size_t most) {
  FairCap fair = Refinement(polygon, cap, is_taken, most).result();
  if (!fair.inner.empty()) fair.inner = Fairing(polygon, fair, beyond).result();
  return fair;
}

}  // namespace octafront::mend
