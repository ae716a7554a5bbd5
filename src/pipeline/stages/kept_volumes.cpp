
#include "pipeline/stages/kept_volumes.h"

#include <octafront/quality.h>

#include "base/core/parallel.h"
#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/mesh/complex.h"
#include "improve/curved/curved.h"
#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "surface/remeshing/keep_volumes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Volumes are kept at no element's cost that is poorer than this afterwards, by beta or its least dihedral angle, and
/// poorer than it was.
constexpr double kGoodBeta = 0.35, kGoodAngle = 18;

struct Shape {
  double beta = 0, angle = 0;
};

Shape shape_of(const TetMesh& mesh, TetIndex t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  const Vec3 p = mesh.points[a], q = mesh.points[b], r = mesh.points[c], s = mesh.points[d];
  if (orient3d(p, q, r, s) <= 0) return {-1, 0};
  const auto angles = dihedral_angles(p, q, r, s);
  return {radius_ratio(p, q, r, s), *std::ranges::min_element(angles)};
}

/// Whether elements beside a boundary that moves stay as good as they were, or good.
class ElementsBeside {
 public:
  /// The surface's vertices are the mesh's first ones.
  ElementsBeside(TetMesh& mesh, const SurfaceMesh& surface) : mesh_(mesh), surface_(surface) {
    const auto first = static_cast<VertexIndex>(surface.points.size());
    for (TetIndex t = 0; t < mesh.tets.size(); ++t)
      if (std::ranges::any_of(mesh.tets[t], [&](VertexIndex v) { return v < first; })) tets_.push_back(t);
    before_.resize(tets_.size());
    parallel_for(tets_.size(), [&](std::size_t i) { before_[i] = shape_of(mesh_, tets_[i]); });
  }

  /// The mesh follows the surface; the surface's vertices of elements that are poor then.
  std::vector<VertexIndex> spoilt() {
    std::copy(surface_.points.begin(), surface_.points.end(), mesh_.points.begin());
    std::vector<std::uint8_t> is_poor(tets_.size(), 0);
    parallel_for(tets_.size(), [&](std::size_t i) {
      const Shape now = shape_of(mesh_, tets_[i]), was = before_[i];
      is_poor[i] = now.beta < std::min(was.beta, kGoodBeta) || now.angle < std::min(was.angle, kGoodAngle);
    });
    std::vector<VertexIndex> found;
    for (std::size_t i = 0; i < tets_.size(); ++i)
      for (const VertexIndex v : mesh_.tets[tets_[i]])
        if (is_poor[i] != 0 && v < surface_.points.size()) found.push_back(v);
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  TetMesh& mesh_;
  const SurfaceMesh& surface_;
  std::vector<TetIndex> tets_;
  std::vector<Shape> before_;
};

/// Mean length of the edges of a region's walls.
double edge_of(const SurfaceMesh& surface, std::uint32_t region) {
  double sum = 0;
  std::size_t edges = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Sides sides = surface.sides_of(t);
    if (sides[0] != region && sides[1] != region) continue;
    const auto& [a, b, c] = surface.triangles[t];
    sum += distance(surface.points[a], surface.points[b]) + distance(surface.points[b], surface.points[c]) +
           distance(surface.points[c], surface.points[a]);
    edges += 3;
  }
  return edges == 0 ? 0 : sum / static_cast<double>(edges);
}

/// What chords cut off falls with the square of their length: sizes that come to half of what may be lost.
double size_that_keeps(double edge, double change) {
  return edge * std::min(1.0, std::sqrt(0.5 * kVolumeKept / std::abs(change)));
}

/// What keeps a volume, and the size of elements at which it would stay; 0: not known.
struct Help {
  double size = 0;
  std::string words;
};

Help what_helps(const VolumeChange& change, double size, const Options& options) {
  if (keeps_surface(options)) return {0, "its triangles were kept, but vertices on it have moved"};
  if (traits_of(options.method).makes_own_boundary())
    return {size, fmt::format("parts thinner than an element are lost: ask for elements of about {:.2g}, or for a "
                              "`gap` of 2 or more",
                              size)};
  const std::string there = change.region.empty() ? "" : fmt::format(": `size_of` {}={:.2g}", change.region, size);
  std::string smaller =
      fmt::format("elements of about {:.2g} there would keep it within {:g} %{}", size, 100 * kVolumeKept, there);
  const std::string by_itself = fmt::format("`volume_tolerance` {:g} makes smaller ones by itself", 100 * kVolumeKept);
  if (!options.surface.keep_volumes)
    return {size, fmt::format("{}; `keep_volumes` moves vertices instead, {}", smaller, by_itself)};
  return {size,
          fmt::format("its vertices lie on lines that stay, or would move by more than a fifth of an edge; {}; {}",
                      smaller, by_itself)};
}

