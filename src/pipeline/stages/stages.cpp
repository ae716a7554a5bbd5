#include "pipeline/stages/stages.h"

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/limits.h>
#include <octafront/validity.h>

#include "base/core/parallel.h"
#include "base/core/utf8.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"
#include "base/mesh/complex_patches.h"
#include "base/mesh/feature_patches.h"
#include "base/shared/shared_defects.h"
#include "fill/lattice/stuff.h"
#include "improve/curved/curved.h"
#include "improve/schedule/raise_flat.h"
#include "improve/schedule/schedule.h"
#include "improve/schedule/slide_interfaces.h"
#include "periodic/slide_pairs.h"
#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/kept_volumes.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/shell.h"
#include "sizing/field/expected_tets.h"
#include "sizing/sources/budget.h"
#include "sizing/sources/curvature.h"
#include "sizing/sources/make_size_field.h"
#include "sizing/sources/sources.h"
#include "soup/tidy/examine.h"
#include "surface/remeshing/mend_folds.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/core.h>

namespace octafront {

namespace {

// Doubles that lie too few steps apart leave no room for vertices between them.
constexpr double kLeastExtent = 1e-12;  // diagonal over the largest coordinate

void refuse_lost_precision(const SurfaceMesh& surface) {
  const Box3 box = bounding_box(surface.points);
  const Vec3 far = max(box.hi, -box.lo);
  const double largest = std::max({far.x, far.y, far.z});
  if (box.diagonal() < kLeastExtent * largest)
    throw InputError(fmt::format(
        "the model is {:.3g} across but lies {:.3g} away from the origin: double precision has too few points "
        "there to mesh it. Move the model to the origin.",
        box.diagonal(), largest));
}

// Over area times diagonal; a sheet of a thousandth of its width has a hundred times as much.
constexpr double kLeastVolume = 1e-6;

void refuse_complex_for_method(const SurfaceMesh& surface, Method method) {
  if (surface.sides.empty() || traits_of(method).fills_complexes) return;
  throw OptionError(fmt::format(
      "{} regions or sheets are given, and this method fills one region only: choose method octree-aft or recover",
      region_count(surface)));
}

// Defects are refused, but by the octree method, which lives with them: then they are notes.
SurfaceDomain::Defects judge_defects(const SurfaceDefects& found, Method method, const Stage& stage) {
  if (found.clean()) return SurfaceDomain::Defects::kClean;
  if (traits_of(method).needs_clean || found.no_faces) throw DefectsError(found);
  stage.note("the surface has defects; inside is where its winding number says so. " + found.describe());
  const bool closed =
      found.open_edges.count == 0 && found.non_manifold_edges.count == 0 && found.misoriented_edges.count == 0;
  return closed ? SurfaceDomain::Defects::kClosed : SurfaceDomain::Defects::kOpen;
}

// An open surface has no outside that repair could find: what it nearly encloses says which way it faces.
void face_outward(Examined& found) {
  SurfaceMesh& surface = found.repaired.surface;
  const double volume = enclosed_volume(surface), scale = area(surface) * bounding_box(surface.points).diagonal();
  if (std::abs(volume) < kLeastVolume * scale)
    throw InputError("the surface is flat, or as much inside out as not: it encloses no volume that could be filled");
  if (volume > 0) return;
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  found.edges = make_edge_table(surface.points.size(), surface.triangles);
}

// With sizes of our own choosing the surface stays true by default; sizes that the user gave are left as they are.
constexpr double kAutomaticDeviation = 0.004;  // of the diagonal; sampled, so that 0.005 is kept in all
/// The surface is not made anew for a few places that stray so many times as far.
constexpr double kAutomaticSlack = 1.03;

/// Elements that sizes of our own choice come to at most, by the prediction; HUGE_VAL if the user chose them, or how
/// near the surface stays.
double budget_of(const SurfaceMesh& surface, const Options& options) {
  const bool bounds = options.surface.max_deviation || options.surface.normal_deviation || keeps_surface(options);
  return bounds ? HUGE_VAL : automatic_budget(surface, options.size) / traits_of(options.method).tets_per_expected;
}

// Where sizes are given, detail is what is smaller than this part of them.
constexpr double kDetail = 0.1;

// Of no gradation that the user chose: strips between lines are narrow places that little else is near.
constexpr double kRiseFromStrips = 0.3;

// Parts of CAD are full of strips: edges of faces, fillets, leads. Automatic sizes are served there by elements twice
// as large as a strip is wide, and rise at once from it: fifteen parts have 30 % fewer elements, none below 17 degrees.
constexpr double kPerStripOfGeometry = 2, kRiseFromStripsOfGeometry = 0.7;

// Of a size that is given: strips between lines that are narrower are served as they come.
constexpr double kNarrowOfGiven = 1.0 / 3;

// Between voxels, where elements are coarser: torn sheets a voxel thick (five bands of a skull .72; atlases .17 to .5).
constexpr double kMostSeamsOfVoxels = 0.6;

// Of true geometry a size that is given follows curvature by so many elements a turn, as is usual with CAD.
constexpr double kTurnsOfGeometry = 12;

// Of a deviation that the user bounds, what unfolding may use up: the new surface keeps the rest, and improvement too.
constexpr double kUnfolded = 0.25;

/// What the surface may stray where that was said: a bound, or with automatic sizes the distance that they shall keep.
std::optional<double> asked_deviation(const Options& options) {
  if (options.surface.max_deviation || !has_automatic_sizes(options)) return options.surface.max_deviation;
  return options.size.chord_error;
}

/// What is smaller is detail. Of a deviation that the user bounds, `part`.
double scale_of_detail(const SurfaceMesh& surface, const Options& options, double part) {
  const double automatic = kAutomaticDeviation * bounding_box(surface.points).diagonal();
  if (const auto asked = asked_deviation(options)) return std::min(automatic, part * *asked);
  return options.size.size ? std::min(automatic, kDetail * *options.size.size) : automatic;
}

/// Up to here detail of the input may be smoothed over; 0: it is all kept.
double detail_tolerance(const SurfaceMesh& surface, const Options& options, double part) {
  const bool keeps_all =
      keeps_surface(options) || traits_of(options.method).makes_own_boundary() || !surface.sides.empty();
  return keeps_all ? 0 : scale_of_detail(surface, options, part);
}

// The boundary of a stuffed mesh in the place of a triangulated surface.
Remeshed boundary_of_stuffed(const TetMesh& mesh, const SizeField& sizes, double feature_angle) {
  SurfaceMesh surface{{}, mesh.boundary, mesh.patch, mesh.patch_names, {}};
  surface.patch_labels = mesh.patch_labels;
  VertexIndex vertices = 0;
  for (const Triangle& t : surface.triangles) vertices = std::max(vertices, 1 + std::max({t[0], t[1], t[2]}));
  surface.points.assign(mesh.points.begin(), mesh.points.begin() + vertices);
  Features features = detect_features(surface, feature_angle);
  return {std::move(surface), std::move(features), {}, sizes};
}

/// The octree method makes its boundary itself.
Filled stuff(const Prepared& input, const SizeField& sizes, Run& run) {
  TetMesh mesh = run.stage(traits_of(run.options.method).stage, [&](const Stage& stage) {
    TetMesh stuffed = stuff_surface(input.surface.mesh(), input.surface.features(), input.defects, sizes, stage);
    stage.count("tets", static_cast<double>(stuffed.tets.size()));
    return stuffed;
  });
  for (std::uint32_t& triangle : mesh.source) triangle = input.surface.mesh().source_of(triangle);
  Remeshed boundary = boundary_of_stuffed(mesh, sizes, run.options.surface.angle_of_features());
  return {std::move(mesh), std::move(boundary)};
}

bool may_slide(const ImproveOptions& options) {
  return options.move_boundary && options.level != ImproveOptions::Level::kOff &&
         options.level != ImproveOptions::Level::kPaper;
}

// Corners of elements that stayed flat may leave the surface by this part of what it may stray.
constexpr double kRaised = 0.5;

/// What the boundary itself keeps poor: vertices of interfaces slide, and corners of flat elements leave the surface.
void ease_boundary(const improve::BoundaryInput& on, Filled& filled, const Options& options, const Stage& stage) {
  auto& [mesh, boundary, grown, tets] = filled;
  if (is_complex(on.surface))
    stage.count("interface vertices moved",
                static_cast<double>(slide_interfaces(mesh, boundary.surface, boundary.features, on.surface, stage)));
  if (const double limit = scale_of_detail(on.surface, options, 1) * kRaised; limit > 0) {
    improve::FlatWalls walls(on.surface, on.tree, on.features);
    RaiseLimits limits{limit, nullptr, &walls, nullptr, nullptr, limit / kRaised, &on.frozen};
    const Leeway leeway(on.surface, on.tree, on.bound);
    std::optional<improve::InputForce> force;
    // Between walls of a complex, as near to each other as one likes, there is no other way out.
    if (!is_complex(on.surface)) {
      force.emplace(on);
      limits.leeway = &leeway, limits.force = &*force, limits.input = &on.tree;
    }
    const RaisedFlat raised = raise_flat(mesh, boundary.surface, limits, stage, tets);
    stage.count("corners of flat elements moved", static_cast<double>(raised.vertices));
    stage.count("largest move of such a corner", raised.largest_move);
  }
  std::copy_n(mesh.points.begin(), boundary.surface.points.size(), boundary.surface.points.begin());
}

/// Whether ranks have shares of the elements from filling to improvement, which puts them in order. What else is done
/// to them in between wants them all.
bool may_share(const Prepared& input, const Run& run) {
  const bool is_improved = run.options.improve.level != ImproveOptions::Level::kOff;
  return !run.comm().alone() && traits_of(run.options.method).shares_tets && is_improved &&
         !is_complex(input.surface.mesh()) && !input.cell.is_periodic() && run.options.layers.count == 0;
}

/// Vertices inside periodic faces, which improvement leaves alone, with their copies.
void slide_together(const PeriodicCell& cell, Filled& filled, const Stage& stage) {
  const std::uint64_t moves = slide_pairs(filled.mesh, filled.boundary.surface, cell, stage);
  stage.count("moves of pairs of vertices", static_cast<double>(moves));
  std::copy_n(filled.mesh.points.begin(), filled.boundary.surface.points.size(),
              filled.boundary.surface.points.begin());
}

// Folds, flaps and blades below the tolerance are taken away: no element could fill them. Returns how far that moved
// each triangle.
std::vector<double> smooth_detail(Examined& found, Run& run) {
  SurfaceMesh& surface = found.repaired.surface;
  const double tolerance = detail_tolerance(surface, run.options, kUnfolded);
  if (tolerance == 0) return {};
  return run.stage("detail", [&](const Stage& stage) {
    auto unfolded = surface::unfold(surface, found.edges, tolerance, stage.context());
    stage.count("folds mended", unfolded ? static_cast<double>(unfolded->mended.operations) : 0);
    if (!unfolded) return std::vector<double>{};
    const double change = change_of_volume(enclosed_volume(unfolded->surface), run.report.input_volume);
    if (std::abs(change) > kVolumeKept) {
      stage.note(fmt::format("folds and blades stay: without them the volume is {:+.1f} % off", 100 * change));
      return std::vector<double>{};
    }
    stage.count("folds left", static_cast<double>(unfolded->mended.folds_left));
    stage.count("largest move", unfolded->mended.largest_move);
    stage.note(fmt::format("the surface was unfolded in {} steps, by {:.3g} at most: `max_deviation` 0 keeps all folds",
                           unfolded->mended.operations, unfolded->mended.largest_move));
    surface = std::move(unfolded->surface);
    found.edges = make_edge_table(surface.points.size(), surface.triangles);
    return std::move(unfolded->mended.moved);
  });
}

/// What unfolding leaves of the bound on the deviation, if the user gave one.
std::vector<double> left_of_bound(std::vector<double> moved, const Options& options) {
  const auto asked = asked_deviation(options);
  if (!asked) return {};
  for (double& d : moved) d = *asked - d;
  return moved;
}

void require_bounds(const Domain& mended) {
  if (mended.bound.empty()) return;
  if (mended.bound.size() != mended.surface.triangles.size())
    throw OptionError(fmt::format("there are {} bounds for {} triangles: give one for each, or none",
                                  mended.bound.size(), mended.surface.triangles.size()));
  const auto wrong = std::ranges::find_if(mended.bound, [](double b) { return !(b > 0); });
  if (wrong != mended.bound.end())
    throw OptionError(fmt::format("the bound of triangle {} is {}: it is a length above 0, or infinite",
                                  wrong - mended.bound.begin(), *wrong));
}

/// What is known of a surface beforehand.
struct Known {
  bool is_clean = false;
  bool has_true_folds = false;  ///< they are the body's own, not noise
  bool may_coarsen = false;     ///< it is no image's, which was coarsened before, nor CAD
};

Known known_of(const Domain& domain) {
  return {.is_clean = domain.found_clean != 0 && domain.found_clean == fingerprint(domain.surface),
          .has_true_folds = domain.geometry != nullptr && !domain.true_volumes.empty(),
          .may_coarsen = domain.voxel_spacing == 0 && domain.geometry == nullptr};
}

/// Of arrays: readers have done so already.
void clean_names(SurfaceMesh& surface, const Stage& stage) {
  NameCleaning names;
  names.clean(surface.patch_names);
  names.clean(surface.region_names);
  if (std::string note = names.note(); !note.empty()) stage.note(std::move(note));
}

/// The bounds of a mended domain, for triangles whose sources are its own; these then are those of its triangles.
std::vector<double> bounds_by_source(const Domain& mended, SurfaceMesh& surface) {
  std::vector<double> bound;
  std::vector<std::uint32_t> source;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    bound.push_back(mended.bound[surface.source_of(t)]);
    source.push_back(mended.surface.source_of(surface.source_of(t)));
  }
  surface.source = std::move(source);
  return bound;
}

/// Of a clean surface with far more triangles than sizes need.
void coarsen(Examined& found, Run& run) {
  std::optional<SurfaceMesh> coarse = coarse_surface(found.repaired.surface, run);
  if (!coarse) return;
  found.repaired.surface = std::move(*coarse);
  found.edges = make_edge_table(found.repaired.surface.points.size(), found.repaired.surface.triangles);
}

/// `mended`: null, or what the soup is of, without sources.
Prepared prepare(const SurfaceMesh& soup, const Domain* mended, Known known, Run& run) {
  SurfaceDomain::Defects defects{};
  Examined found = run.stage("repair", [&](const Stage& stage) {
    Examined examined = examine_surface(soup, known.is_clean, stage.context());
    const RepairedSurface& repaired = examined.repaired;
    for (const std::string& note : repaired.notes) stage.note(note);
    refuse_complex_for_method(repaired.surface, run.options.method);
    defects = judge_defects(examined.defects, run.options.method, stage);
    if (defects == SurfaceDomain::Defects::kOpen) face_outward(examined);
    refuse_lost_precision(repaired.surface);
    stage.count("triangles", static_cast<double>(repaired.surface.triangles.size()));
    stage.count("bodies", repaired.bodies);
    stage.count("cavities", repaired.cavities);
    if (is_complex(repaired.surface)) divide_by_sides(examined.repaired.surface);
    // One region that touches itself goes the way of complexes, where each triangle has a patch.
    if (!repaired.surface.sides.empty()) examined.repaired.surface.patch.resize(repaired.surface.triangles.size(), 0);
    clean_names(examined.repaired.surface, stage);
    return examined;
  });
  run.report.input_volume = enclosed_volume(found.repaired.surface);
  std::vector<double> volumes;
  if (defects == SurfaceDomain::Defects::kClean) volumes = volumes_of_regions(found.repaired.surface);
  if (defects == SurfaceDomain::Defects::kClean && known.may_coarsen) coarsen(found, run);
  const bool is_plain = found.repaired.surface.sides.empty();
  std::vector<double> moved;
  // Folds at faces of a periodic cell would come off one of them alone.
  const bool may_unfold = is_plain && !known.has_true_folds && run.options.periodic.empty();
  if (defects == SurfaceDomain::Defects::kClean && may_unfold) moved = smooth_detail(found, run);
  const bool unfolded = !moved.empty();
  SurfaceMesh& surface = found.repaired.surface;
  ClosedPatch closed = take_closed_patch(surface, found.edges);
  Features features = run.stage("features", [&](const Stage& stage) {
    Features of_surface = detect_features(surface, found.edges, run.options.surface.angle_of_features());
    stage.count("feature edges", static_cast<double>(of_surface.edges.size()));
    stage.count("corners", static_cast<double>(of_surface.corners.size()));
    if (run.options.surface.patches_by_features)
      stage.count("patches", divide_into_patches(surface, found.edges, of_surface));
    return of_surface;
  });
  run.report.bodies = found.repaired.bodies;
  std::vector<double> bound =
      mended ? bounds_by_source(*mended, surface) : left_of_bound(std::move(moved), run.options);
  return {KnownSurface(std::move(surface), std::move(found.edges), std::move(features)),
          defects,
          std::move(bound),
          unfolded,
          std::move(volumes),
          std::move(closed)};
}

Prepared on_geometry(const Domain& domain, Prepared prepared) {
  prepared.geometry = domain.geometry.get();
  return prepared;
}

/// prepare(), but for periods.
Prepared prepare_aperiodic(const Domain& domain, Run& run) {
  const SurfaceOptions& asked = run.options.surface;
  const bool heeds_bounds = asked.volume_tolerance || (has_automatic_sizes(run.options) && !asked.max_deviation);
  if (domain.bound.empty() || !heeds_bounds)
    return on_geometry(domain, prepare(domain.surface, nullptr, known_of(domain), run));
  SurfaceMesh numbered = domain.surface;
  numbered.source.clear();
  return on_geometry(domain, prepare(numbered, &domain, {}, run));
}

}  // namespace

