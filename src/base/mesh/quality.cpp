#include <octafront/quality.h>

#include "base/core/elementary.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/mesh/dihedral.h"
#include "base/mesh/quality_batch.h"
#include "base/mesh/quality_sum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace octafront {

namespace {

// Corners seen from a in units of the longest edge, so that no power of a length overflows or underflows.
std::array<Vec3, 4> normalized_corners(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  std::array<Vec3, 4> q{Vec3{}, b - a, c - a, d - a};
  double size = 0;
  for (const Vec3& v : q) size = std::max({size, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (size > 0)
    for (Vec3& v : q) v = v / size;
  return q;
}

double degrees_of(const AngleDirection& angle) {
  return elementary::atan2(angle.y, angle.x) * (180 / std::numbers::pi);
}

// Classes of 10 degrees. A table tells the class of most angles of a step, and the class before the border that lies
// within the rest.
class AngleClasses {
 public:
  AngleClasses() {
    for (int i = 0; i < kClasses - 1; ++i) {
      const double angle = (i + 1) * std::numbers::pi / kClasses;
      border_[i] = {elementary::cos(angle), elementary::sin(angle)};
    }
    std::uint8_t next = 0;
    for (int step = 0; step <= kSteps; ++step) {
      // Rounding may put an angle one step too far, never past a whole one.
      while (next < kClasses - 1 && step_of(border_[next]) < step - 1) ++next;
      first_[step] = next;
    }
  }

  std::size_t of(const AngleDirection& angle, std::int32_t step) const {
    std::size_t c = first_[step];
    while (c < kClasses - 1 && !angle.is_below(border_[c])) ++c;
    return c;
  }

 private:
  static constexpr int kClasses = 18, kSteps = QualityBatch::kSteps;

  static int step_of(const AngleDirection& d) {
    return static_cast<int>((1 - d.x / (std::abs(d.x) + d.y)) * (0.5 * kSteps));
  }

  std::array<AngleDirection, kClasses - 1> border_;  ///< the lower ones of all classes but the first
  std::array<std::uint8_t, kSteps + 1> first_;       ///< the least class that an angle of this step may have
};

const AngleClasses& angle_classes() {
  static const AngleClasses classes;
  return classes;
}

/// Calls visit(batch, i, tet) for the tets tet_at(begin) ... tet_at(end - 1), the i-th of a batch each.
template <class TetAt, class Visit>
void for_each_quality(const TetMesh& mesh, std::size_t begin, std::size_t end, const TetAt& tet_at,
                      const Visit& visit) {
  QualityBatch batch;
  while (begin < end) {
    const int count = static_cast<int>(std::min<std::size_t>(QualityBatch::kSize, end - begin));
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < 4; ++k) batch.set(i, k, mesh.points[mesh.tets[tet_at(begin + i)][k]]);
    batch.evaluate();
    for (int i = 0; i < count; ++i) visit(batch, i, tet_at(begin + i));
    begin += static_cast<std::size_t>(count);
  }
}

/// Of corners that are one point -1: nothing is worse.
double beta_in(const QualityBatch& batch, int i) {
  return std::isnan(batch.beta[i]) ? -1 : std::clamp(batch.beta[i], -1.0, 1.0);
}

// The sum over a stretch of elements; the extreme angles wait to be converted.
struct Part {
  QualitySum sum;
  AngleDirection least{-1, 0}, most{1, 0};
  std::int32_t least_step = QualityBatch::kSteps, most_step = 0;
  const AngleClasses* classes = &angle_classes();

  void add(const QualityBatch& batch, int i, TetIndex tet) {
    QualitySummary& s = sum.summary;
    const double beta = beta_in(batch, i);
    ++s.elements;
    sum.beta += std::llround(beta / QualitySum::kBetaUnit);
    ++s.beta_classes[static_cast<std::size_t>(std::clamp(static_cast<int>(beta * 5), 0, 4))];
    if (s.beta_min_tet == kNone || beta < s.beta_min) {
      s.beta_min = beta;
      s.beta_min_tet = tet;
    }
    for (int e = 0; e < 6; ++e) add_angle({batch.x[e][i], batch.y[e][i]}, batch.step[e][i], tet);
  }
  /// Extreme angles, and where the least ones are; its elements have numbers from `first_tet` on.
  void finish(const TetMesh& mesh, std::uint64_t first_tet) {
    QualitySummary& s = sum.summary;
    s.dihedral_min = degrees_of(least);
    s.dihedral_max = degrees_of(most);
    s.beta_min_at = middle(mesh, s.beta_min_tet - first_tet);
    // Without any angle, of corners that are one point, it is the first.
    if (s.dihedral_min_tet == kNone) s.dihedral_min_tet = s.beta_min_tet;
    s.dihedral_min_at = middle(mesh, s.dihedral_min_tet - first_tet);
  }

 private:
  static Vec3 middle(const TetMesh& mesh, std::uint64_t t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    return (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]) / 4;
  }
  void add_angle(const AngleDirection& angle, std::int32_t step, TetIndex tet) {
    // Two steps away nothing is beyond.
    if (step < least_step + 2 && angle.is_below(least))
      least = angle, least_step = step, sum.summary.dihedral_min_tet = tet;
    if (step > most_step - 2 && most.is_below(angle)) most = angle, most_step = step;
    ++sum.summary.dihedral_histogram[classes->of(angle, step)];
  }
};

/// Of n tets; tet_at(i) is the number of the i-th, which is first_tet + that in the whole.
template <class TetAt>
QualitySum summed(const TetMesh& mesh, std::size_t n, std::uint64_t first_tet, const TetAt& tet_at) {
  constexpr std::size_t kAtOnce = 8192;
  std::vector<Part> parts((n + kAtOnce - 1) / kAtOnce);
  parallel_for(parts.size(), [&](std::size_t block) {
    for_each_quality(mesh, block * kAtOnce, std::min(n, (block + 1) * kAtOnce), tet_at,
                     [&](const QualityBatch& batch, int i, TetIndex t) {
                       parts[block].add(batch, i, static_cast<TetIndex>(first_tet + t));
                     });
    parts[block].finish(mesh, first_tet);
  });
  QualitySum whole;
  for (const Part& part : parts) whole.add(part.sum);
  return whole;
}

}  // namespace

