#include "sizing/size_sources.h"

#include <octafront/error.h>

#include "base/geometry/measures.h"
#include "sizing/affordable.h"
#include "sizing/curvature.h"
#include "sizing/feature_sizes.h"
#include "sizing/gaps.h"
#include "sizing/make_size_field.h"
#include "sizing/named_sizes.h"
#include "sizing/point_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <fmt/core.h>

namespace octafront {

namespace {

/// The automatic choice. Base size: extent / 30 makes some 20,000 elements of a ball. Curvature of 20 elements per turn
/// keeps chords within 1.6 % of the radius of curvature.
constexpr double kExtentPerSize = 30;
constexpr double kAutomaticCurvature = 20;
constexpr double kAutomaticFeatureElements = 1;
constexpr double kAutomaticGap = 1;
/// Sources that follow details stop at this part of the base size unless min_size says otherwise: a spike or a crease
/// of noise must not ask for elements without bound.
constexpr double kAutomaticFloor = 1.0 / 5;
constexpr double kAutomaticGapFloor = 1.0 / 12;
constexpr double kChosenFloor = 1.0 / 200;
/// Chords cut corners: the automatic choice is scaled until the volume lost so, as predicted, is below this part.
constexpr double kVolumeLoss = 0.003;
constexpr double kLeastAutomaticScale = 0.3;

/// What the user's options come to, once defaults are filled in.
struct Choice {
  bool automatic = false;
  double base = 0, floor = 0, gap_floor = 0;
  double curvature = 0, gap = 0, feature_elements = 0;  ///< 0: not asked
};

double largest_of(const std::vector<PointSize>& points) {
  double largest = 0;
  for (const PointSize& s : points) largest = std::max(largest, s.size);
  return largest;
}

bool has_automatic_base(const SizeOptions& o) {
  return !o.size && !o.curvature && !o.gap && !o.feature_elements && !o.facets && !o.callback && o.point_sizes.empty();
}

Choice choose(const SurfaceMesh& surface, const SizeOptions& o) {
  Choice c;
  c.automatic = has_automatic_base(o);
  const double ours = model_extent(surface) / kExtentPerSize;
  c.base = o.size.value_or(ours);
  // Sizes at points and a function speak for the whole surface: there is no need of a size where nobody asks, and ours
  // would cut what they ask for.
  if (!o.size && o.callback) c.base = model_extent(surface);
  if (!o.size && !o.point_sizes.empty()) c.base = largest_of(o.point_sizes);
  if (o.max_size)
    c.base = o.size ? std::min(c.base, *o.max_size) : (c.automatic ? std::min(c.base, *o.max_size) : *o.max_size);
  c.base = std::max(c.base, o.min_size.value_or(0));
  const double usual = o.callback && !o.size ? std::min(c.base, ours) : c.base;
  c.floor = o.min_size.value_or(usual * (c.automatic ? kAutomaticFloor : kChosenFloor));
  c.gap_floor = o.min_size.value_or(usual * (c.automatic ? kAutomaticGapFloor : kChosenFloor));
  c.gap = o.gap.value_or(c.automatic ? kAutomaticGap : 0);
  c.curvature = o.curvature.value_or(c.automatic ? kAutomaticCurvature : 0);
  c.feature_elements = o.feature_elements.value_or(c.automatic ? kAutomaticFeatureElements : 0);
  return c;
}

/// Facet areas averaged over each triangle and its neighbours, as sizes: the side of a square of that area. This is the
/// paper's rule, by which a leaf is divided while its face is larger than the facets inside it.
void apply_facets(const SurfaceMesh& surface, const FaceNeighbours& across, double floor, std::vector<double>& face) {
  std::vector<double> areas(surface.triangles.size());
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    areas[f] = triangle_area(surface.points, t);
  }
  for (std::size_t f = 0; f < areas.size(); ++f) {
    double sum = areas[f];
    int n = 1;
    for (const std::uint32_t g : across[f]) {
      if (g != kNone) sum += areas[g], ++n;
    }
    face[f] = std::min(face[f], std::max(floor, std::sqrt(sum / n)));
  }
}

void apply_curvature(const SurfaceCurvature& curvature, double elements, double floor, std::vector<double>& face) {
  const double turn = 2 * std::numbers::pi / elements;
  for (std::size_t f = 0; f < face.size(); ++f) {
    if (curvature.largest[f] * face[f] > turn) face[f] = std::max(floor, turn / curvature.largest[f]);
  }
}

/// `error_of`: of a face.
template <class ErrorOf>
void apply_chord_errors(const SurfaceCurvature& curvature, const ErrorOf& error_of, double floor,
                        std::vector<double>& face) {
  for (std::size_t f = 0; f < face.size(); ++f) {
    const double k = curvature.largest[f], error = error_of(f);
    if (k * face[f] * face[f] > 6 * error) face[f] = std::max(floor, size_of_chord_error(error, k));
  }
}

/// Vertices on the surface and edges of length h between them: the triangles lie h^2 (k1 + k2) / 16 below it on
/// average.
double predicted_volume_loss(const SurfaceMesh& surface, const SurfaceCurvature& curvature,
                             const std::vector<double>& face) {
  double sum = 0;
  for (std::size_t f = 0; f < face.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    sum += triangle_area(surface.points, t) * curvature.sum[f] * face[f] * face[f] / 16;
  }
  return std::abs(sum);
}

double automatic_scale(const SurfaceMesh& surface, const SurfaceCurvature& curvature, const std::vector<double>& face) {
  const double loss = predicted_volume_loss(surface, curvature, face);
  const double allowed = kVolumeLoss * std::abs(enclosed_volume(surface));
  return loss > allowed ? std::max(kLeastAutomaticScale, std::sqrt(allowed / loss)) : 1;
}

/// What says how a surface is shaped. Faces that repair invented do not: they bend as they had to, and their
/// rims are no lines of the body.
struct ShapeLines {
  std::vector<Edge> borders;  ///< across these no curvature is known; sorted
  Features features;          ///< those that ask for sizes
};

ShapeLines lines_of_shape(const KnownSurface& known, std::span<const std::uint8_t> is_invented) {
  if (is_invented.empty()) return {known.features().edges, known.features()};
  ShapeLines lines{{}, {{}, known.features().corners}};
  const std::vector<Edge>& all = known.features().edges;
  for (std::size_t e = 0; e < known.edges().size(); ++e) {
    const Edge& edge = known.edges().edges[e];
    const bool is_ours =
        std::ranges::any_of(known.edges().uses(e), [&](std::uint32_t h) { return is_invented[h / 3] != 0; });
    const bool is_feature = std::ranges::binary_search(all, edge);
    if (is_ours || is_feature) lines.borders.push_back(edge);
    if (is_feature && !is_ours) lines.features.edges.push_back(edge);
  }
  return lines;
}

SizeAtPlace least_of(const SizeAtPlace& a, const SizeAtPlace& b) {
  if (!a || !b) return a ? a : b;
  return {[a = a.at, b = b.at](const PlaceOnSurface& s) { return std::min(a(s), b(s)); },
          a.batched ? a.batched : b.batched, std::min(a.spacing, b.spacing)};
}

/// The sources that are asked place by place, in one function; empty if there are none. A wall below a floor of our own
/// choosing cannot be resolved: the thinner it is, the less small elements do for it, and the larger they may be.
SizeAtPlace sizes_at_places(const KnownSurface& surface, const Choice& choice, const SizeOptions& options,
                            const Affordable& affordable) {
  SizeAtPlace gap;
  if (choice.gap > 0) {
    const auto gaps = std::make_shared<GapFinder>(surface, choice.gap_floor, choice.base * choice.gap);
    if (options.gap) affordable.gap(choice.gap, *gaps);
    gap.at = [gaps, choice, is_ours = !options.min_size](const PlaceOnSurface& place) {
      const double h = gaps->width(place) / choice.gap, floor = choice.gap_floor;
      if (h >= floor) return h;
      return is_ours ? floor * (floor / h) : floor;
    };
  }
  SizeAtPlace given = given_sizes(surface.mesh(), options);
  if (given && options.min_size) {
    given.at = [given = given.at, floor = *options.min_size](const PlaceOnSurface& s) {
      return std::max(floor, given(s));
    };
  }
  return least_of(gap, given);
}

}  // namespace