SurfaceOptions true_to_input(const SurfaceMesh& input, const Options& options) {
  SurfaceOptions surface = options.surface;
  if (!surface.max_deviation && has_automatic_sizes(options)) {
    // Who asks for coarser elements has chords that lie farther off; those of second order bend to the surface.
    const double bend = options.order > 1 ? kSecondOrderEdge * kSecondOrderEdge : 1;
    const double coarser = bend * std::max(1.0, options.size.automatic_factor);
    const double automatic = coarser * kAutomaticDeviation * bounding_box(input.points).diagonal();
    surface.max_deviation = std::min(automatic, asked_deviation(options).value_or(automatic));
  }
  return surface;
}

Prepared prepare(const Domain& domain, Run& run) {
  require_bounds(domain);
  if (std::optional<PeriodicDomain> periodic = made_periodic(domain, run)) {
    Prepared prepared = prepare_aperiodic(periodic->domain, run);
    prepared.cell = std::move(periodic->cell);
    find_faces_of_patches(prepared.surface.mesh(), prepared.cell);
    return prepared;
  }
  if (const std::optional<Domain> coarse = coarse_domain(domain, run)) {
    Prepared prepared = prepare_aperiodic(*coarse, run);
    if (!prepared.volumes.empty()) prepared.volumes = volumes_of_regions(domain.surface);
    run.report.input_volume = enclosed_volume(domain.surface);
    return prepared;
  }
  return prepare_aperiodic(domain, run);
}

