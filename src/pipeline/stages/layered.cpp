#include "pipeline/stages/layered.h"

#include <octafront/error.h>

#include "base/core/elementary.h"
#include "base/mesh/complex.h"
#include "base/mesh/features.h"
#include "base/places/places.h"
#include "layers/grow.h"
#include "layers/layered_walls.h"
#include "layers/soundness.h"
#include "layers/with_layers.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/stages.h"
#include "pipeline/stages/true_shape.h"

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

constexpr double kDefaultGrowth = 1.2, kLeastGrowth = 1, kMostGrowth = 3;
constexpr int kGrowthSteps = 60;

/// What is called so in reports, by layers::Reason.
constexpr std::array<const char*, layers::kReasons> kReasonNames{
    "full", "ridge or corner", "bent patch beside", "gap", "distorted", "crossing", "neighbour"};

void require_layers(bool holds, const char* sentence) {
  if (!holds) throw OptionError(sentence);
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
  const double friction = 0.026 / elementary::pow(*o.reynolds, 1.0 / 7);
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

layers::Asked asked_layers(const LayersOptions& o, const SizeField& at, const std::vector<Vec3>& points) {
  layers::Asked asked;
  asked.count = static_cast<std::uint32_t>(o.count);
  asked.growth = growth_of(o);
  const double all = layers::total_height(asked.growth, asked.count);
  const auto first = absolute_first(o);
  double heights = 0, sizes = 0;
  for (const Vec3 p : points) {
    const double h = at.at(p);
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

/// By region and patch, as the mesh will call it.
std::vector<LayerSummary> summarize_layers(const SurfaceMesh& whole, const std::vector<layers::LayeredRegion>& regions,
                                           const TrueGeometry* geometry) {
  std::vector<LayerSummary> all;
  const MeshPatches patches = patches_in_mesh(whole, geometry);
  for (const auto& [wall, columns] : regions) {
    std::map<std::uint32_t, WallCount> of_patch;
    for (std::size_t f = 0; f < wall.is_wall.size(); ++f) {
      if (!wall.is_wall[f]) continue;
      WallCount& count = of_patch[patches.number[wall.surface.patch_of(f)]];
      if (count.summary.faces == 0) count.summary.min_scaled_jacobian = 2, count.summary.asked_count = columns.asked;
      add_face(wall.surface, columns, wall.surface.triangles[f], count);
    }
    for (auto& [patch, count] : of_patch) {
      count.summary.patch = patch_label(patches.names, patch);
      if (regions.size() > 1) count.summary.region = region_name(whole, wall.region);
      all.push_back(finished(std::move(count)));
    }
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
        "{:.3g} % of the faces of wall \"{}\"{} have all {:.0f} layers as high as asked, and `require_coverage` is "
        "{:g}: "
        "stopped by {}. Ask for thinner layers, or smaller elements",
        100 * wall.full, wall.patch, wall.region.empty() ? "" : " in " + wall.region, wall.asked_count, percent, why));
  }
}

std::vector<std::uint32_t> layered_regions(const SurfaceMesh& whole, const LayersOptions& asked) {
  return asked.outside ? std::vector<std::uint32_t>{kNone} : layers::regions_named(whole, asked.in);
}

/// A wall with layers outside is the mesh's own boundary.
GrownLayers grow_from(SurfaceMesh whole, const SizeField& sizes, const TrueGeometry* geometry, Run& run) {
  return run.stage("boundary layers", [&](const Stage& stage) {
    const LayersOptions& asked = run.options.layers;
    GrownLayers grown{std::move(whole), {}, {}};
    const std::vector<std::uint8_t> is_wall = layers::walls_named(grown.whole, asked.on);
    for (layers::RegionWall& wall :
         layers::walls_of_regions(grown.whole, is_wall, layered_regions(grown.whole, asked))) {
      if (std::ranges::find(wall.is_wall, 1) == wall.is_wall.end()) continue;
      layers::Columns columns = layers::grow(wall, asked_layers(asked, sizes, wall.surface.points), stage);
      for (VertexIndex v = 0; v < wall.vertex.size(); ++v) grown.whole.points[wall.vertex[v]] = wall.surface.points[v];
      grown.regions.push_back({std::move(wall), std::move(columns)});
    }
    if (grown.regions.empty())
      throw OptionError(fmt::format("no wall of \"{}\" bounds a region that layers are asked for in", asked.on));
    run.report.layers = summarize_layers(grown.whole, grown.regions, geometry);
    if (asked.require_coverage) require_coverage(run.report.layers, *asked.require_coverage);
    grown.opened = layers::without_layers(grown.whole, grown.regions);
    return grown;
  });
}

/// The triangles of the input that the triangles of a new surface are nearest to.
void take_sources(const Prepared& input, Remeshed& boundary) {
  std::vector<std::uint32_t>& source = boundary.surface.source;
  source.clear();
  for (const std::uint32_t t : boundary.source) source.push_back(input.surface.mesh().source_of(t));
}

}  // namespace

