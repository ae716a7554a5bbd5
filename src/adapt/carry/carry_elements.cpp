#include "adapt/carry/carry.h"
#include "adapt/carry/element_slopes.h"
#include "adapt/carry/sums.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <memory>

namespace octafront::adapt {
namespace {

/// Tets that share less than this part of themselves with old ones share nothing: what is left of them is rounding.
constexpr double kLeastShared = 1e-9;
/// Between two looks at whether to stop.
constexpr std::size_t kElementsAtATime = 1 << 16;

class ElementMeans {
 public:
  /// `slopes`: null: old elements are constant.
  ElementMeans(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
               std::unique_ptr<ElementSlopes> slopes)
      : meshes_(meshes),
        gone_(gone),
        old_(old),
        made(meshes.now.tets.size() * old.components, 0),
        slopes_(std::move(slopes)),
        covered_(meshes.now.tets.size(), 1) {}

  void find_all(const RunContext& context) {
    const std::size_t n = meshes_.now.tets.size();
    for (std::size_t begin = 0; begin < n; begin += kElementsAtATime) {
      context.check();
      context.report("fields", static_cast<double>(begin) / static_cast<double>(n));
      const std::size_t count = std::min(kElementsAtATime, n - begin);
      parallel_for(count, [&](std::size_t i) { find(static_cast<TetIndex>(begin + i)); });
    }
  }

  /// What is new is not covered, what is old is lost.
  void enter_into(CarryReport& report) const {
    CarefulSums sums = parallel_sum(covered_.size(), [&](std::size_t begin, std::size_t end) {
      CarefulSums part(2);
      for (std::size_t t = begin; t < end; ++t) {
        if (is_copied(static_cast<TetIndex>(t))) continue;
        const double volume = volume_in(meshes_.now, static_cast<TetIndex>(t)), covered = std::min(covered_[t], 1.0);
        part[0].add((1 - covered) * volume), part[1].add(covered * volume);
      }
      return part;
    });
    for (TetIndex t = 0; t < meshes_.before.tets.size(); ++t)
      if (gone_.is_gone(t)) sums[1].add(-volume_in(meshes_.before, t));
    report.uncovered = sums[0].value(), report.lost = std::max(0.0, -sums[1].value());
  }

  bool is_copied(TetIndex t) const { return meshes_.same.old_tet_of_new[t] != kNone; }

 private:
  double& value(TetIndex t, std::size_t k) { return made[t * old_.components + k]; }
  double old_value(TetIndex t, std::size_t k) const { return old_.values[t * old_.components + k]; }

  void copy(TetIndex to, TetIndex from) {
    for (std::size_t k = 0; k < old_.components; ++k) value(to, k) = old_value(from, k);
  }

  void find(TetIndex t) {
    if (is_copied(t)) return copy(t, meshes_.same.old_tet_of_new[t]);
    const TetPlanes tet(corners_in(meshes_.now, t));
    const std::uint32_t region = meshes_.regions.of_new(t);
    const auto is_of_region = [&](TetIndex old) { return meshes_.regions.of_old(old) == region; };
    Box3 box;
    for (const Vec3& p : tet.corners()) box.add(p);
    double sum = 0;
    gone_.for_each_near(box, [&](TetIndex old) {
      if (is_of_region(old)) sum += add_shared(t, tet, old);
    });
    covered_[t] = sum;
    if (sum > kLeastShared) {
      for (std::size_t k = 0; k < old_.components; ++k) value(t, k) /= sum;
      return;
    }
    covered_[t] = 0;
    for (std::size_t k = 0; k < old_.components; ++k) value(t, k) = 0;
    if (const TetIndex old = gone_.nearest(tet.centre(), is_of_region); old != kNone) copy(t, old);
  }

  double add_shared(TetIndex t, const TetPlanes& tet, TetIndex old) {
    const TetCorners other = corners_in(meshes_.before, old);
    if (slopes_ == nullptr) {
      const double shared = shared_volume(tet, other);
      for (std::size_t k = 0; shared > 0 && k < old_.components; ++k) value(t, k) += shared * old_value(old, k);
      return shared;
    }
    const TetOverlap shared = shared_moments(tet, other);
    if (shared.share == 0) return 0;
    const Vec3 way = shared.moment + shared.share * (tet.corners()[0] - middle_of(other));
    for (std::size_t k = 0; k < old_.components; ++k)
      value(t, k) += shared.share * old_value(old, k) + dot(slopes_->slope(old, k), way);
    return shared.share;
  }

  const MeshPair& meshes_;
  const GoneTets& gone_;
  const OldValues& old_;

 public:
  std::vector<double> made;

 private:
  std::unique_ptr<ElementSlopes> slopes_;
  std::vector<double> covered_;  ///< the part of each tet that old ones of its region cover
};

/// Barycentric coordinates of the integration points: of the corner that they are near, and of the others.
constexpr double kNear = 0.58541019662496845446, kFar = 0.13819660112501051518;

/// What four values in each tet are: a linear function.
struct PointFunctions {
  std::size_t components;
  std::vector<double> means;       ///< `components` per tet
  std::vector<double> at_corners;  ///< the same of each corner