auto help_on(const SurfaceMesh& walls, const Options& options) {
  return [&](const VolumeChange& change) {
    return what_helps(change, size_that_keeps(edge_of(walls, change.number), change.part()), options);
  };
}

Finding finding_of(const VolumeChange& change, const Help& help) {
  const std::string of = change.region.empty() ? "the mesh" : fmt::format("region \"{}\"", change.region);
  Finding found;
  found.code = change.part() < 0 ? "volume-lost" : "volume-gained";
  found.region = change.region;
  found.text = fmt::format("{} has {:.4g} % of its volume in the {} ({:.6g} of {:.6g}, {:+.2f} %): {}", of,
                           100 * change.made / change.before, change.is_cad ? "CAD file" : "input", change.made,
                           change.before, 100 * change.part(), help.words);
  found.values = {{"input_volume", change.before}, {"volume", change.made}, {"change_percent", 100 * change.part()}};
  if (help.size > 0) found.values.emplace_back("size_that_keeps", help.size);
  return found;
}

Finding finding_of_more(const VolumeChange& worst, std::size_t count) {
  Finding found;
  found.code = "volumes-changed";
  found.text = fmt::format(
      "{} more regions are off by more than {:g} % of their volume, by {:+.2f} % at most: the JSON "
      "report has the volumes of all",
      count, 100 * kVolumeKept, 100 * worst.part());
  found.values = {{"regions", static_cast<double>(count)}, {"change_percent", 100 * worst.part()}};
  return found;
}

/// Of what is off by more than kVolumeKept, the worst first; help(change) says what keeps it.
template <class HelpOf>
void note_changes(std::vector<VolumeChange> off, const Stage& stage, const HelpOf& help) {
  constexpr std::size_t kMost = 10;  // that are told one by one
  std::erase_if(off, [](const VolumeChange& change) { return std::abs(change.part()) <= kVolumeKept; });
  std::ranges::stable_sort(off, std::greater{}, [](const VolumeChange& c) { return std::abs(c.part()); });
  for (std::size_t i = 0; i < std::min(off.size(), kMost); ++i) stage.note(finding_of(off[i], help(off[i])));
  if (off.size() > kMost) stage.note(finding_of_more(off[kMost], off.size() - kMost));
}

}  // namespace

std::vector<double> wanted_volumes(const Prepared& input, const Domain& domain) {
  std::vector<double> wanted = input.volumes;
  for (std::size_t r = 0; r < std::min(wanted.size(), domain.true_volumes.size()); ++r)
    if (domain.true_volumes[r] > 0) wanted[r] = domain.true_volumes[r];
  return wanted;
}

/// What vertices may leave so that triangles come nearer: not the true geometry.
static const KnownSurface* fitted(const Prepared& input) {
  return input.geometry == nullptr ? &input.surface : nullptr;
}

void keep_surface_volumes(const Prepared& input, Remeshed& made, const Run& run, const Stage& stage) {
  // Opposite faces of a cell stay copies of each other.
  if (!run.options.surface.keep_volumes || !run.options.periodic.empty()) return;
  const std::vector<double> wanted = input.volumes.empty() ? volumes_of_regions(input.surface.mesh()) : input.volumes;
  const std::uint64_t moved = surface::keep_volumes_clean(
      made.surface, made.features, wanted, vertices_on_faces(made.surface, input.cell), fitted(input), stage.context());
  stage.count("vertices moved for volumes", static_cast<double>(moved));
}

void keep_mesh_volumes(const Prepared& input, const std::vector<double>& wanted, Filled& filled, Run& run) {
  const Options& options = run.options;
  // Elements of second order follow the smooth surface, which has the volume.
  const bool is_other = filled.layers || options.order > 1 || keeps_surface(options) ||
                        traits_of(options.method).makes_own_boundary() || wanted.empty() || !options.periodic.empty();
  if ((!options.surface.keep_volumes && !owes_volume(input, filled.boundary, run)) || is_other) return;
  run.stage("volumes", [&](const Stage& stage) {
    SurfaceMesh& surface = filled.boundary.surface;
    ElementsBeside beside(filled.mesh, surface);
    const TooFar too_far = [&] {
      std::vector<VertexIndex> back = beside.spoilt();
      return back.empty() ? surface::vertices_in_crossings(surface) : back;
    };
    const std::uint64_t moved =
        keep_volumes(surface, filled.boundary.features, wanted, too_far, vertices_on_faces(surface, input.cell),
                     run.options.surface.keep_volumes ? fitted(input) : nullptr, stage.context());
    std::copy(surface.points.begin(), surface.points.end(), filled.mesh.points.begin());
    stage.count("vertices moved for volumes", static_cast<double>(moved));
  });
}

