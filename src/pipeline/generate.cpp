#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/validity.h>

#include "classic/fill_classic.h"
#include "core/thread_limit.h"
#include "improve/improve.h"
#include "mesh/features.h"
#include "pipeline/follow_boundary.h"
#include "pipeline/pipeline.h"
#include "pipeline/run_stage.h"
#include "recovery/recover.h"
#include "sizing/make_size_field.h"
#include "stuffing/stuff.h"
#include "surface/feature_patches.h"
#include "surface/remeshing/remesh.h"
#include "volume/fill.h"
#include "volume/regions.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace octafront {

namespace {

struct Prepared {
  RepairedSurface repaired;
  Features features;
  SurfaceDomain::Defects defects = SurfaceDomain::Defects::kClean;  ///< other than clean for Method::kOctree only
};

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

// Defects are refused, but by the octree method, which lives with them: then they are notes.
SurfaceDomain::Defects judge_defects(const SurfaceDefects& found, Method method, StageReport& stage) {
  if (found.clean()) return SurfaceDomain::Defects::kClean;
  if (method != Method::kOctree || found.no_faces) throw InputError(found.describe());
  stage.notes.push_back("the surface has defects; inside is where its winding number says so. " + found.describe());
  const bool closed =
      found.open_edges.count == 0 && found.non_manifold_edges.count == 0 && found.misoriented_edges.count == 0;
  return closed ? SurfaceDomain::Defects::kClosed : SurfaceDomain::Defects::kOpen;
}

// An open surface has no outside that repair could find: what it nearly encloses says which way it faces.
void face_outward(SurfaceMesh& surface) {
  const double volume = enclosed_volume(surface), scale = area(surface) * bounding_box(surface.points).diagonal();
  if (std::abs(volume) < kLeastVolume * scale)
    throw InputError("the surface is flat, or as much inside out as not: it encloses no volume that could be filled");
  if (volume > 0) return;
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
}

// What every run begins with: a surface that is known to be clean, or not to need to be.
Prepared prepare(const SurfaceMesh& input, const Options& options, const RunContext& context, Report& report) {
  check_options(options);
  Prepared p;
  p.repaired = run_stage(report, context, "repair", [&](StageReport& stage) {
    RepairedSurface repaired = repair_surface(input, options.face_of_triangle);
    stage.notes = repaired.notes;
    const SurfaceDefects defects = find_defects(repaired);
    p.defects = judge_defects(defects, options.method, stage);
    if (p.defects == SurfaceDomain::Defects::kOpen) face_outward(repaired.surface);
    refuse_lost_precision(repaired.surface);
    stage.count("triangles", static_cast<double>(repaired.surface.triangles.size()));
    stage.count("bodies", repaired.bodies);
    stage.count("cavities", repaired.cavities);
    return repaired;
  });
  p.features = run_stage(report, context, "features", [&](StageReport& stage) {
    Features features = detect_features(p.repaired.surface, options.surface.feature_angle);
    stage.count("feature edges", static_cast<double>(features.edges.size()));
    stage.count("corners", static_cast<double>(features.corners.size()));
    if (options.surface.patches_by_features) stage.count("patches", divide_into_patches(p.repaired.surface, features));
    return features;
  });
  report.bodies = p.repaired.bodies;
  report.input_volume = enclosed_volume(p.repaired.surface);
  return p;
}

SizeField size_stage(const Prepared& p, const Options& options, const RunContext& context, Report& report) {
  const SurfaceMesh& surface = p.repaired.surface;
  SizeField sizes = run_stage(report, context, "size field", [&](StageReport& stage) {
    SizeOptions size = options.size;
    if (!size.field) size.chord_error = options.surface.max_deviation;
    return options.surface.keep ? size_field_of_surface(surface, size, context, stage)
                                : make_size_field(surface, p.features, size, context, stage);
  });
  report.expected_tets = expected_tets(sizes, surface);
  return sizes;
}

// With sizes of our own choosing the surface stays true by default; sizes that the user gave are left as they are.
constexpr double kAutomaticDeviation = 0.004;  // of the diagonal; sampled, so that 0.005 is kept in all

SurfaceOptions true_to_input(const Prepared& p, const Options& options) {
  SurfaceOptions surface = options.surface;
  const SizeOptions& size = options.size;
  if (!surface.max_deviation && !size.size && !size.elements && !size.callback && !size.field &&
      size.point_sizes.empty())
    surface.max_deviation = kAutomaticDeviation * bounding_box(p.repaired.surface.points).diagonal();
  return surface;
}

// A body that loses more than this has lost details that somebody may want.
constexpr double kLargeLoss = 0.02;

void note_volume_loss(double made, double input, StageReport& stage) {
  const double change = made / input - 1;
  if (std::abs(change) < kLargeLoss) return;
  stage.notes.push_back(
      fmt::format("elements of this size change the volume by {:+.1f} %: --max-deviation makes them "
                  "smaller where they stray from the input",
                  100 * change));
}

Remeshed surface_stage(const Prepared& p, const SizeField& sizes, const Options& options, const RunContext& context,
                       Report& report) {
  return run_stage(report, context, "surface front", [&](StageReport& stage) {
    const SurfaceOptions surface = true_to_input(p, options);
    Remeshed remeshed = remesh_surface(p.repaired.surface, p.features, sizes, surface, context, stage);
    stage.count("triangles", static_cast<double>(remeshed.surface.triangles.size()));
    note_volume_loss(enclosed_volume(remeshed.surface), report.input_volume, stage);
    // Strips between lines and the bounds on deviation have made sizes smaller since the first prediction.
    report.expected_tets = expected_tets(remeshed.sizes, remeshed.surface);
    return remeshed;
  });
}

Remeshed keep_surface(const Prepared& p, const SizeField& sizes) {
  Remeshed kept{p.repaired.surface, p.features, {}, sizes};
  kept.source.resize(kept.surface.triangles.size());
  for (std::size_t t = 0; t < kept.source.size(); ++t) kept.source[t] = static_cast<std::uint32_t>(t);
  return kept;
}

TetMesh fill_by_recovery(const SurfaceMesh& surface, const RunContext& context, StageReport& stage) {
  TetMesh mesh = recover_volume(surface, context, stage);
  mesh.region = regions_of(mesh, surface);
  mesh.patch = surface.patch;
  return mesh;
}

TetMesh fill_by_method(const Remeshed& boundary, const Options& options, const RunContext& context, Report& report) {
  switch (options.method) {
    case Method::kOctreeAft:
      return run_stage(report, context, "volume front", [&](StageReport& stage) {
        return fill_volume(boundary.surface, boundary.sizes, options.volume, context, stage);
      });
    case Method::kAft:
      return run_stage(report, context, "volume front", [&](StageReport& stage) {
        return fill_volume_classic(boundary.surface, options.volume, context, stage);
      });
    case Method::kOctree:
      break;  // needs no triangulated boundary: see stuffing_stage
    case Method::kRecover:
      return run_stage(report, context, "recovery",
                       [&](StageReport& stage) { return fill_by_recovery(boundary.surface, context, stage); });
  }
  throw OptionError("there is no such method");
}

TetMesh volume_stage(const Remeshed& boundary, const std::vector<std::uint32_t>& face_of_triangle,
                     const Options& options, const RunContext& context, Report& report) {
  TetMesh mesh = fill_by_method(boundary, options, context, report);
  report.stages.back().count("tets", static_cast<double>(mesh.tets.size()));
  mesh.source.reserve(boundary.source.size());
  for (const std::uint32_t triangle : boundary.source) mesh.source.push_back(face_of_triangle[triangle]);
  mesh.patch_names = boundary.surface.patch_names;
  return mesh;
}

// A part of the volume of a clean surface that the octree method may miss without a word: its boundary is blunt.
constexpr double kVolumeTolerance = 0.03;

void note_lost_volume(const TetMesh& mesh, const Prepared& p, StageReport& stage) {
  if (p.defects != SurfaceDomain::Defects::kClean) return;
  const double share =
      enclosed_volume(SurfaceMesh{mesh.points, mesh.boundary, {}, {}}) / enclosed_volume(p.repaired.surface);
  if (std::abs(share - 1) > kVolumeTolerance)
    stage.notes.push_back(
        fmt::format("the mesh has {:.1f} % of the volume inside the surface: parts thinner than an "
                    "element are lost. Ask for smaller elements, or for --gap 2 or more.",
                    100 * share));
}

// The octree method makes its boundary itself.
TetMesh stuffing_stage(const Prepared& p, const SizeField& sizes, const RunContext& context, Report& report) {
  TetMesh mesh = run_stage(report, context, "stuffing", [&](StageReport& stage) {
    TetMesh stuffed = stuff_surface(p.repaired.surface, p.features, p.defects, sizes, context, stage);
    stage.count("tets", static_cast<double>(stuffed.tets.size()));
    note_lost_volume(stuffed, p, stage);
    return stuffed;
  });
  for (std::uint32_t& triangle : mesh.source) triangle = p.repaired.face_of_triangle[triangle];
  return mesh;
}

// The boundary of a stuffed mesh in the place of a triangulated surface.
Remeshed boundary_of_stuffed(const TetMesh& mesh, const SizeField& sizes, double feature_angle) {
  SurfaceMesh surface{{}, mesh.boundary, mesh.patch, mesh.patch_names};
  VertexIndex vertices = 0;
  for (const Triangle& t : surface.triangles) vertices = std::max(vertices, 1 + std::max({t[0], t[1], t[2]}));
  surface.points.assign(mesh.points.begin(), mesh.points.begin() + vertices);
  Features features = detect_features(surface, feature_angle);
  return {std::move(surface), std::move(features), {}, sizes};
}

void improve_stage(const Prepared& p, TetMesh& mesh, Remeshed& boundary, const Options& options,
                   const RunContext& context, Report& report) {
  run_stage(report, context, "improve", [&](StageReport& stage) {
    const bool moves = options.improve.move_boundary && !options.surface.keep && options.method != Method::kRecover &&
                       p.defects == SurfaceDomain::Defects::kClean;
    const TriangleTree tree = moves ? TriangleTree(p.repaired.surface) : TriangleTree({}, {});
    const improve::BoundaryInput input{p.repaired.surface, tree, p.features, boundary.features};
    if (!improve_mesh(mesh, moves ? &input : nullptr, options.improve, context, stage)) return;
    renew_sources(mesh, boundary.surface, tree, p.repaired.face_of_triangle);
    SurfaceMesh& surface = boundary.surface;  // what was filled follows what became of it; its vertices come first
    std::copy_n(mesh.points.begin(), surface.points.size(), surface.points.begin());
    surface.triangles = mesh.boundary;
  });
}

void check_result(const TetMesh& mesh, const SurfaceMesh& boundary, const RunContext& context, Report& report) {
  run_stage(report, context, "check", [&](StageReport&) {
    if (const auto defect = first_defect(mesh, boundary))
      throw MeshingError("the mesh made is not valid, which is a bug of ours; please report it with the input. " +
                         *defect);
  });
}

// Surface, volume and improvement by given sizes; `boundary` is left as the surface that was filled.
TetMesh mesh_by_sizes(const Prepared& p, const SizeField& sizes, const Options& options, const RunContext& context,
                      Report& report, Remeshed& boundary) {
  if (options.method == Method::kOctree) {
    TetMesh mesh = stuffing_stage(p, sizes, context, report);
    boundary = boundary_of_stuffed(mesh, sizes, options.surface.feature_angle);
    return mesh;
  }
  boundary = options.surface.keep ? keep_surface(p, sizes) : surface_stage(p, sizes, options, context, report);
  return volume_stage(boundary, p.repaired.face_of_triangle, options, context, report);
}

// The prediction misses when a model is mostly surface; then what came out says by how much to scale.
constexpr double kElementsTolerance = 0.12;  // tighter than the 15 % promised: improvement still changes the count
constexpr int kElementsAttempts = 5;
// The classical front makes 1.1 to 1.4 times the elements that the sizes promise: begin with larger ones.
constexpr double kClassicSizeFactor = 1.07;

// By how much to scale the first sizes next, by the counts of the last two meshes. The count falls with the third power
// of the sizes where the volume decides, more slowly where gradation or details of the surface do.
class CountSearch {
 public:
  explicit CountSearch(std::int64_t wanted) : wanted_(std::log(static_cast<double>(wanted))) {}