SizeField choose_sizes(const Prepared& input, Run& run) {
  SizeField sizes = run.stage("size field", [&](const Stage& stage) {
    SizeOptions size = run.options.size;
    take_places_in_space(size);
    const double budget = budget_of(input.surface.mesh(), run.options);
    if (std::isfinite(budget)) stage.count("budget of elements", budget);
    if (const auto asked = asked_deviation(run.options); !size.field && asked != 0.0) size.chord_error = asked;
    if (const auto degrees = run.options.surface.normal_deviation)
      refuse_huge_turning(input.surface, size, *degrees, run.context());
    note_misplaced_sizes(input.surface.mesh(), size, stage);
    return keeps_surface(run.options)
               ? size_field_of_surface(input.surface, size, stage)
               : make_size_field(
                     input.surface, size, stage,
                     {input.bound, input.closed.is_in_it, run.options.surface.volume_tolerance.has_value(),
                      input.geometry ? kTurnsOfGeometry : 0, run.options.order > 1, run.options.surface.finest},
                     budget);
  });
  const MethodTraits& method = traits_of(run.options.method);
  const SurfaceMesh& surface = input.surface.mesh();
  if (keeps_surface(run.options))
    run.report.expected_tets = method.tets_per_expected * expected_tets_within(sizes, surface) +
                               expected_layer_tets(surface, run.options.layers);
  else if (method.makes_own_boundary())
    run.report.expected_tets = method.tets_per_expected * expected_tets(sizes, surface);
  return sizes;
}

