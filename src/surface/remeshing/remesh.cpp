#include "surface/remeshing/remesh.h"

#include "sizing/make_size_field.h"
#include "surface/remeshing/coarsen.h"
#include "surface/remeshing/crossings.h"
#include "surface/remeshing/deviation.h"
#include "surface/remeshing/improve.h"
#include "surface/remeshing/insertion.h"
#include "surface/remeshing/narrow_strips.h"
#include "surface/remeshing/point_grid.h"
#include "surface/remeshing/source_triangles.h"
#include "surface/remeshing/turning.h"
#include "surface/surface_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/core.h>

namespace octafront {

namespace {

using namespace remeshing;

/// Rounds of capping the sizes around what crosses. CT isosurfaces of half a million triangles need up to 16.
constexpr int kMostRounds = 24;
/// Sizes around crossing triangles become this part of what they were.
constexpr double kCap = 0.6;
/// The same where the new surface strays too far from the input, and for how many rounds.
constexpr double kDeviationCap = 0.7;
constexpr int kMostDeviationRounds = 5;

struct Counts {
  std::uint64_t placed = 0, tried = 0;
  InsertionCounts insertion;
  CoarsenCounts coarsen;
  ImproveCounts improve;
  std::uint64_t crossings = 0;
  int rounds = 0, deviation_rounds = 0;
};

/// The parts of the working mesh that are alive, numbered anew in their order.
struct Compacted {
  Remeshed result;
  std::vector<std::uint32_t> vertex_face;  ///< per vertex: an input face that it lies in
  std::vector<std::uint8_t> is_inner;      ///< per vertex: not on a feature
};

Compacted compacted(const WorkingMesh& mesh, const SurfaceMesh& input, const SizeField& sizes) {
  Compacted c{{{}, {}, {}, sizes}, {}, {}};
  SurfaceMesh& s = c.result.surface;
  std::vector<VertexIndex> old_to_new(mesh.points.size(), kNone);
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (mesh.outgoing[v] == kNone) continue;
    old_to_new[v] = static_cast<VertexIndex>(s.points.size());
    s.points.push_back(mesh.points[v]);
    c.vertex_face.push_back(mesh.face[v]);
    c.is_inner.push_back(mesh.is_free(v));
    if (mesh.kind[v] == VertexKind::kCorner) c.result.features.corners.push_back(old_to_new[v]);
  }
  s.patch_names = input.patch_names;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.is_removed(t)) continue;
    Triangle triangle;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const HalfEdge h = 3 * t + i;
      triangle[i] = old_to_new[mesh.start[h]];
      if (mesh.is_feature[h] && h < mesh.twin[h]) {
        const VertexIndex a = triangle[i], b = old_to_new[mesh.end(h)];
        c.result.features.edges.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    s.triangles.push_back(triangle);
    if (!input.patch.empty()) s.patch.push_back(mesh.patch[t]);
  }
  std::sort(c.result.features.edges.begin(), c.result.features.edges.end());
  return c;
}

/// How much of the input's triangulation an attempt may change.
enum class Effort { kFull, kInsertOnly };

std::vector<Vec3> centers_of(const SurfaceMesh& surface, const std::vector<std::array<std::uint32_t, 2>>& pairs) {
  std::vector<std::uint32_t> triangles;
  for (const auto& [s, t] : pairs) triangles.insert(triangles.end(), {s, t});
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  std::vector<Vec3> centers;
  for (const std::uint32_t t : triangles) {
    const auto [a, b, c] = surface.triangles[t];
    centers.push_back((surface.points[a] + surface.points[b] + surface.points[c]) / 3);
  }
  return centers;
}

/// The sizes made smaller around the places; of those within half a size of each other one is enough.
SizeField capped_around(const SizeField& sizes, const std::vector<Vec3>& places, double factor,
                        const RunContext& context) {
  std::vector<Vec3> kept;
  PointGrid grid(places.front());
  for (const Vec3 p : places) {
    const double h = sizes.at(p);
    bool is_new = true;
    grid.for_each_near(p, h, 0.5, [&](std::uint32_t, Vec3) { is_new = false; });
    if (!is_new) continue;
    kept.push_back(p);
    grid.add(p, h);
  }
  return capped_near(sizes, kept, factor, context);
}

void report_counts(const Counts& counts, const Stage& stage) {
  stage.count("points placed", static_cast<double>(counts.placed));
  stage.count("places tried", static_cast<double>(counts.tried));
  stage.count("points inserted", static_cast<double>(counts.insertion.inserted));
  stage.count("points skipped", static_cast<double>(counts.insertion.skipped));
  stage.count("collapses", static_cast<double>(counts.coarsen.collapses));
  stage.count("flips", static_cast<double>(counts.coarsen.flips + counts.improve.flips));
  stage.count("smoothing moves", static_cast<double>(counts.improve.moves));
  stage.count("input vertices left", static_cast<double>(counts.coarsen.input_vertices_left));
  stage.count("crossing pairs mended", static_cast<double>(counts.crossings));
  stage.count("rounds", counts.rounds);
  stage.count("rounds for deviation", counts.deviation_rounds);
}

/// Attempts with ever smaller sizes where the last one was not good enough.
class Remesher {
 public:
  Remesher(const KnownSurface& surface, const SizeField& sizes, const SurfaceOptions& options, const Stage& stage)
      : known_(surface),
        surface_(surface.mesh()),
        sizes_(sizes),
        options_(options),
        stage_(stage),
        input_(make_input_surface(surface)),
        kind_(surface_, surface.edges()) {}

