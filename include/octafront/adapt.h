#pragma once

#include <octafront/domain.h>
#include <octafront/mesh_field.h>
#include <octafront/metric.h>
#include <octafront/options.h>
#include <octafront/report.h>
#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// The metric wanted at a point: a symmetric positive definite 3 x 3 tensor M in 1 / (input unit)^2. An edge e has the
/// wanted length where e^T M e = 1. Asked from several threads.
using MetricFunction = std::function<std::array<std::array<double, 3>, 3>(Vec3)>;

/// How a mesh fits the sizes or the metric that it was adapted to. Lengths of edges in the metric are (a - b) / ln(a /
/// b) of those at their ends; the quality of an element is its volume there to the power 2/3 over its mean squared
/// edge, 1 if regular, in the metric of its corner of greatest density (the measures of the Unstructured Grid
/// Adaptation Working Group).
struct MetricSummary {
  std::uint64_t edges = 0, fitting = 0;  ///< all edges, and those of lengths from sqrt(1/2) to sqrt 2
  double shortest = 0, longest = 0;
  std::uint64_t far = 0;         ///< edges shorter than half, or longer than twice of what is wanted
  Vec3 shortest_at, longest_at;  ///< middles of those edges; input units
  double quality_min = 0, quality_mean = 0;
  Vec3 quality_min_at;    ///< the middle of the worst element; input units
  double complexity = 0;  ///< the integral of sqrt(det M) over the mesh
};

/// How far the walls of a mesh that was adapted (boundary, interfaces, sheets) are from the smooth surface that the old
/// ones stand for, or from the surface that was given: the greater of both one-sided distances. lower <= distance <=
/// upper, up to a tenth of the tolerance for how the smooth surface is measured; input units.
struct WallDeviation {
  double bound = 0;  ///< what was to be kept: max_deviation, or without one .4 % of the diagonal or what old walls had
  double lower = 0, upper = 0;
  Vec3 place;  ///< `lower` away from the other surface
};

/// As JSON objects, keys as the fields above; deviation's place is "at".
std::string to_json(const MetricSummary& fit);
std::string to_json(const WallDeviation& deviation);

/// A mesh that was adapted, and what was done.
struct AdaptedMesh {
  TetMesh mesh;
  Report report;
  MetricSummary before, after;
  WallDeviation deviation;
  std::vector<VertexIndex> old_of_new;   ///< per vertex its number in the mesh that was given; kNone: new
  std::vector<TetIndex> old_tet_of_new;  ///< per tet the one that it was, with all corners at their places; kNone: new
};

/// Changes a valid mesh by splits, collapses, swaps and moves until its edges are as long as `options.size` wants them
/// (make_size_field, asked about the mesh's own boundary). Vertices of the boundary and of interfaces stay on the
/// smooth surface that the given ones stand for, within SurfaceOptions::max_deviation of it, by default .4 % of the
/// diagonal, or beside it where the mesh is too coarse for a smooth surface of its own: such that as much of the body
/// is lost as is won, place by place. Patches, regions, sheets, curves, sets of faces, edges and elements keep their
/// places, corners their points. Features are found by options.surface.feature_angle. A mesh of higher order is taken
/// as a linear one; with options.order 2 to 4 the new one is curved along the walls as they were (make_curved()), or
/// along the triangles of `surface`, and old_of_new has kNone for nodes behind corners.
///
/// Where options.adapt.only names places, only their elements and those of a halo of options.adapt.halo layers around
/// them may change. All others, their vertices, faces and edges keep their bits and numbers; so does what stays the
/// same inside. New items get the numbers of those that went, then come behind all; only if fewer are new than went,
/// the last ones of those that stay get the numbers left over. `before`, `after` and the checks are of the elements
/// that may change; what else there is need not even be valid.
///
/// Example: Options o; o.size.size = 2; adapt_existing(read_mesh("part.msh"), o).mesh.
///
/// `surface`, where it is not null: what walls stand for instead, its triangles as they are, or the true geometry of
/// CAD and formulas (open_domain(), IntakeOptions::Repair::kOff for what need not be closed). Walls are drawn to it:
/// faces to its faces, curves to its feature lines where it has some beside them, corners to its corners. Walls whose
/// corners or middle are farther from it than kReachOfSurface of the diagonal and half of their longest edge, or turned
/// away from it by more than 60 degrees, or nearer to another wall there, keep their own smooth surface; notes count
/// them, and vertices that could not go because elements would turn inside out.
///
/// The result is valid (first_defect), the same for any number of threads. Throws InputError if `mesh` is not valid
/// (the first defect, with ids and coordinates), or has wedges, pyramids, periods or faces that were split, or if
/// `surface` is near none of its walls; OptionError, MeshingError, Cancelled.
AdaptedMesh adapt_existing(const TetMesh& mesh, const Options& options, const RunContext& context = {},
                           const Domain* surface = nullptr);
