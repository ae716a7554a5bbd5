#include "sizing/sources/wanted_sizes.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "sizing/field/affordable.h"
#include "sizing/sources/curvature.h"
#include "sizing/sources/gaps.h"
#include "sizing/sources/model_extent.h"
#include "sizing/sources/sources.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// The automatic choice. Curvature of 12 elements per turn keeps chords within 3.4 % of the radius of curvature.
constexpr double kAutomaticCurvature = 12;
constexpr double kAutomaticFeatureElements = 1;
constexpr double kAutomaticGap = 1;
/// Sources that follow details stop at this part of the base size unless min_size says otherwise: a spike or a crease
/// of noise must not ask for elements without bound.
constexpr double kAutomaticFloor = 1.0 / 5;
constexpr double kChosenFloor = 1.0 / 200;
/// Chords cut corners: the automatic choice is scaled until the volume lost so, as predicted, is below this part.
constexpr double kVolumeLoss = 0.01;
constexpr double kLeastAutomaticScale = 0.3;
/// Slender bodies would have ever more elements for the same part: it is this much more for each unit of slenderness,
/// to a part at most that 13 elements a turn keep. They get their volume back when the surface is made.
constexpr double kLossPerSlenderness = 0.00025, kMostVolumeLoss = 0.03, kLeastScaleOfSlender = 0.02;
/// Of a given size what is asked for where the body is round and thinner.
constexpr double kRoundFloor = 1.0 / 32;
/// Sizes for eleven elements to a turn may be so many times as large: of eight a rod has its volume back by moves of
/// vertices.
constexpr double kCoarsestThin = 11.0 / 8;

/// What the user's options come to, once defaults are filled in.
struct Choice {
  bool automatic = false;
  double base = 0, floor = 0, gap_floor = 0;
  double chosen_floor = 0;  ///< where it is no automatic choice
  double curvature_floor = 0;
  double curvature = 0, gap = 0, feature_elements = 0;  ///< 0: not asked
};

bool has_automatic_base(const SizeOptions& o) {
  return !o.size && !o.curvature && !o.gap && !o.feature_elements && !o.facets && !o.callback && !o.mesh &&
         o.point_sizes.empty();
}

/// Who asks for the base size.
std::string name_of_base(const SizeOptions& o, double base) {
  if (o.max_size && base == *o.max_size && base != o.size.value_or(0)) return "`max_size`";
  if (o.size) return "`size`";
  if (o.min_size && base == *o.min_size) return "`min_size`";
  return o.callback || o.mesh || !o.point_sizes.empty() ? kNobody : "the automatic choice";
}

double largest_size(const SizeMesh& mesh) {
  return *std::ranges::max_element(mesh.point_sizes.empty() ? mesh.element_sizes : mesh.point_sizes);
}

Choice choose(const SurfaceMesh& surface, const SizeOptions& o, const FaceRules& rules) {
  Choice c;
  c.automatic = has_automatic_base(o);
  const double coarser = rules.curved ? kSecondOrderEdge : 1, ours = coarser * base_size(surface);
  c.base = o.size.value_or(ours);
  // Sizes at points and a function speak for the whole surface: there is no need of a size where nobody asks, and ours
  // would cut what they ask for.
  if (!o.size && o.callback) c.base = model_extent(surface);
  if (!o.size && o.mesh) c.base = largest_size(*o.mesh);
  if (!o.size && !o.point_sizes.empty()) c.base = std::ranges::max_element(o.point_sizes, {}, &PointSize::size)->size;
  if (o.max_size) c.base = o.size || c.automatic ? std::min(c.base, *o.max_size) : *o.max_size;
  c.base = std::max(c.base, o.min_size.value_or(0));
  const double usual = o.callback && !o.size ? std::min(c.base, ours) : c.base;
  c.chosen_floor = o.min_size.value_or(usual * kChosenFloor);
  c.floor = c.automatic ? o.min_size.value_or(usual * kAutomaticFloor / coarser) : c.chosen_floor;
  c.gap_floor = o.min_size.value_or(usual * (c.automatic ? kAutomaticFloor / coarser : kChosenFloor));
  c.gap = o.gap.value_or(c.automatic ? kAutomaticGap : 0);
  const bool turns = o.size && !o.curvature && rules.turns > 0;
  c.curvature = o.curvature.value_or(c.automatic ? kAutomaticCurvature : turns ? rules.turns : 0);
  c.curvature_floor = turns ? o.min_size.value_or(c.base * kLeastOfGiven) : c.floor;
  c.feature_elements = o.feature_elements.value_or(c.automatic ? kAutomaticFeatureElements : 0);
  return c;
}