Remeshed triangulate(const Prepared& input, const SizeField& sizes, Run& run) {
  if (keeps_surface(run.options)) return input_as_it_is(input.surface, sizes);
  return run.stage("surface front", [&](const Stage& stage) {
    const SurfaceOptions surface = true_to_input(input.surface.mesh(), run.options);
    const double slack = surface.max_deviation == run.options.surface.max_deviation ? 1 : kAutomaticSlack;
    const double budget = budget_of(input.surface.mesh(), run.options);
    const SizeOptions& size = run.options.size;
    const bool is_coarse = input.geometry != nullptr && has_automatic_sizes(run.options);
    const FrontLimits limits{.slack = slack,
                             .budget = budget,
                             .least = std::max(size.min_size.value_or(0), surface.finest),
                             .narrowest_strip = kNarrowOfGiven * size.size.value_or(0),
                             .rise = size.gradation ? 0
                                     : is_coarse    ? kRiseFromStripsOfGeometry
                                                    : kRiseFromStrips,
                             .per_strip = is_coarse ? kPerStripOfGeometry : 0,
                             .most_seams = surface.finest > 0 ? kMostSeamsOfVoxels : HUGE_VAL};
    Remeshed remeshed = remeshed_in_shape(
        input, sizes, run, stage,
        [&](const SizeField& by) {
          Remeshed made = remesh_surface(input.surface, by, surface, stage, input.kept_bound(), limits, input.cell);
          keep_surface_volumes(input, made, run, stage);
          return made;
        },
        budget);
    stage.count("triangles", static_cast<double>(remeshed.surface.triangles.size()));
    // Strips between lines and the bounds on deviation have made sizes smaller since the first prediction.
    run.report.expected_tets =
        traits_of(run.options.method).tets_per_expected * expected_tets_within(remeshed.sizes, remeshed.surface) +
        expected_layer_tets(remeshed.surface, run.options.layers) +
        expected_shell_tets(remeshed, run.options.volume.shell);
    return remeshed;
  });
}