double radius_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto q = normalized_corners(a, b, c, d);
  return std::clamp(tet_radius_ratio(q[0], q[1], q[2], q[3]), -1.0, 1.0);
}

double radius_ratio(Vec3 a, Vec3 b, Vec3 c) {
  const auto q = normalized_corners(a, b, c, a);
  return std::min(1.0, triangle_radius_ratio(q[0], q[1], q[2]));
}

std::array<double, 6> dihedral_angles(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto q = normalized_corners(a, b, c, d);
  std::array<double, 6> degrees{};
  std::ranges::transform(dihedral_directions(q[1], q[2], q[3]), degrees.begin(), degrees_of);
  return degrees;
}

void QualitySum::add(const QualitySum& more) {
  if (more.summary.elements == 0) return;
  if (summary.elements == 0) {
    *this = more;
    return;
  }
  beta += more.beta;
  const QualitySummary& part = more.summary;
  summary.elements += part.elements;
  for (std::size_t i = 0; i < summary.beta_classes.size(); ++i) summary.beta_classes[i] += part.beta_classes[i];
  for (std::size_t i = 0; i < summary.dihedral_histogram.size(); ++i)
    summary.dihedral_histogram[i] += part.dihedral_histogram[i];
  if (std::pair(part.beta_min, part.beta_min_tet) < std::pair(summary.beta_min, summary.beta_min_tet)) {
    summary.beta_min = part.beta_min;
    summary.beta_min_tet = part.beta_min_tet;
    summary.beta_min_at = part.beta_min_at;
  }
  if (std::pair(part.dihedral_min, part.dihedral_min_tet) < std::pair(summary.dihedral_min, summary.dihedral_min_tet)) {
    summary.dihedral_min = part.dihedral_min;
    summary.dihedral_min_tet = part.dihedral_min_tet;
    summary.dihedral_min_at = part.dihedral_min_at;
  }
  summary.dihedral_max = std::max(summary.dihedral_max, part.dihedral_max);
}

QualitySummary QualitySum::finished() const {
  QualitySummary whole = summary;
  if (whole.elements > 0) whole.beta_mean = static_cast<double>(beta) * kBetaUnit / static_cast<double>(whole.elements);
  return whole;
}

QualitySum sum_of_quality(const TetMesh& mesh, std::uint64_t first_tet) {
  return summed(mesh, mesh.tets.size(), first_tet, [](std::size_t i) { return static_cast<TetIndex>(i); });
}

std::vector<QualitySum> sums_of_regions(const TetMesh& mesh, std::uint64_t first_tet, std::uint32_t regions) {
  const Groups<> tets = group_by_owner(regions, static_cast<std::uint32_t>(mesh.tets.size()),
                                       [&](std::uint32_t t) { return mesh.region[t]; });
  std::vector<QualitySum> found(regions);
  parallel_for(
      regions,
      [&](std::size_t r) {
        found[r] = summed(mesh, tets[r].size(), first_tet, [&](std::size_t i) { return tets[r][i]; });
      },
      Split::kSingly);
  return found;
}

QualitySummary summarize_quality(const TetMesh& mesh) {
  return sum_of_quality(mesh, 0).finished();
}

std::vector<QualitySummary> quality_of_regions(const TetMesh& mesh) {
  if (mesh.region.empty()) return {summarize_quality(mesh)};
  const std::uint32_t regions = mesh.tets.empty() ? 0 : 1 + *std::max_element(mesh.region.begin(), mesh.region.end());
  std::vector<QualitySummary> found;
  for (const QualitySum& sum : sums_of_regions(mesh, 0, regions)) found.push_back(sum.finished());
  return found;
}

std::vector<PoorElement> worst_elements(const TetMesh& mesh, std::size_t count) {
  const auto corners = [&](std::size_t t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    return std::array<Vec3, 4>{mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]};
  };
  using Candidate = std::pair<double, TetIndex>;
  const auto keep_least = [count](std::vector<Candidate>& of) {
    const std::size_t kept = std::min(count, of.size());
    std::partial_sort(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(kept), of.end());
    of.resize(kept);
  };
  const auto number = [](std::size_t t) { return static_cast<TetIndex>(t); };
  // Whoever is among the worst of all is among the worst of its range.
  constexpr std::size_t kRange = 8192;
  auto all = parallel_collect<Candidate>(
      mesh.tets.size(), kRange, [&](std::size_t begin, std::size_t end, std::vector<Candidate>& found) {
        for_each_quality(mesh, begin, end, number, [&](const QualityBatch& batch, int i, TetIndex t) {
          found.push_back({beta_in(batch, i), t});
        });
        keep_least(found);
      });
  keep_least(all);
  std::vector<PoorElement> worst;
  for (const auto& [beta, t] : all) {
    const auto [a, b, c, d] = corners(t);
    const auto angles = dihedral_angles(a, b, c, d);
    const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
    worst.push_back({t, (a + b + c + d) / 4, beta, *least, *most});
  }
  return worst;
}

}  // namespace octafront