inline constexpr double kReachOfSurface = 0.01;

/// The same by a metric, which may want other lengths in other directions; `options.size` has no say.
AdaptedMesh adapt_to_metric(const TetMesh& mesh, const MetricFunction& metric, const Options& options = {},
                            const RunContext& context = {}, const Domain* surface = nullptr);

/// The same by metrics on a background mesh, which may be the mesh itself. Throws InputError where its numbers do not
/// match or a tensor is not positive definite, with the first places.
AdaptedMesh adapt_to_metric(const TetMesh& mesh, const MetricMesh& metric, const Options& options = {},
                            const RunContext& context = {}, const Domain* surface = nullptr);

/// A surface that was adapted, and what was done. The measures are those of triangles: quality is 4 sqrt 3 times the
/// area over the sum of the squared edges, 1 if regular, in the metric of the corner of greatest density; complexity
/// the integral of the metric's density within the surface.
struct AdaptedSurface {
  SurfaceMesh surface;
  Report report;
  MetricSummary before, after;
  WallDeviation deviation;
  std::vector<VertexIndex> old_of_new;  ///< per vertex its number in the surface that was given; kNone: new
};

/// The same of triangles alone, open or closed, any number of them at an edge; repair_surface() tidies them first, so
/// that vertices at one place are one. Patches, the regions on both sides, lines where the surface bends, ends or meets
/// others, and corners stay; `source` does not. `options.adapt.only` is refused. Passes run on one thread. Throws
/// InputError for indices out of range, coordinates that are not finite, no triangles; OptionError, Cancelled. `sets`:
/// those of its file; vertices of corners and of what is required (kMeditSets) stay.
AdaptedSurface adapt_surface(const SurfaceMesh& mesh, const Options& options, const RunContext& context = {},
                             const Domain* surface = nullptr, std::span<const PlacedSet> sets = {});
AdaptedSurface adapt_surface_to_metric(const SurfaceMesh& mesh, const MetricMesh& metric, const Options& options = {},
                                       const RunContext& context = {}, const Domain* surface = nullptr,
                                       std::span<const PlacedSet> sets = {});

/// The field on the mesh that was made of `before`. At vertices: linear in the old element that holds the new vertex
/// (exact for linear functions); where a vertex is where it was, its bits. Of elements: the mean over what the new
/// element shares with old ones of its region; in each region the sum of values times volumes stays, to rounding, and
/// unchanged elements keep their bits. Looks only at what changed. `before`: a mesh of second order is taken as a
/// linear one, values at mid-side nodes have no say. The same for any number of threads. Throws InputError for a field
/// of another length, or with values that are not finite.
MeshField carried(const MeshField& field, const TetMesh& before, const AdaptedMesh& adapted);
/// The same with the parts of an AdaptedMesh.
MeshField carried(const MeshField& field, const TetMesh& before, const TetMesh& now,
                  std::span<const VertexIndex> old_of_new, std::span<const TetIndex> old_tet_of_new);

}  // namespace octafront
