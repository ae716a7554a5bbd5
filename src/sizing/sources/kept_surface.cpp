// Sizes for a surface whose triangles stay as they are.

#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "sizing/sources/curvature.h"
#include "sizing/sources/make_size_field.h"
#include "sizing/sources/model_extent.h"
#include "sizing/sources/source_grid.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <limits>
#include <string>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Of the model's extent: triangles that are smaller are slivers, which say nothing of the size of elements.
constexpr double kFloorOfExtent = 1e-5;
/// Where triangles of very different sizes meet, gradation pulls sizes below most of the triangles. Then all are raised
/// by the mean shortfall, within limits, so that sizes lie about the triangles as often above as below.
constexpr double kRaisedFrom = 1.03, kMostKeptRaised = 1.5;
/// Where the mean shortfall is above this, the triangles ask for steeper changes of size than gradation allows:
/// following it would make two to three times the elements, and more of them poor. Then sizes may change this much
/// faster, and once more. Meshes of scans, up to 1.26 at a gradation of .2, keep about that, which serves their
/// elements.
constexpr double kSteeperFrom = 1.3, kSteeper = 2;
constexpr int kMostSteeper = 2;
/// The shortfall is asked of a grid with leaves so many times larger, and only on the surface, for a fraction of the
/// time: numbers of elements came out .1 % different on a scan, and 2.6 % on a machine part.
constexpr double kCoarser = 2;

/// The edge length that a triangle stands for: between that of the equilateral triangle of its area, which a needle
/// makes too small, and the mean length of its edges, which it makes too large; nearer to the latter. The even mean of
/// the two made up to three times the elements where hair-thin needles cover a plane, and none of them better.
double size_of(Vec3 a, Vec3 b, Vec3 c) {
  const double mean = (distance(a, b) + distance(b, c) + distance(c, a)) / 3;
  return std::sqrt(mean * std::sqrt(mean * kEdgeOfUnitArea * std::sqrt(triangle_area(a, b, c))));
}

/// Per triangle: the mean over it and its neighbours in logarithms, so that single needles and jumps do not decide.
std::vector<double> face_sizes(const KnownSurface& known) {
  const SurfaceMesh& surface = known.mesh();
  std::vector<double> own(surface.triangles.size());
  for (std::size_t f = 0; f < own.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    own[f] = size_of(surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]);
  }
  const FaceNeighbours across = smooth_face_neighbours(known.edges(), {});
  std::vector<double> smooth(own.size());
  for (std::size_t f = 0; f < own.size(); ++f) {
    double sum = elementary::log(std::max(own[f], std::numeric_limits<double>::min())), n = 1;
    for (const std::uint32_t g : across[f]) {
      if (g != kNone && own[g] > 0) sum += elementary::log(own[g]), n += 1;
    }
    smooth[f] = elementary::exp(sum / n);
  }
  return smooth;
}

/// Gradation only ever makes sizes smaller. By how much, on average over the triangles, in logarithms.
double mean_shortfall(const SurfaceMesh& surface, const std::vector<double>& face, const OctreeField& grid) {
  double sum = 0;
  for (std::size_t f = 0; f < face.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    sum +=
        elementary::log(face[f] / grid.at(centroid(surface.points[t[0]], surface.points[t[1]], surface.points[t[2]])));
  }
  return elementary::exp(sum / static_cast<double>(face.size()));
}

/// Sizes that the longest edges of triangles have beyond two, in all: elements between a large triangle and small sizes
/// take many times the time of others, in the front and in improvement.
double sizes_along_long_edges(const SurfaceMesh& surface, const OctreeField& grid) {
  double sum = 0;
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[k];
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    sum += std::max(0.0, longest / grid.at(centroid(a, b, c)) - 2);
  }
  return sum;
}

/// The triangles that are kept stand for the size on the surface; these sources would ask for other triangles.
void note_unused_sources(const SizeOptions& options, const Stage& stage) {
  std::string names;
  const auto add = [&](bool given, const char* name) {
    if (given) names += (names.empty() ? "" : ", ") + std::string(name);
  };
  add(options.curvature.has_value(), "`curvature`");
  add(options.gap.has_value(), "`gap`");
  add(options.through.has_value(), "`through`");
  add(options.feature_elements.has_value(), "`feature_elements`");
  add(options.facets, "`facets`");
  if (names.empty()) return;
  stage.note(names +
             ": not used, for the kept triangles decide the sizes on the surface, and with them those "
             "inside; use `regions`, `size` or `max_size` for smaller elements inside");
}

}  // namespace

SizeField size_field_of_surface(const KnownSurface& known, const SizeOptions& options, const Stage& stage) {
  const SurfaceMesh& surface = known.mesh();
  check_size_options(options);
  if (options.field) return *options.field;
  note_unused_sources(options, stage);
  const RootCube root = root_around(surface);
  const double floor = options.min_size.value_or(model_extent(surface) * kFloorOfExtent);
  std::vector<double> face = face_sizes(known);
  for (double& h : face) h = std::max(h, floor);
  const std::vector<SizeInSpace> in_space = sizes_in_space(known, options);
  const SizeAtPlace at_place = least_of(given_sizes(surface, options), least_at_places(in_space, floor));
  std::vector<SizeSample> points = samples_of_points(options, floor);
  const NamedSizes named = named_sizes(known, options);
  points.insert(points.end(), named.points.begin(), named.points.end());
  const std::vector<SizeSample> inside = samples_inside(known, in_space, floor, stage.context());
  points.insert(points.end(), inside.begin(), inside.end());
  const auto samples_of = [&](const std::vector<double>& sizes) {
    RawVector<SizeSample> samples = sample_surface(surface, sizes, at_place, stage.context());
    samples.insert(samples.end(), points.begin(), points.end());
    return samples;
  };
  GridRules rules = grid_rules(options, std::min(options.max_size.value_or(HUGE_VAL), options.size.value_or(HUGE_VAL)));
  RawVector<SizeSample> samples = samples_of(face);
  const auto shortfall_at = [&](double gradation) {
    GridRules coarse = rules;
    coarse.gradation = gradation;
    coarse.leaf_per_size *= kCoarser;
    coarse.only_surface = true;
    return mean_shortfall(surface, face, *make_background_grid(root, samples, coarse, stage.context()));
  };
  double shortfall = shortfall_at(rules.gradation);
  for (int i = 0; i < kMostSteeper && shortfall > kSteeperFrom; ++i) {
    rules.gradation *= kSteeper;
    shortfall = shortfall_at(rules.gradation);
  }
  if (rules.gradation > options.gradation.value_or(kDefaultGradation)) {
    stage.note(fmt::format(
        "the kept triangles change in size faster than gradation allows: sizes change by up to {:.3g} per unit of "
        "length",
        rules.gradation));
  }
  shortfall = std::min(kMostKeptRaised, shortfall);
  if (shortfall > kRaisedFrom) {
    std::vector<double> raised = face;
    for (double& h : raised) h *= shortfall;
    samples = samples_of(raised);
  }
  auto grid = make_background_grid(root, samples, rules, stage.context());
  stage.count("leaves", static_cast<double>(grid->tree.size()));
  stage.count("levels", grid->tree.depth());
  stage.count("sizes along long edges", sizes_along_long_edges(surface, *grid));
  return SizeFunction::field(with_regions(std::move(grid), options, stage.context()));
}

}  // namespace octafront
