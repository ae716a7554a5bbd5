#include <octafront/error.h>

#include "base/mesh/complex.h"
#include "improve/curved/curved.h"
#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/kept_volumes.h"
#include "pipeline/stages/layered.h"
#include "pipeline/stages/methods.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Chords are made curves by parabolas, which miss this part of what coarse ones cut off.
constexpr double kMissedByParabolas = 0.25;
/// A part that has lost so much, or has so much more, is another one.
constexpr double kFarOff = 0.1;
/// Chords that lie this part of a region's volume over its area deep cut off well below a percent of it.
constexpr double kDepthOfThickness = 0.025;
/// What chords cut off falls with the bound: it is made smaller to come to this part of what may be lost, but to no
/// less than this part of itself at once, so often.
constexpr double kAimOfBound = 0.65, kLeastOfBound = 0.05;
constexpr int kTriesOfBounds = 4;
/// Regions that a sentence lists.
constexpr std::size_t kFew = 5;

/// A region whose volume is off by a part of it.
struct OffRegion {
  std::uint32_t region = 0;
  double change = 0;
};

std::string in_words(const Domain& domain, const std::vector<OffRegion>& off) {
  std::string all;
  for (std::size_t k = 0; k < std::min(kFew, off.size()); ++k)
    all += fmt::format("{}\"{}\" by {:+.2f} %", k == 0 ? "" : ", ", region_name(domain.surface, off[k].region),
                       100 * off[k].change);
  return off.size() > kFew ? fmt::format("{} and {} more", all, off.size() - kFew) : all;
}

double made_volume(const Report& report, std::size_t region) {
  if (report.regions.empty()) return report.volume;
  return report.regions[region].volume + report.regions[region].layers_volume;
}

/// By the report, the worst first.
std::vector<OffRegion> off_regions(const std::vector<double>& volumes, const Report& report, double most) {
  std::vector<OffRegion> off;
  for (std::uint32_t r = 0; r < volumes.size() && (report.regions.empty() || r < report.regions.size()); ++r)
    if (const double change = change_of_volume(made_volume(report, r), volumes[r]); !(std::abs(change) <= most))
      off.push_back({r, change});
  std::ranges::stable_sort(off, std::greater{}, [](const OffRegion& o) { return std::abs(o.change); });
  return off;
}

/// Bounds that let regions keep their volumes: where they are off they are made smaller.
std::vector<double> tightened(const Domain& domain, const KnownVolumes& known, const std::vector<OffRegion>& off,
                              double most) {
  std::vector<double> bound = domain.bound;
  bound.resize(domain.surface.triangles.size(), HUGE_VAL);
  for (std::size_t t = 0; t < bound.size(); ++t)
    for (const OffRegion& o : off) {
      const Sides sides = domain.surface.sides_of(t);
      if (sides[0] != o.region && sides[1] != o.region) continue;
      const double part = std::clamp(kAimOfBound * most / std::abs(o.change), kLeastOfBound, 1.0);
      const double first = o.region < known.depths.size() ? known.depths[o.region] * most / kVolumeKept : HUGE_VAL;
      bound[t] = std::isfinite(bound[t]) ? part * bound[t] : first;
    }
  return bound;
}

}  // namespace

KnownVolumes known_volumes(const Domain& domain) {
  if (!domain.true_volumes.empty()) return {domain.true_volumes, domain.chord_depths};
  KnownVolumes known;
  for (std::uint32_t r = 0; r < region_count(domain.surface); ++r) {
    const SurfaceMesh boundary = boundary_of_region(domain.surface, r);
    known.volumes.push_back(enclosed_volume(boundary));
    known.depths.push_back(kDepthOfThickness * known.volumes.back() / area(boundary));
  }
  return known;
}

void refuse_lost_volumes(const Domain& domain, const Filled& filled, Run& run) {
  if (!domain.geometry || domain.true_volumes.empty()) return;
  const std::vector<double> made = curved_volumes(filled.mesh), of_layers = layers_volumes(filled, made);
  std::vector<double> changes;
  for (std::size_t r = 0; r < std::min(made.size(), domain.true_volumes.size()); ++r)
    changes.push_back(change_of_volume(made[r] + of_layers[r], domain.true_volumes[r]));
  if (std::ranges::all_of(changes, [](double c) { return std::abs(c) <= kVolumeKept; })) return;
  const std::vector<double> cut = volumes_cut_off(filled.mesh, *domain.geometry);
  // What sizes cost that the user chose is said; what nobody would take for the part is refused.
  const double most = has_automatic_sizes(run.options) ? kVolumeKept : kFarOff;
  std::vector<OffRegion> lost;
  for (std::uint32_t r = 0; r < changes.size(); ++r) {
    const double left = changes[r] + cut[r] / domain.true_volumes[r];
    if (!(std::abs(left) <= std::max(most, kMissedByParabolas * std::abs(changes[r])))) lost.push_back({r, left});
  }
  if (lost.empty()) return;
  throw MeshingError(fmt::format(
      "the mesh does not keep the volumes of the CAD solids, beyond what chords of its elements cut off: {}. {}",
      in_words(domain, lost),
      run.options.size.elements ? "Ask for more elements" : "Give a smaller size, or a smaller `max_deviation`"));
}

Result with_volumes_within(double percent, const Domain& domain, const std::function<Result(const Domain&)>& make) {
  const double most = percent / 100;
  Result made = make(domain);
  const KnownVolumes known = known_volumes(domain);
  std::vector<OffRegion> off = off_regions(known.volumes, made.report, most);
  if (off.empty()) return made;
  Domain nearer = domain;
  for (int k = 0; k < kTriesOfBounds && !off.empty(); ++k) {
    std::string why = "volumes were off, so elements were made smaller there: " + in_words(domain, off);
    nearer.bound = tightened(nearer, known, off, most);
    made = make(nearer);
    made.report.stages.front().notes.push_back(std::move(why));
    off = off_regions(known.volumes, made.report, most);
  }
  if (off.empty()) return made;
  throw MeshingError(
      fmt::format("volumes do not come within {:g} %: {}. Give a smaller size, or a larger "
                  "`volume_tolerance`",
                  percent, in_words(domain, off)));
}

}  // namespace octafront