bool has_no_size_source(const SizeOptions& o) {
  return has_automatic_base(o) && !o.elements && !o.field && !o.min_size && o.regions.empty() && o.named.empty();
}

void refuse_huge_turning(const KnownSurface& surface, const SizeOptions& options, double degrees,
                         const RunContext& context) {
  const SurfaceCurvature curvature =
      surface_curvature(surface.mesh(), smooth_face_neighbours(surface.edges(), surface.features().edges), context);
  Affordable(surface.mesh(), options).normal_deviation(degrees, curvature);
}

double predicted_volume_loss(const KnownSurface& known, const SizeField& sizes, const RunContext& context) {
  const SurfaceMesh& surface = known.mesh();
  const SurfaceCurvature curvature =
      surface_curvature(surface, smooth_face_neighbours(known.edges(), known.features().edges), context);
  std::vector<double> face;
  for (const auto& [a, b, c] : surface.triangles)
    face.push_back(sizes.at(centroid(surface.points[a], surface.points[b], surface.points[c])));
  return predicted_volume_loss(surface, curvature, face) / std::abs(enclosed_volume(surface));
}

SizeAtPlace given_sizes(const SurfaceMesh& surface, const SizeOptions& options) {
  SizeAtPlace points, callback;
  if (!options.point_sizes.empty()) {
    const auto sizes = std::make_shared<PointSizes>(surface, options.point_sizes);
    points.at = [sizes](const PlaceOnSurface& s) { return sizes->at(s); };
  }
  if (options.callback) {
    callback.batched = std::make_shared<BatchedSizes>(options.callback);
    callback.at = [sizes = callback.batched](const PlaceOnSurface& s) { return sizes->at(s.p); };
    callback.spacing = model_extent(surface) / kExtentPerSize;
  }
  return least_of(points, callback);
}