/// Facet areas averaged over each triangle and its neighbours, as sizes: the side of a square of that area. This is the
/// paper's rule, by which a leaf is divided while its face is larger than the facets inside it.
void apply_facets(const SurfaceMesh& surface, const FaceNeighbours& across, double floor, std::vector<double>& face) {
  std::vector<double> areas;
  for (const Triangle& t : surface.triangles) areas.push_back(triangle_area(surface.points, t));
  for (std::size_t f = 0; f < areas.size(); ++f) {
    double sum = areas[f];
    int n = 1;
    for (const std::uint32_t g : across[f]) {
      if (g != kNone) sum += areas[g], ++n;
    }
    face[f] = std::min(face[f], std::max(floor, std::sqrt(sum / n)));
  }
}

double automatic_scale(const SurfaceMesh& surface, const SurfaceCurvature& curvature, const std::vector<double>& face) {
  const double loss = predicted_volume_loss(surface, curvature, face) / std::abs(enclosed_volume(surface));
  const double slender = slenderness(surface);
  const bool is_slender = slender > kSlender;
  const double allowed = is_slender ? std::min(kMostVolumeLoss, kLossPerSlenderness * slender) : kVolumeLoss;
  const double least = is_slender ? kLeastScaleOfSlender : kLeastAutomaticScale;
  return loss > allowed ? std::max(least, std::sqrt(allowed / loss)) : 1;
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

double tets_in_gaps(const SurfaceMesh& surface, const GapFinder& gaps, double elements, const Affordable& affordable) {
  return affordable.tets_at_places([&](std::size_t f) {
    const auto& [i, j, k] = surface.triangles[f];
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[k];
    return gaps.measure({centroid(a, b, c), unit_normal(a, b, c), static_cast<std::uint32_t>(f)}) / elements;
  });
}

/// Elements across what is measured. A wall below a floor of our own choosing cannot be resolved: the thinner it is,
/// the less small elements do for it, and the larger they may be.
SizeAtPlace sizes_across(std::shared_ptr<GapFinder> gaps, double elements, double floor, bool is_ours) {
  SizeAtPlace across;
  across.at = [gaps = std::move(gaps), elements, floor, is_ours](const PlaceOnSurface& place) {
    const double h = gaps->width(place) / elements;
    if (h >= floor) return h;
    return is_ours ? floor * (floor / h) : floor;
  };
  return across;
}

/// The sources that are asked place by place, in one function; empty if there are none. Each is entered by its name.
SizeAtPlace sizes_at_places(const KnownSurface& surface, const Choice& choice, const SizeOptions& options,
                            const Affordable& affordable, const std::vector<SizeInSpace>& in_space,
                            SourceShares& sources) {
  SizeAtPlace gap, through;
  if (choice.gap > 0) {
    const auto gaps = std::make_shared<GapFinder>(surface, choice.gap_floor, choice.base * choice.gap,
                                                  options.gap ? Measured::kWallsAndGaps : Measured::kWalls);
    if (options.gap) affordable.require("gap", choice.gap, tets_in_gaps(surface.mesh(), *gaps, choice.gap, affordable));
    gap = sizes_across(gaps, choice.gap, choice.gap_floor, !options.min_size);
    sources.add("`gap`", gap);
  }
  if (options.through) {
    const double floor = options.min_size.value_or(choice.base * kChosenFloor);
    const auto walls = std::make_shared<GapFinder>(surface, floor, choice.base * *options.through, Measured::kWalls);
    affordable.require("through", *options.through, tets_in_gaps(surface.mesh(), *walls, *options.through, affordable));
    through = sizes_across(walls, *options.through, floor, !options.min_size);
    sources.add("`through`", through);
  }
  SizeAtPlace given = given_sizes(surface.mesh(), options);
  if (given && options.min_size) {
    given.at = [given = given.at, floor = *options.min_size](const PlaceOnSurface& s) {
      return std::max(floor, given(s));
    };
  }
  sources.add(options.callback ? "the function of sizes" : "`point_sizes`", given);
  const double least = options.min_size.value_or(0);
  for (const SizeInSpace& source : in_space) sources.add(source.name, least_at_places({source}, least));
  return least_of(least_of(gap, through), least_of(given, least_at_places(in_space, least)));
}

/// How a surface bends, found once and only if somebody asks.
class Bends {
 public:
  Bends(const KnownSurface& known, const std::vector<Edge>& borders, const RunContext& context)
      : known_(known), borders_(borders), context_(context) {}

  const FaceNeighbours& across() {
    if (!across_) across_ = smooth_face_neighbours(known_.edges(), borders_);
    return *across_;
  }
  const SurfaceCurvature& curvature() {
    if (!curvature_) curvature_ = surface_curvature(known_.mesh(), across(), context_);
    return *curvature_;
  }

 private:
  const KnownSurface& known_;
  const std::vector<Edge>& borders_;
  const RunContext& context_;
  std::optional<FaceNeighbours> across_;
  std::optional<SurfaceCurvature> curvature_;
};

/// What facets and curvature ask of faces. Returns what all sizes are to be multiplied by for the volume.
double apply_shape(const SurfaceMesh& surface, const Choice& choice, const SizeOptions& options, const FaceRules& rules,
                   Bends& bends, const Affordable& affordable, std::vector<double>& face, SourceShares& sources) {
  const bool limits_chords = options.chord_error || !rules.chord_errors.empty();
  const bool needs_curvature = choice.curvature > 0 || limits_chords;
  if (!options.facets && !needs_curvature) return 1;
  if (options.facets) apply_facets(surface, bends.across(), choice.floor, face);
  sources.changed("`facets`", face);
  if (!needs_curvature) return 1;
  const SurfaceCurvature& curvature = bends.curvature();
  refuse_huge_curvature(affordable, options, curvature);
  const auto error_of = [&](std::size_t f) {
    return std::min(options.chord_error.value_or(HUGE_VAL),
                    rules.chord_errors.empty() ? HUGE_VAL : rules.chord_errors[f]);
  };
  if (limits_chords)
    apply_chord_errors(curvature, error_of, rules.must_hold ? choice.chosen_floor : choice.floor, face);
  sources.changed("`max_deviation`", face);
  if (choice.curvature > 0) apply_curvature(curvature, choice.curvature, choice.curvature_floor, face);
  sources.changed("`curvature`", face);
  // What chords cut off comes back where they bend.
  return choice.automatic && !rules.curved ? automatic_scale(surface, curvature, face) : 1;
}

std::vector<SizeSample> samples_of_features(const SurfaceMesh& surface, const Choice& choice,
                                            const SizeOptions& options, const Features& features,
                                            const Affordable& affordable) {
  if (!(choice.feature_elements > 0)) return {};
  const std::vector<FeatureCurve> curves = feature_curves(surface, features);
  if (options.feature_elements) {
    double tets = 0;
    for (const FeatureCurve& curve : curves)
      tets += affordable.tets_around(curve.length, curve.length / choice.feature_elements);
    affordable.require("feature_elements", choice.feature_elements, tets);
  }
  return feature_samples(surface, curves, choice.feature_elements, choice.floor, choice.base);
}

/// Where the body is thin and round: sizes that keep a needle's volume, and both sides of a tube apart. Not where there
/// is a least size for details, as images have, whose volumes are kept by moves of vertices. Coarser automatic sizes do
/// not follow automatic_factor beyond kCoarsestThin there.
SizeAtPlace sizes_of_thin(const KnownSurface& known, const SizeOptions& options, double least, Bends& bends,
                          WantedSizes& wanted, const Stage& stage) {
  if ((!options.size && !wanted.automatic) || least > 0) return {};
  const double beyond = wanted.automatic ? std::max(1.0, options.automatic_factor / kCoarsestThin) : 1;
  std::vector<double> face = wanted.face;
  for (double& h : face) h *= beyond;
  const double largest = *std::ranges::max_element(wanted.face);
  const double floor = std::max(options.min_size.value_or(0), kRoundFloor * largest);
  const auto enter = [&](const char* name, SizeAtPlace sizes, const char* what, const char* why) {
    if (sizes && beyond > 1) sizes.at = [at = sizes.at, beyond](const PlaceOnSurface& p) { return at(p) / beyond; };
    wanted.sources.add(name, sizes);
    if (sizes)
      stage.note(
          fmt::format("{} {:.4g} in places: elements are smaller there, or {}. `min_size` says how small they "
                      "may be",
                      what, beyond * largest, why));
    return sizes;
  };
  const SurfaceCurvature& curvature = bends.curvature();
  const SizeAtPlace round = enter("thin round places", sizes_in_round_places(known, curvature, face, floor),
                                  "the body is round and thinner than", "it would lose its volume");
  const SizeAtPlace walls = enter("thin curved walls", sizes_in_curved_walls(known, curvature, face, floor),
                                  "the body has curved walls much thinner than", "their two sides would cross");
  return least_of(round, walls);
}

void add_samples(std::vector<SizeSample>& samples, const std::vector<SizeSample>& more) {
  samples.insert(samples.end(), more.begin(), more.end());
}

}  // namespace

