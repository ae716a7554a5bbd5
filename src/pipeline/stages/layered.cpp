#include "pipeline/stages/layered.h"

#include <octafront/error.h>

#include "base/geometry/measures.h"
#include "layers/columns/assemble.h"
#include "layers/growth/grow.h"
#include "layers/growth/soundness.h"
#include "layers/growth/walls.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/stages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr int kMostLayers = 100;
constexpr double kDefaultGrowth = 1.2, kLeastGrowth = 1, kMostGrowth = 3;
constexpr int kGrowthSteps = 60;

/// What is called so in reports, by layers::Reason.
constexpr std::array<const char*, layers::kReasons> kReasonNames{
    "full", "ridge or corner", "bent patch beside", "gap", "distorted", "crossing", "neighbour"};

void require_layers(bool holds, const char* sentence) {
  if (!holds) throw OptionError(sentence);
}

bool is_positive(const std::optional<double>& value) {
  return !value || (std::isfinite(*value) && *value > 0);
}

/// The growth by which layers come from a first height to a total one.
double growth_to(double total, double first, std::uint32_t count) {
  double low = kLeastGrowth, high = kMostGrowth;
  for (int step = 0; step < kGrowthSteps; ++step) {
    const double growth = 0.5 * (low + high);
    (layers::total_height(growth, count) < total / first ? low : high) = growth;
  }
  return 0.5 * (low + high);
}

/// Height of a first layer whose far side is at this y+.
double first_by_yplus(const LayersOptions& o) {
  const double friction = 0.026 / std::pow(*o.reynolds, 1.0 / 7);
  return *o.yplus * *o.reference_length / (*o.reynolds * std::sqrt(0.5 * friction));
}

std::optional<double> absolute_first(const LayersOptions& o) {
  return o.yplus ? first_by_yplus(o) : o.first;
}

double growth_of(const LayersOptions& o) {
  if (o.growth) return *o.growth;
  const auto first = absolute_first(o);
  return first && o.total && o.count > 1 ? growth_to(*o.total, *first, static_cast<std::uint32_t>(o.count))
                                         : kDefaultGrowth;
}

layers::Asked asked_layers(const LayersOptions& o, const Remeshed& boundary) {
  layers::Asked asked;
  asked.count = static_cast<std::uint32_t>(o.count);
  asked.growth = growth_of(o);
  const double all = layers::total_height(asked.growth, asked.count);
  const auto first = absolute_first(o);
  double heights = 0, sizes = 0;
  for (const Vec3 p : boundary.surface.points) {
    const double h = boundary.sizes.at(p);
    asked.first.push_back(o.first_part ? *o.first_part * h : first ? *first : *o.total / all);
    heights += asked.first.back() * all;
    sizes += h;
  }
  asked.over_size = heights / sizes;
  return asked;
}

/// What there is at the faces of one wall.
struct WallCount {
  LayerSummary summary;
  std::vector<double> firsts;
  std::array<std::uint64_t, layers::kReasons> stopped{};
};

/// The corner of a face that has least.
VertexIndex least_corner(const Triangle& t, const layers::Columns& columns) {
  return *std::ranges::min_element(t, {}, [&](VertexIndex v) { return std::pair(columns.count[v], columns.part[v]); });
}

void add_face(const SurfaceMesh& wall, const layers::Columns& columns, const Triangle& t, WallCount& to) {
  LayerSummary& s = to.summary;
  ++s.faces;
  const VertexIndex least = least_corner(t, columns);
  ++to.stopped[static_cast<std::size_t>(columns.reason[least])];
  s.full += columns.reason[least] == layers::Reason::kNone;
  s.with_some += columns.count[least] > 0;
  for (const VertexIndex v : t) {
    s.mean_count += columns.count[v] / 3.0;
    s.thickness += columns.part[v] * columns.height_of(columns.count[v]) / columns.height_of(columns.asked) / 3;
    if (columns.count[v] > 0) to.firsts.push_back(columns.first[v] * columns.part[v]);
  }
  for (std::uint32_t k = 0; k < columns.count[least]; ++k)
    s.min_scaled_jacobian = std::min(s.min_scaled_jacobian, layers::least_scaled_jacobian(wall, columns, t, k));
}

LayerSummary finished(WallCount count) {
  LayerSummary s = std::move(count.summary);
  const auto faces = static_cast<double>(s.faces);
  for (double* sum : {&s.full, &s.with_some, &s.mean_count, &s.thickness}) *sum /= faces;
  if (!count.firsts.empty()) {
    std::ranges::sort(count.firsts);
    s.first_min = count.firsts.front(), s.first_max = count.firsts.back();
    s.first_median = count.firsts[count.firsts.size() / 2];
  } else {
    s.min_scaled_jacobian = 0;
  }
  for (std::size_t r = 1; r < layers::kReasons; ++r)
    if (count.stopped[r] > 0) s.stopped.emplace_back(kReasonNames[r], static_cast<double>(count.stopped[r]) / faces);
  std::ranges::stable_sort(s.stopped, std::greater{}, &std::pair<std::string, double>::second);
  return s;
}