std::vector<SizeSample> samples_of_points(const SizeOptions& options, double floor) {
  std::vector<SizeSample> samples;
  for (const PointSize& s : options.point_sizes) {
    const double h = std::max(floor, s.size);
    samples.push_back({s.p, {}, h, 0});
  }
  return samples;
}

double model_extent(const SurfaceMesh& surface) {
  const Vec3 origin = bounding_box(surface.points).center();
  double mass = 0, square = 0;
  Vec3 moment;
  for (const Triangle& t : surface.triangles) {
    const Vec3 a = surface.points[t[0]] - origin, b = surface.points[t[1]] - origin, c = surface.points[t[2]] - origin;
    const double area = triangle_area(a, b, c);
    const Vec3 sum = a + b + c;
    mass += area;
    moment += sum * (area / 3);
    square += area / 12 * (squared_length(a) + squared_length(b) + squared_length(c) + squared_length(sum));
  }
  if (!(mass > 0)) return 0;
  return 2 * std::sqrt(3 * std::max(0.0, square / mass - squared_length(moment / mass)));
}

WantedSizes wanted_sizes(const KnownSurface& known, const SizeOptions& options, const Stage& stage,
                         const FaceRules& rules) {
  const SurfaceMesh& surface = known.mesh();
  const Choice choice = choose(surface, options);
  WantedSizes wanted;
  wanted.face.assign(surface.triangles.size(), choice.base);
  double scale = 1;
  const Affordable affordable(surface, options);
  const ShapeLines lines = lines_of_shape(known, rules.is_invented);
  const bool limits_chords = options.chord_error || !rules.chord_errors.empty();
  if (choice.curvature > 0 || options.facets || limits_chords) {
    const FaceNeighbours across = smooth_face_neighbours(known.edges(), lines.borders);
    if (options.facets) apply_facets(surface, across, choice.floor, wanted.face);
    if (choice.curvature > 0 || limits_chords) {
      const SurfaceCurvature curvature = surface_curvature(surface, across, stage.context());
      if (options.curvature) affordable.curvature(*options.curvature, curvature);
      if (options.chord_error) affordable.max_deviation(*options.chord_error, curvature);
      if (limits_chords) {
        const auto error_of = [&](std::size_t f) {
          return std::min(options.chord_error.value_or(HUGE_VAL),
                          rules.chord_errors.empty() ? HUGE_VAL : rules.chord_errors[f]);
        };
        apply_chord_errors(curvature, error_of, choice.floor, wanted.face);
      }
      if (choice.curvature > 0) apply_curvature(curvature, choice.curvature, choice.floor, wanted.face);
      if (choice.automatic) scale = automatic_scale(surface, curvature, wanted.face);
    }
  }
  if (choice.feature_elements > 0) {
    const std::vector<FeatureCurve> curves = feature_curves(surface, lines.features);
    if (options.feature_elements) affordable.feature_elements(choice.feature_elements, curves);
    wanted.points = feature_samples(surface, curves, choice.feature_elements, choice.floor, choice.base);
  }
  const NamedSizes named = named_sizes(known, options);
  for (std::size_t f = 0; f < named.face.size(); ++f) wanted.face[f] = std::min(wanted.face[f], named.face[f] / scale);
  wanted.points.insert(wanted.points.end(), named.points.begin(), named.points.end());
  const std::vector<SizeSample> given = samples_of_points(options, options.min_size.value_or(0));
  wanted.points.insert(wanted.points.end(), given.begin(), given.end());
  for (double& h : wanted.face) h = std::max(h * scale, options.min_size.value_or(0));
  wanted.at_place = sizes_at_places(known, choice, options, affordable);
  const bool graded = options.interior == SizeOptions::Interior::kGraded;
  wanted.ceiling = graded ? options.max_size.value_or(std::numeric_limits<double>::infinity()) : choice.base * scale;
  wanted.ceiling = std::max(wanted.ceiling, options.min_size.value_or(0));
  const auto [least, most] = std::minmax_element(wanted.face.begin(), wanted.face.end());
  wanted.automatic = choice.automatic && !options.min_size;
  wanted.even = !wanted.at_place && wanted.points.empty() && *least == *most;
  stage.count("base size", choice.base * scale);
  stage.count("extent", model_extent(surface));
  return wanted;
}

}  // namespace octafront