Filled fill(const Prepared& input, const SizeField& sizes, Run& run) {
  if (traits_of(run.options.method).makes_own_boundary()) return stuff(input, sizes, run);
  Remeshed surface = triangulate(input, sizes, run);
  require_expected_elements(run.report.expected_tets);
  return fill_surface(input, std::move(surface), run);
}

Comm comm_of(const Filled& filled, const Run& run) {
  return filled.tets == Tets::kShare ? run.comm() : Comm(nullptr);
}

std::uint64_t element_count(const Filled& filled, const Run& run) {
  return count_tets(filled.mesh, comm_of(filled, run)).all;
}

void make_whole(Filled& filled, const Run& run) {
  if (std::exchange(filled.tets, Tets::kAll) == Tets::kShare) gather_tets(filled.mesh, run.comm());
}

Filled fill_surface(const Prepared& input, Remeshed boundary, Run& run) {
  const MethodTraits& method = traits_of(run.options.method);
  std::optional<GrownLayers> layers = grow_layers(input, boundary, run);
  const Tets tets = may_share(input, run) ? Tets::kShare : Tets::kAll;
  TetMesh mesh = run.stage(method.stage, [&](const Stage& stage) {
    TetMesh filled = method.fill(boundary, run.options.volume, stage, tets);
    const std::uint64_t made = tets == Tets::kShare ? count_tets(filled, run.comm()).all : filled.tets.size();
    stage.count("tets", static_cast<double>(made));
    return filled;
  });
  mesh.source.reserve(mesh.boundary.size());
  for (std::size_t t = 0; t < boundary.source.size(); ++t)
    if (boundary.surface.sides_of(t)[0] == kNone)
      mesh.source.push_back(input.surface.mesh().source_of(boundary.source[t]));
  return {std::move(mesh), std::move(boundary), std::move(layers), tets};
}