  Remeshed run() {
    for (counts_.rounds = 1; counts_.rounds <= kMostRounds; ++counts_.rounds) {
      Compacted c = attempt(Effort::kFull);
      if (is_sound(c) && is_true(c)) return finished(c);
    }
    Compacted c = attempt(Effort::kInsertOnly);
    if (is_sound(c)) {
      stage_.note("the surface's own vertices were kept: coarser triangles would cross");
      c.result.source = sources_of(c);
      return finished(c);
    }
    report_counts(counts_, stage_);
    stage_.note("the surface was kept as it is: every other triangulation tried crosses itself");
    return input_as_it_is(known_, sizes_);
  }

 private:
  /// One triangulation by the sizes as they are now.
  Compacted attempt(Effort effort) {
    const RunContext& context = stage_.context();
    progress(0);
    set_features(input_, {});
    set_features(input_, features_at_scale(input_, known_.features(), sizes_));
    const SizeField sizes = fitted_to_strips(input_, sizes_, context);
    std::vector<Curve> curves = chain_curves(input_, known_.features().corners, sizes);
    divide_curves(input_, sizes, curves);
    progress(0.05);
    const FrontPoints front = place_points(input_, curves, sizes, context);
    counts_.placed = front.points.size();
    counts_.tried = front.candidates;
    counts_.insertion = {};
    counts_.coarsen = {};
    counts_.improve = {};
    progress(0.4);
    WorkingMesh mesh = insert_points(input_, curves, front, context, counts_.insertion);
    progress(0.5);
    if (effort == Effort::kFull) {
      remove_input_vertices(mesh, context, counts_.coarsen);
      progress(0.6);
      improve_surface(mesh, input_, curves, sizes, context, counts_.improve);
    } else {
      counts_.coarsen.input_vertices_left = surface_.points.size();
    }
    progress(0.9);
    return compacted(mesh, surface_, sizes);
  }

  /// Nobody knows how many rounds there will be: each takes half of what is left.
  void progress(double part_of_round) const {
    stage_.progress(1 - std::ldexp(1 - part_of_round / 2, 1 - counts_.rounds));
  }

  std::vector<std::uint32_t> sources_of(const Compacted& c) const {
    return source_triangles(input_, surface_, c.result.surface, c.vertex_face, c.is_inner);
  }

  /// Whether the surface is clean and of the input's kind; otherwise the sizes are made smaller.
  bool is_sound(const Compacted& c) {
    const auto crossings = find_crossings(c.result.surface);
    counts_.crossings += crossings.size();
    if (!crossings.empty()) {
      sizes_ = capped_around(sizes_, centers_of(c.result.surface, crossings), kCap, stage_.context());
      return false;
    }
    if (const auto defect = kind_.first_defect_but_crossings(c.result.surface)) {
      stage_.note("an attempt was dropped: " + *defect);
      sizes_ = scaled(sizes_, kCap, stage_.context());
      return false;
    }
    return true;
  }

  /// Whether the surface is as near to the input as was asked, or could be made so in the rounds allowed; otherwise the
  /// sizes are made smaller. Leaves the sources.
  bool is_true(Compacted& c) {
    const bool is_last = counts_.rounds == kMostRounds || counts_.deviation_rounds == kMostDeviationRounds;
    std::vector<Vec3> far;
    if (options_.max_deviation) far = places_beyond(*options_.max_deviation, c.result.surface, surface_, known_.tree());
    c.result.source = sources_of(c);
    std::vector<PointSize> turned;
    if (options_.normal_deviation) {
      turned = turned_places(*options_.normal_deviation, c.result.surface, input_, sizes_, c.vertex_face, c.is_inner,
                             c.result.source);
    }
    if ((far.empty() && turned.empty()) || is_last) {
      if (options_.max_deviation) stage_.count("places beyond the deviation", static_cast<double>(far.size()));
      if (options_.normal_deviation) stage_.count("triangles turned too far", static_cast<double>(turned.size()));
      note_what_is_left(far.size(), turned.size());
      return true;
    }
    ++counts_.deviation_rounds;
    if (!far.empty()) sizes_ = capped_around(sizes_, far, kDeviationCap, stage_.context());
    sizes_ = capped_at(sizes_, turned, stage_.context());
    return false;
  }

  /// What the user asked for and does not get.
  void note_what_is_left(std::size_t far, std::size_t turned) {
    if (far > 0)
      stage_.note(fmt::format("{} places lie farther than {:.4g} from the input still: a smaller size helps", far,
                              *options_.max_deviation));
    if (turned > 0)
      stage_.note(
          fmt::format("{} triangles turn by more than {:.4g} degrees against the input still: it is "
                      "rough there, or turns sharply without a feature edge",
                      turned, *options_.normal_deviation));
  }

  Remeshed finished(Compacted& c) {
    report_counts(counts_, stage_);
    return std::move(c.result);
  }

  const KnownSurface& known_;
  const SurfaceMesh& surface_;  ///< of known_
  SizeField sizes_;
  const SurfaceOptions& options_;
  const Stage& stage_;
  InputSurface input_;
  SurfaceKind kind_;
  Counts counts_;
};

}  // namespace

Remeshed input_as_it_is(const KnownSurface& surface, const SizeField& sizes) {
  Remeshed kept{surface.mesh(), surface.features(), {}, sizes};
  kept.source.resize(kept.surface.triangles.size());
  std::iota(kept.source.begin(), kept.source.end(), 0u);
  return kept;
}

Remeshed remesh_surface(const KnownSurface& surface, const SizeField& sizes, const SurfaceOptions& options,
                        const Stage& stage) {
  return Remesher(surface, sizes, options, stage).run();
}

}  // namespace octafront