std::vector<LayerSummary> summarize_layers(const SurfaceMesh& wall, const layers::Columns& columns) {
  std::map<std::uint32_t, WallCount> of_patch;
  for (std::size_t f = 0; f < wall.triangles.size(); ++f) {
    if (!columns.is_wall[f]) continue;
    WallCount& count = of_patch[wall.patch_of(f)];
    if (count.summary.faces == 0) count.summary.min_scaled_jacobian = 2, count.summary.asked_count = columns.asked;
    add_face(wall, columns, wall.triangles[f], count);
  }
  std::vector<LayerSummary> all;
  for (auto& [patch, count] : of_patch) {
    if (patch < wall.patch_names.size()) count.summary.patch = wall.patch_names[patch];
    all.push_back(finished(std::move(count)));
  }
  return all;
}

void require_coverage(const std::vector<LayerSummary>& walls, double percent) {
  for (const LayerSummary& wall : walls) {
    if (100 * wall.full >= percent) continue;
    std::string why;
    for (const auto& [reason, part] : wall.stopped)
      why += fmt::format("{}{} {:.2g} %", why.empty() ? "" : ", ", reason, 100 * part);
    throw MeshingError(fmt::format(
        "{:.3g} % of the faces of wall \"{}\" have all {:.0f} layers as high as asked, and `require_coverage` is {:g}: "
        "stopped by {}. Ask for thinner layers, or smaller elements",
        100 * wall.full, wall.patch, wall.asked_count, percent, why));
  }
}

}  // namespace

void check_layer_options(const Options& options) {
  const LayersOptions& o = options.layers;
  const bool has_flow = o.yplus || o.reynolds || o.reference_length;
  if (o.count == 0) {
    require_layers(!o.first && !o.first_part && !o.growth && !o.total && !has_flow && o.on.empty() &&
                       !o.require_coverage && !o.as_tets,
                   "boundary layers are described, but none are asked for: give `count`");
    return;
  }
  require_layers(o.count > 0 && o.count <= kMostLayers, "the `count` of boundary layers is between 0 and 100");
  require_layers(is_positive(o.first) && is_positive(o.first_part) && is_positive(o.total),
                 "`first`, `first_part` and `total` of boundary layers are heights above 0");
  require_layers(!has_flow || (o.yplus && o.reynolds && o.reference_length && is_positive(o.yplus) &&
                               is_positive(o.reynolds) && is_positive(o.reference_length)),
                 "`yplus`, `reynolds` and `reference_length` go together, and are above 0");
  require_layers(o.first.has_value() + o.first_part.has_value() + o.yplus.has_value() <= 1,
                 "the height of the first boundary layer is given more than once: `first`, `first_part` or `yplus`");
  require_layers(o.first || o.first_part || o.yplus || o.total,
                 "how high are the boundary layers to be? Give `first`, `first_part`, `yplus` or `total`");
  require_layers(!(o.total && o.first_part),
                 "`total` of boundary layers goes with `first` or `yplus`, not with `first_part`");
  require_layers(!(o.growth && o.total && absolute_first(o)),
                 "`growth`, the first height and `total` of boundary layers are one too many: give two of them");
  require_layers(!o.growth || (*o.growth >= kLeastGrowth && *o.growth <= kMostGrowth),
                 "`growth` of layers is in [1, 3]");
  if (const auto first = absolute_first(o); first && o.total) {
    const double ratio = *o.total / *first;
    require_layers(ratio >= o.count && ratio <= layers::total_height(kMostGrowth, static_cast<std::uint32_t>(o.count)),
                   "no `growth` in [1, 3] leads from the first height to `total` with so many layers");
  }
  require_layers(!o.require_coverage || (*o.require_coverage >= 0 && *o.require_coverage <= 100),
                 "`require_coverage` is in percent");
  require_layers(
      !traits_of(options.method).makes_own_boundary(),
      "the octree method makes a boundary of its own: boundary layers need method octree-aft, aft or recover");
  require_layers(options.order == 1, "boundary layers are of linear elements so far: choose `order` 1");
}

std::optional<GrownLayers> grow_layers(Remeshed& boundary, Run& run) {
  const LayersOptions& asked = run.options.layers;
  if (asked.count == 0) return {};
  if (!boundary.surface.sides.empty())
    throw OptionError(
        "boundary layers grow in one region so far, and this input has several regions or sheets. For a flow around a "
        "body leave it empty: its inside is no region with `nested` cavity, or a `void` at a point in it");
  return run.stage("boundary layers", [&](const Stage& stage) {
    GrownLayers grown{boundary.surface, {}};
    grown.columns =
        layers::grow(grown.wall, layers::walls_named(grown.wall, asked.on), asked_layers(asked, boundary), stage);
    run.report.layers = summarize_layers(grown.wall, grown.columns);
    if (asked.require_coverage) require_coverage(run.report.layers, *asked.require_coverage);
    boundary.surface = layers::top_of(grown.wall, grown.columns);
    return grown;
  });
}

void add_layers(Filled& filled, Run& run) {
  if (!filled.layers) return;
  describe_sizes(filled.mesh, filled.boundary.sizes, run.report);
  auto [mesh, boundary] = layers::with_layers(filled.layers->wall, filled.layers->columns, std::move(filled.mesh));
  filled.mesh = std::move(mesh);
  if (run.options.layers.as_tets) filled.mesh.wide_cells.clear(), filled.mesh.wide_faces.clear();
  filled.boundary.surface = std::move(boundary);
}

}  // namespace octafront