bool has_no_size_source(const SizeOptions& o) {
  return has_automatic_base(o) && !o.elements && !o.field && !o.min_size && o.regions.empty() && o.named.empty() &&
         o.near.empty() && !o.through;
}

WantedSizes WantedSizes::with(const std::function<double(double)>& change) const {
  WantedSizes result = *this;
  parallel_for(result.face.size(), [&](std::size_t f) { result.face[f] = change(result.face[f]); });
  for (SizeSample& s : result.points) s.h = change(s.h);
  result.ceiling = change(result.ceiling);
  if (at_place) result.at_place.at = [f = at_place.at, change](const PlaceOnSurface& p) { return change(f(p)); };
  return result;
}

WantedSizes wanted_sizes(const KnownSurface& known, const SizeOptions& options, const Stage& stage,
                         const FaceRules& rules) {
  const SurfaceMesh& surface = known.mesh();
  const double least_size = options.min_size.value_or(0);
  const Choice choice = choose(surface, options, rules);
  const Affordable affordable(surface, options);
  const ShapeLines lines = lines_of_shape(known, rules.is_invented);
  Bends bends(known, lines.borders, stage.context());
  WantedSizes wanted;
  wanted.face.assign(surface.triangles.size(), choice.base);
  wanted.sources.begin(name_of_base(options, choice.base), wanted.face);
  const double scale =
      apply_shape(known.mesh(), choice, options, rules, bends, affordable, wanted.face, wanted.sources);
  wanted.points = samples_of_features(surface, choice, options, lines.features, affordable);
  const NamedSizes named = named_sizes(known, options);
  for (std::size_t f = 0; f < named.face.size(); ++f) wanted.face[f] = std::min(wanted.face[f], named.face[f] / scale);
  wanted.sources.changed("`size_of`", wanted.face);
  add_samples(wanted.points, named.points);
  add_samples(wanted.points, samples_of_points(options, least_size));
  for (double& h : wanted.face) h *= scale;
  wanted.sources.scaled(wanted.face);
  for (double& h : wanted.face) h = std::max(h, least_size);
  wanted.sources.changed("`min_size`", wanted.face);
  const std::vector<SizeInSpace> in_space = sizes_in_space(known, options);
  add_samples(wanted.points, samples_inside(known, in_space, least_size, stage.context()));
  wanted.at_place = sizes_at_places(known, choice, options, affordable, in_space, wanted.sources);
  const bool is_graded = options.interior == SizeOptions::Interior::kGraded;
  wanted.ceiling = std::max(is_graded ? options.max_size.value_or(HUGE_VAL) : choice.base * scale, least_size);
  const auto [least, most] = std::minmax_element(wanted.face.begin(), wanted.face.end());
  wanted.automatic = choice.automatic && !options.min_size;
  wanted.at_place = least_of(wanted.at_place, sizes_of_thin(known, options, rules.least, bends, wanted, stage));
  wanted.even = !wanted.at_place && wanted.points.empty() && *least == *most;
  stage.count("base size", choice.base * scale);
  stage.count("extent", model_extent(surface));
  return wanted;
}

}  // namespace octafront