  PointFunctions(const TetMesh& mesh, const OldValues& old) : components(old.components / 4) {
    means.resize(mesh.tets.size() * components), at_corners.resize(4 * means.size());
    parallel_for(mesh.tets.size(), [&](std::size_t t) {
      for (std::size_t k = 0; k < components; ++k) {
        const auto at = [&](std::size_t i) { return (4 * t + i) * components + k; };
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += old.values[at(i)];
        means[t * components + k] = sum / 4;
        for (std::size_t i = 0; i < 4; ++i) at_corners[at(i)] = (old.values[at(i)] - kFar * sum) / (kNear - kFar);
      }
    });
  }

  double at(const TetMesh& mesh, TetIndex t, Vec3 p, std::size_t k) const {
    const TetCorners x = corners_in(mesh, t);
    const double whole = six_volumes(x[0], x[1], x[2], x[3]);
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      TetCorners with = x;
      with[i] = p;
      sum += six_volumes(with[0], with[1], with[2], with[3]) / whole * at_corners[(4 * t + i) * components + k];
    }
    return sum;
  }
};

/// Of each region and component.
struct PointRanges {
  std::vector<double> least, greatest;

  PointRanges(const MeshPair& meshes, const OldValues& old, std::size_t components)
      : least(meshes.regions.count() * components, HUGE_VAL), greatest(least.size(), -HUGE_VAL) {
    for (TetIndex t = 0; t < meshes.before.tets.size(); ++t)
      for (std::size_t i = 0; i < old.components; ++i) {
        const std::size_t r = meshes.regions.of_old(t) * components + i % components;
        const double value = old.values[t * old.components + i];
        least[r] = std::min(least[r], value), greatest[r] = std::max(greatest[r], value);
      }
  }
};

/// The means, and beside them as much of the differences at the points as stays within the range of the region.
std::vector<double> with_differences(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                     const PointFunctions& functions, const std::vector<double>& means) {
  const std::size_t n = functions.components;
  const PointRanges ranges(meshes, old, n);
  std::vector<double> made(meshes.now.tets.size() * old.components);
  parallel_for(meshes.now.tets.size(), [&](std::size_t number) {
    const auto t = static_cast<TetIndex>(number);
    double* const values = &made[number * old.components];
    if (const TetIndex same = meshes.same.old_tet_of_new[t]; same != kNone) {
      std::copy_n(old.values.begin() + static_cast<std::ptrdiff_t>(same * old.components), old.components, values);
      return;
    }
    const std::uint32_t region = meshes.regions.of_new(t);
    const TetCorners x = corners_in(meshes.now, t);
    std::array<TetIndex, 4> holder{};
    std::array<Vec3, 4> place;
    for (std::size_t i = 0; i < 4; ++i) {
      place[i] = kFar * (x[0] + x[1] + x[2] + x[3]) + (kNear - kFar) * x[i];
      holder[i] = holder_of(meshes.before, gone, place[i],
                            [&](TetIndex other) { return meshes.regions.of_old(other) == region; });
    }
    for (std::size_t k = 0; k < n; ++k) {
      const double mean = means[number * n + k];
      std::array<double, 4> beside{};
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i)
        sum += beside[i] = holder[i] == kNone ? mean : functions.at(meshes.before, holder[i], place[i], k);
      double share = 1;
      for (double& b : beside) {
        b -= sum / 4;
        const double room = (b > 0 ? ranges.greatest : ranges.least)[region * n + k] - mean;
        if (b != 0) share = std::min(share, std::max(0.0, room / b));
      }
      for (std::size_t i = 0; i < 4; ++i) values[i * n + k] = mean + share * beside[i];
    }
  });
  return made;
}

}  // namespace

std::vector<double> carried_of_elements(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                        const CarryOptions& options, const RunContext& context, CarryReport& report) {
  std::unique_ptr<ElementSlopes> slopes;
  if (options.linear_elements)
    slopes = std::make_unique<ElementSlopes>(meshes.before, meshes.regions, old.values, old.components);
  ElementMeans means(meshes, gone, old, std::move(slopes));
  means.find_all(context);
  means.enter_into(report);
  return std::move(means.made);
}

std::vector<double> carried_at_points(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                      const CarryOptions& options, const RunContext& context, CarryReport& report) {
  const PointFunctions functions(meshes.before, old);
  const OldValues old_means{functions.means, functions.components};
  ElementMeans means(meshes, gone, old_means,
                     std::make_unique<ElementSlopes>(
                         ElementSlopes::of_corners(meshes.before, functions.at_corners, functions.components)));
  means.find_all(context);
  means.enter_into(report);
  if (options.keep_integrals) spread_rest(meshes, gone, old_means, means.made, &old);
  return with_differences(meshes, gone, old, functions, means.made);
}

}  // namespace octafront::adapt