  double next_factor(std::size_t made) {
    const double count = std::log(static_cast<double>(made));
    if (last_count_ && scale_ != last_scale_)
      slope_ = std::clamp((count - *last_count_) / (scale_ - last_scale_), -4.0, -1.5);
    last_count_ = count;
    last_scale_ = scale_;
    scale_ += (wanted_ - count) / slope_;
    return std::exp(scale_);
  }

 private:
  double wanted_, scale_ = 0, last_scale_ = 0, slope_ = -3;
  std::optional<double> last_count_;
};

double miss(const SizeOptions& options, std::size_t tets) {
  return std::abs(std::log(static_cast<double>(tets) / static_cast<double>(options.elements.value_or(1))));
}

bool meets_target(const SizeOptions& options, std::size_t tets) {
  if (!options.elements) return true;
  const double ratio = static_cast<double>(tets) / static_cast<double>(*options.elements);
  return std::abs(ratio - 1) <= kElementsTolerance;
}

void note_missed_target(const Options& options, std::size_t made, StageReport& stage) {
  if (meets_target(options.size, made)) return;
  stage.notes.push_back(fmt::format("{} elements were wanted; the {} do not allow it: {} made", *options.size.elements,
                                    options.surface.keep ? "kept triangles" : "features and size limits", made));
}

struct Try {
  TetMesh mesh;
  Remeshed boundary;
  SizeField sizes;
};

TetMesh mesh_to_target(const Prepared& p, SizeField& sizes, const Options& options, const RunContext& context,
                       Report& report, Remeshed& boundary) {
  const std::size_t first_stage = report.stages.size();
  CountSearch search(options.size.elements.value_or(1));
  Try best{mesh_by_sizes(p, sizes, options, context, report, boundary), boundary, sizes};
  std::size_t made = best.mesh.tets.size();
  for (int attempt = 1; attempt < kElementsAttempts && !meets_target(options.size, made); ++attempt) {
    if (options.surface.keep) break;  // the kept triangles decide
    const double factor = search.next_factor(made);
    for (std::size_t s = first_stage; s < report.stages.size(); ++s) {
      if (!report.stages[s].name.ends_with("(earlier try)")) report.stages[s].name += " (earlier try)";
    }
    Try next{{}, boundary, scaled(sizes, factor)};
    next.mesh = mesh_by_sizes(p, next.sizes, options, context, report, next.boundary);
    report.stages.back().notes.push_back(
        fmt::format("the mesh before had {} elements where {} were wanted: all sizes scaled by {:.4g}", made,
                    *options.size.elements, factor));
    made = next.mesh.tets.size();
    // The lattice doubles its cells: counts may jump over the target, and an earlier mesh may be the better one.
    if (miss(options.size, made) < miss(options.size, best.mesh.tets.size())) best = std::move(next);
  }
  boundary = std::move(best.boundary);
  sizes = best.sizes;
  note_missed_target(options, best.mesh.tets.size(), report.stages.back());
  return std::move(best.mesh);
}

void finish_report(const TetMesh& mesh, const SizeField& sizes, Report& report) {
  report.points = mesh.points.size();
  report.tets = mesh.tets.size();
  report.boundary_faces = mesh.boundary.size();
  SurfaceMesh boundary;
  boundary.points = mesh.points;
  boundary.triangles = mesh.boundary;
  report.volume = enclosed_volume(boundary);
  report.quality = summarize_quality(mesh);
  report.surface_edges = summarize_surface_edges(mesh.points, mesh.boundary, sizes);
  report.volume_edges = summarize_volume_edges(mesh, sizes);
  report.hash = mesh_hash(mesh);
}

}  // namespace