void improve_elements(const Prepared& input, Filled& filled, Run& run, const ImproveOptions& options) {
  run.stage("improve", [&](const Stage& stage) {
    auto& [mesh, boundary, grown, tets] = filled;
    const bool is_ours =
        !filled.layers && !keeps_surface(run.options) && input.defects == SurfaceDomain::Defects::kClean;
    std::optional<improve::BoundaryInput> on;
    if (is_ours)
      on.emplace(improve::BoundaryInput{
          input.surface.mesh(), input.surface.tree(), input.surface.features(), boundary.features,
          detail_tolerance(input.surface.mesh(), run.options, input.unfolded ? 1 - kUnfolded : 1), boundary.near_limit,
          input.kept_bound(), vertices_on_faces(boundary.surface, input.cell)});
    const bool slides_pairs = on && may_slide(options) && input.cell.is_periodic();
    if (slides_pairs) slide_together(input.cell, filled, stage);
    if (improve_mesh(mesh, on ? &*on : nullptr, options, stage, &boundary.features, tets)) {
      if (on) renew_sources(mesh, hull_of(boundary.surface), on->surface, on->tree);
      follow_boundary(mesh, boundary.surface);
    }
    if (slides_pairs) slide_together(input.cell, filled, stage);
    if (on && may_slide(options)) ease_boundary(*on, filled, run.options, stage);
  });
}