void check_layer_options(const Options& options) {
  const LayersOptions& o = options.layers;
  const bool has_flow = o.yplus || o.reynolds || (o.reference_length && !o.speed);
  if (o.count == 0) {
    require_layers(!o.first && !o.first_part && !o.growth && !o.total && !has_flow && o.on.empty() && o.in.empty() &&
                       !o.outside && !o.require_coverage && !o.as_tets,
                   "boundary layers are described, but none are asked for: give `count`");
    return;
  }
  require_layers(!has_flow || (o.yplus && (o.speed || (o.reynolds && o.reference_length))),
                 "`yplus` goes with `speed`, or with `reynolds` and `reference_length`");
  require_layers(o.first.has_value() + o.first_part.has_value() + o.yplus.has_value() <= 1,
                 "the height of the first boundary layer is given more than once: `first`, `first_part` or `yplus`");
  require_layers(o.first || o.first_part || o.yplus || o.total,
                 "how high are the boundary layers to be? Give `first`, `first_part`, `yplus` or `total`");
  require_layers(!(o.total && o.first_part),
                 "`total` of boundary layers goes with `first` or `yplus`, not with `first_part`");
  require_layers(!(o.growth && o.total && (o.first || o.yplus)),
                 "`growth`, the first height and `total` of boundary layers are one too many: give two of them");
  if (o.yplus && !o.reynolds) return;
  if (const auto first = absolute_first(o); first && o.total) {
    const double ratio = *o.total / *first;
    require_layers(ratio >= o.count && ratio <= layers::total_height(kMostGrowth, static_cast<std::uint32_t>(o.count)),
                   "no `growth` in [1, 3] leads from the first height to `total` with so many layers");
  }
  require_layers(!o.outside || o.in.empty(), "`outside` layers lie in no region: leave out `in`");
  require_layers(
      !traits_of(options.method).makes_own_boundary(),
      "the octree method makes a boundary of its own: boundary layers need method octree-aft, aft or recover");
}

double expected_layer_tets(const SurfaceMesh& surface, const LayersOptions& asked) {
  if (asked.count == 0) return 0;
  const std::vector<std::uint8_t> is_wall = layers::walls_named(surface, asked.on);
  std::size_t faces = 0;
  for (const layers::RegionWall& wall : layers::walls_of_regions(surface, is_wall, layered_regions(surface, asked)))
    faces += static_cast<std::size_t>(std::ranges::count(wall.is_wall, 1));
  return 3.0 * asked.count * static_cast<double>(faces);
}

double layer_tets(const Filled& filled, const LayersOptions& asked) {
  if (!filled.layers) return expected_layer_tets(filled.boundary.surface, asked);
  double tets = 0;
  for (const auto& [wall, columns] : filled.layers->regions)
    for (std::size_t t = 0; t < wall.is_wall.size(); ++t)
      for (const VertexIndex v : wall.surface.triangles[t]) tets += wall.is_wall[t] ? columns.count[v] : 0;
  return tets;
}

std::optional<GrownLayers> grow_layers(const Prepared& input, Remeshed& boundary, Run& run) {
  const LayersOptions& asked = run.options.layers;
  if (asked.count == 0 || asked.outside) return {};
  take_sources(input, boundary);
  GrownLayers grown = grow_from(std::move(boundary.surface), boundary.sizes, input.geometry, run);
  boundary.surface = grown.opened.surface;
  boundary.source.clear();
  return grown;
}

void add_layers(const Prepared& input, Filled& filled, Run& run) {
  const LayersOptions& asked = run.options.layers;
  if (asked.count == 0) return;
  describe_sizes(filled.mesh, filled.boundary.sizes, run.report);
  if (asked.outside) {
    take_sources(input, filled.boundary);
    filled.layers = grow_from(std::move(filled.boundary.surface), filled.boundary.sizes, input.geometry, run);
  }
  GrownLayers& grown = *filled.layers;
  layers::Layered made = layers::with_layers(grown.whole, grown.regions, grown.opened, std::move(filled.mesh));
  filled.mesh = std::move(made.mesh);
  grown.ground = std::move(made.ground), grown.below = std::move(made.below);
  filled.boundary.features = detect_features(grown.ground, run.options.surface.angle_of_features());
  if (asked.as_tets) filled.mesh.wide_cells.clear(), filled.mesh.wide_faces.clear();
  filled.boundary.surface = std::move(made.boundary);
}

std::vector<double> layers_volumes(const Filled& filled, const std::vector<double>& volumes) {
  std::vector<double> of_region(volumes.size(), 0);
  if (!filled.layers) return of_region;
  std::size_t layers = region_count(filled.layers->whole);
  for (const layers::LayeredRegion& grown : filled.layers->regions) {
    if (layers < volumes.size() && !grown.is_outside()) of_region[grown.wall.region] = volumes[layers];
    ++layers;
  }
  return of_region;
}

std::span<const VertexIndex> vertices_below(const Filled& filled) {
  return filled.layers ? std::span<const VertexIndex>(filled.layers->below) : std::span<const VertexIndex>();
}

}  // namespace octafront