void close_report(Report& report) {
  for (const StageReport& stage : report.stages) {
    report.wall_seconds += stage.wall_seconds;
    report.cpu_seconds += stage.cpu_seconds;
  }
  report.peak_memory_bytes = peak_memory_bytes();
}

Result generate(const SurfaceMesh& surface, const Options& given, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  Options options = given;
  if (options.method == Method::kRecover) options.surface.keep = true;
  Report report;
  const Prepared prepared = prepare(surface, options, context, report);
  SizeField sizes = size_stage(prepared, options, context, report);
  if (options.method == Method::kAft && options.size.elements && !options.surface.keep)
    sizes = scaled(sizes, kClassicSizeFactor);
  Remeshed boundary = keep_surface(prepared, sizes);
  TetMesh mesh = mesh_to_target(prepared, sizes, options, context, report, boundary);
  improve_stage(prepared, mesh, boundary, options, context, report);
  check_result(mesh, boundary.surface, context, report);
  finish_report(mesh, boundary.sizes, report);
  close_report(report);
  return {std::move(mesh), boundary.sizes, std::move(report)};
}

SurfaceResult generate_surface(const SurfaceMesh& surface, const Options& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  Report report;
  const Prepared prepared = prepare(surface, options, context, report);
  const SizeField sizes = size_stage(prepared, options, context, report);
  Remeshed made =
      options.surface.keep ? keep_surface(prepared, sizes) : surface_stage(prepared, sizes, options, context, report);
  report.points = made.surface.points.size();
  report.boundary_faces = made.surface.triangles.size();
  report.volume = enclosed_volume(made.surface);
  report.surface_edges = summarize_surface_edges(made.surface.points, made.surface.triangles, made.sizes);
  close_report(report);
  return {std::move(made.surface), made.sizes, std::move(report)};
}

SizeResult generate_sizes(const SurfaceMesh& surface, const Options& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  Report report;
  const Prepared prepared = prepare(surface, options, context, report);
  SizeField sizes = size_stage(prepared, options, context, report);
  const bool has_front = options.method == Method::kOctreeAft || options.method == Method::kAft;
  if (has_front && !options.surface.keep) sizes = surface_stage(prepared, sizes, options, context, report).sizes;
  close_report(report);
  return {std::move(sizes), std::move(report)};
}

}  // namespace octafront