void describe_needed(const SurfaceMesh& walls, double size, Report& report) {
  constexpr double kRegularTriangle = 0.4330127;  // its area over the square of its edge
  for (RegionSummary& region : report.regions) region.needed = region.volume / (kRegularTet * size * size * size);
  if (report.regions.size() < 2) return;
  std::map<Sides, WallSummary> between;
  for (std::size_t t = 0; t < walls.triangles.size(); ++t) {
    Sides sides = walls.sides_of(t);
    if (sides[0] > sides[1]) std::swap(sides[0], sides[1]);
    WallSummary& wall = between[sides];
    ++wall.triangles;
    wall.area += triangle_area(walls.points, walls.triangles[t]);
  }
  for (auto& [sides, wall] : between) {
    for (int i = 0; i < 2; ++i) wall.regions[i] = sides[i] == kNone ? "outside" : region_name(walls, sides[i]);
    wall.needed = wall.area / (kRegularTriangle * size * size);
    report.walls.push_back(std::move(wall));
  }
  const auto surplus = [](const WallSummary& w) { return static_cast<double>(w.triangles) - w.needed; };
  std::ranges::stable_sort(report.walls, std::ranges::greater(), surplus);
}

void describe_input_volumes(const Prepared& input, const Filled& filled, Report& report) {
  // The bodies of one surface are regions of the mesh, and their volumes are known together.
  const bool is_by_region = input.volumes.size() > 1 || report.regions.size() == 1;
  for (std::size_t r = 0; is_by_region && r < std::min(report.regions.size(), input.volumes.size()); ++r)
    report.regions[r].input_volume = input.volumes[r];
  if (!filled.layers || report.regions.empty()) return;
  std::vector<double> volumes;
  for (const RegionSummary& region : report.regions) volumes.push_back(region.volume);
  const std::vector<double> of_layers = layers_volumes(filled, volumes);
  for (std::size_t r = 0; r < report.regions.size(); ++r) report.regions[r].layers_volume = of_layers[r];
}

void describe_volumes_of(const TetMesh& before, Report& report) {
  if (before.region.empty()) return;
  const std::vector<double> volumes = curved_volumes(before);
  for (std::size_t r = 0; r < std::min(report.regions.size(), volumes.size()); ++r)
    report.regions[r].input_volume = volumes[r];
}

std::vector<VolumeChange> volume_changes(const Report& report) {
  const auto is_known = [](const RegionSummary& r) { return r.true_volume > 0 || r.input_volume > 0; };
  if (std::ranges::none_of(report.regions, is_known)) {
    const double before = report.true_volume > 0 ? report.true_volume : report.input_volume;
    if (!(before > 0)) return {};
    return {{"", 0, before, report.volume, report.true_volume > 0}};
  }
  std::vector<VolumeChange> changes;
  for (std::uint32_t r = 0; r < report.regions.size(); ++r) {
    const RegionSummary& region = report.regions[r];
    const double before = region.true_volume > 0 ? region.true_volume : region.input_volume;
    if (!(before > 0)) continue;
    const std::string name = region_label(region.name, r, report.regions.size());
    changes.push_back({name, r, before, region.volume + region.layers_volume, region.true_volume > 0});
  }
  return changes;
}

void note_volumes(const Prepared& input, const Filled& filled, const Options& options, const Report& report,
                  const Stage& stage) {
  if (input.volumes.empty()) return;
  note_changes(volume_changes(report), stage, help_on(filled.boundary.surface, options));
}

void note_volumes(const Prepared& input, const SurfaceMesh& made, const Options& options, const Stage& stage) {
  std::vector<VolumeChange> changes;
  const std::vector<double> volumes = volumes_of_regions(made);
  for (std::uint32_t r = 0; r < std::min(volumes.size(), input.volumes.size()); ++r)
    if (input.volumes[r] > 0)
      changes.push_back({is_complex(made) ? region_name(made, r) : "", r, input.volumes[r], volumes[r], false});
  note_changes(std::move(changes), stage, help_on(made, options));
}

void note_volumes_of_mesh(const Report& report, const Stage& stage) {
  note_changes(volume_changes(report), stage, [](const VolumeChange&) {
    return Help{0, "`max_deviation` keeps walls nearer to where they were"};
  });
}

}  // namespace octafront