void raise_order(const Prepared& input, Filled& filled, Run& run) {
  if (run.options.order < 2) return;
  run.stage(stage_of_order(run.options.order), [&](const Stage& stage) {
    const int order = run.options.order;
    TetMesh& mesh = filled.mesh;
    Remeshed& boundary = filled.boundary;
    const std::span<const VertexIndex> below = vertices_below(filled);
    run.report.second_order = on_ground(filled, [&] {
      if (keeps_surface(run.options)) return add_straight_edges(mesh, order, stage.context());
      if (input.geometry) return curve_to_geometry(mesh, *input.geometry, below, order, stage.context());
      return curve_to_surface(mesh, boundary.features.edges, input.surface, run.options.surface.angle_of_features(),
                              below, vertices_on_faces(boundary.surface, input.cell), order, stage.context());
    });
    pair_mid_nodes(mesh, input.cell, stage);
    std::copy_n(mesh.points.begin(), boundary.surface.points.size(), boundary.surface.points.begin());
    count_edges(run.report.second_order, stage);
  });
}

void name_patches(const Prepared& input, Filled& filled) {
  if (input.closed.patch == kNone) return;
  name_closed_patch(input.closed, input.surface.tree(), filled.mesh);
  name_closed_patch(input.closed, input.surface.tree(), filled.boundary.surface);
}

const char* stage_of_order(int order) {
  return order == 2 ? "second order" : order == 3 ? "order 3" : "order 4";
}

void count_edges(const SecondOrderSummary& made, const Stage& stage) {
  stage.count("curved edges", static_cast<double>(made.curved));
  stage.count("eased edges", static_cast<double>(made.eased));
  stage.count("straight edges", static_cast<double>(made.straight));
}

namespace {

void require_none(const std::optional<std::string>& defect) {
  if (defect)
    throw MeshingError("the mesh made is not valid, which is a bug of ours; please report it with the input. " +
                       *defect);
}

}  // namespace

void check_result(const TetMesh& mesh, const SurfaceMesh* surface, Run& run) {
  run.stage("check", [&](const Stage& stage) {
    require_none(surface ? first_defect(mesh, *surface, stage.context()) : first_defect(mesh, stage.context()));
  });
}

void check_result(const Filled& filled, Run& run) {
  const SurfaceMesh& surface = filled.boundary.surface;
  if (filled.tets == Tets::kAll) return check_result(filled.mesh, &surface, run);
  run.stage("check", [&](const Stage& stage) {
    require_none(first_defect_of_shares(filled.mesh, surface, stage.context(), run.comm()));
  });
}

SurfaceMesh boundary_of(const TetMesh& mesh) {
  return {mesh.points, mesh.boundary, mesh.patch, {}, {}};
}

namespace {

void describe_contacts(const TetMesh& mesh, Report& report) {
  std::map<std::uint32_t, std::pair<std::uint64_t, double>> of;  // per patch triangles, area
  report.contacts.clear();
  if (mesh.opened_contacts.empty()) return;
  for (std::size_t f = 0; f < mesh.patch.size(); ++f) {
    const auto& [a, b, c] = mesh.boundary[f];
    auto& [triangles, area] = of[mesh.patch[f]];
    ++triangles, area += triangle_area(mesh.points[a], mesh.points[b], mesh.points[c]);
  }
  for (const auto& [first, second, conforming] : mesh.opened_contacts)
    report.contacts.push_back({{mesh.patch_names[first], mesh.patch_names[second]},
                               {of[first].first, of[second].first},
                               {of[first].second, of[second].second},
                               conforming != 0});
}

}  // namespace

void describe(const TetMesh& mesh, Report& report, const Comm& comm) {
  describe_contacts(mesh, report);
  report.points = mesh.points.size();
  report.boundary_faces = mesh.boundary.size();
  report.volume = mesh.order() > 1 ? curved_volume(mesh) : enclosed_volume(boundary_of(mesh));
  if (comm.alone()) {
    parallel_invoke([&] { describe_quality(mesh, report); }, [&] { report.hash = mesh_hash(mesh); });
  } else {
    describe_quality(mesh, report, comm);
    report.hash = mesh_hash(mesh, comm);
  }
  describe_regions(mesh, report, comm);
}

}  // namespace octafront
