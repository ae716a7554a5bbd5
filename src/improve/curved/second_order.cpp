#include <octafront/error.h>
#include <octafront/run_context.h>
#include <octafront/second_order.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/measures.h"
#include "base/geometry/tet_lattice.h"
#include "base/mesh/features.h"
#include "base/mesh/quadratic_nodes.h"
#include "improve/curved/bends.h"
#include "improve/curved/curved.h"
#include "improve/curved/easing.h"
#include "improve/curved/high_order.h"
#include "improve/curved/kept_bends.h"
#include "improve/curved/mid_nodes.h"
#include "improve/curved/smooth_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace {

// Room for the answer of one element.
struct Judged {
  double scaled = 1;
  Validity validity = Validity::kValid;
};

// Corners that elements held on their way to the true geometry try so often.
constexpr int kRounds = 4;

// Edges that bend by so little are straight but for rounding.
constexpr double kStraightJacobian = 1 - 1e-9;  // as a bound of the scaled Jacobian

Judged judge_high(const TetMesh& mesh, TetIndex t) {
  std::array<Vec3, 35> room;
  const std::span<const Vec3> nodes = nodes_of_tet(mesh, t, room);
  if (least_scaled_jacobian_bound(mesh.order(), nodes) > kStraightJacobian) return {};
  constexpr double kBent = 0.5;
  constexpr std::size_t kPartsOfJudged = 64;
  const JacobianRange range = jacobian_range(mesh.order(), nodes);
  const bool is_bent = range.least < kBent * range.straight;
  const double least = is_bent ? least_jacobian(mesh.order(), nodes, kPartsOfJudged) : range.least;
  return {range.straight == 0 ? 0 : least / std::abs(range.straight), validity_of(mesh.order(), nodes)};
}

Judged judge(const TetMesh& mesh, TetIndex t) {
  if (mesh.high_order > 0) return judge_high(mesh, t);
  const QuadraticTet nodes = quadratic_nodes(mesh, t);
  if (least_scaled_jacobian_bound(nodes) > kStraightJacobian) return {};
  const auto coefficients = jacobian_coefficients(nodes);
  const double least = *std::min_element(coefficients.begin(), coefficients.end());
  const double straight = six_volumes(nodes[0], nodes[1], nodes[2], nodes[3]);
  return {straight == 0 ? 0 : least / std::abs(straight),
          has_positive_jacobian(nodes) ? Validity::kValid : Validity::kInvalid};
}

void refuse_mid_nodes(const TetMesh& mesh) {
  if (mesh.order() > 1)
    throw InputError(fmt::format("the mesh is of order {} already; take it back to first order first", mesh.order()));
}

/// What is proven of the result, by its coordinates.
void prove(const TetMesh& mesh, SecondOrderSummary& summary, const RunContext& context) {
  const JacobianSummary found = check_jacobians(mesh, context);
  summary.least_scaled_jacobian = found.least_scaled_jacobian;
  summary.least_tet = found.least_tet;
  if (found.invalid == 0) return;
  const InvalidElement& first = found.first.front();
  throw MeshingError(fmt::format(
      "element {} at ({:.6g}, {:.6g}, {:.6g}) is so flat that rounding turns it when its edges get nodes in their "
      "middle "
      "({} such elements): no higher order for this mesh. Improve it first, or move the model to the origin.",
      first.tet, first.at.x, first.at.y, first.at.z, found.invalid));
}

constexpr const char* kNoHighPeriods = "`order` 3 and 4 are not for periodic meshes: take 2";

/// Of a mesh whose corners are where they will be.
void add_nodes(TetMesh& mesh, int order, std::span<const VertexIndex> below, curved::Bends& bends,
               SecondOrderSummary& summary, const RunContext& context) {
  if (order > 2) {
    curved::add_high_order(mesh, order, below, std::move(bends), summary, context);
  } else {
    const TetEdges edges = curved::add_straight_mid_nodes(mesh);
    curved::add_edges_above(below, edges, order, bends);
    curved::bend_edges(mesh, edges, bends.edges, summary, context);
  }
  prove(mesh, summary, context);
}

// Where curves are by angle alone: patches may meet where the surface is smooth.
Features sharp_features(const KnownSurface& surface, double feature_angle) {
  if (surface.mesh().patch.empty()) return surface.features();
  return detect_features({surface.mesh().points, surface.mesh().triangles, {}, {}, {}}, surface.edges(), feature_angle);
}

/// Of each element as it is curved.
std::vector<double> volumes_of_elements(const TetMesh& mesh) {
  std::vector<double> volumes(mesh.tets.size());
  parallel_for(volumes.size(), [&](std::size_t t) {
    if (mesh.high_order > 0) {
      std::array<Vec3, 35> room;
      volumes[t] = jacobian_range(mesh.order(), nodes_of_tet(mesh, static_cast<TetIndex>(t), room)).volume;
      return;
    }
    if (!mesh.is_second_order()) {
      const auto& [a, b, c, d] = mesh.tets[t];
      volumes[t] = signed_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
      return;
    }
    const QuadraticTet nodes = quadratic_nodes(mesh, static_cast<TetIndex>(t));
    volumes[t] = signed_volume(nodes[0], nodes[1], nodes[2], nodes[3]);
    if (least_scaled_jacobian_bound(nodes) > kStraightJacobian) return;
    const auto coefficients = jacobian_coefficients(nodes);
    // The integral of a polynomial over the unit tetrahedron is the mean of its coefficients over six.
    volumes[t] = std::accumulate(coefficients.begin(), coefficients.end(), 0.0) / (6.0 * coefficients.size());
  });
  return volumes;
}

/// Of face i of an element, outward.
std::array<Vec3, 4> face_areas(const TetMesh& mesh, TetIndex t) {
  std::array<Vec3, 4> areas;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto corner = [&](std::size_t k) { return mesh.points[mesh.tets[t][kTetFaces[i][k]]]; };
    areas[i] = 0.5 * double_area_normal(corner(0), corner(1), corner(2));
  }
  return areas;
}

SurfaceMesh boundary_of_mesh(const TetMesh& mesh) {
  return {mesh.points, mesh.boundary, {}, {}, {}};
}

}  // namespace

SecondOrderSummary curve_to_surface(TetMesh& mesh, const std::vector<Edge>& sharp, const KnownSurface& surface,
                                    double feature_angle, std::span<const VertexIndex> below,
                                    std::span<const VertexIndex> fixed, int order, const RunContext& context) {
  refuse_mid_nodes(mesh);
  SecondOrderSummary summary;
  curved::SmoothSurface smooth(surface.mesh(), surface.edges(), surface.tree(), sharp_features(surface, feature_angle));
  curved::Bends bends = curved::find_bends(mesh, sharp, smooth, order);
  std::erase_if(bends.corners,
                [&](const curved::CornerMove& move) { return std::ranges::binary_search(fixed, move.vertex); });
  curved::add_corners_above(below, bends);
  context.check();
  curved::move_corners(mesh, bends.corners, summary, context);
  add_nodes(mesh, order, below, bends, summary, context);
  return summary;
}

SecondOrderSummary move_to_geometry(TetMesh& mesh, const TrueGeometry& geometry, std::span<const VertexIndex> below,
                                    const RunContext& context) {
  SecondOrderSummary summary;
  for (int round = 0; round < kRounds; ++round) {
    context.check();
    curved::Bends bends = curved::find_bends(mesh, geometry);
    curved::add_corners_above(below, bends);
    SecondOrderSummary made;
    curved::move_corners(mesh, bends.corners, made, context);
    summary.moved += made.moved;
    summary.held = made.held + bends.too_far;
    if (summary.held == 0) break;
  }
  return summary;
}

SecondOrderSummary curve_to_geometry(TetMesh& mesh, const TrueGeometry& geometry, std::span<const VertexIndex> below,
                                     int order, const RunContext& context) {
  refuse_mid_nodes(mesh);
  SecondOrderSummary summary;
  curved::Bends bends = curved::find_bends(mesh, geometry, order);
  add_nodes(mesh, order, below, bends, summary, context);
  return summary;
}

SecondOrderSummary curve_as_before(TetMesh& mesh, const TetMesh& before, int order, const RunContext& context) {
  refuse_mid_nodes(mesh);
  SecondOrderSummary summary;
  curved::Bends bends = curved::kept_bends(mesh, before, order);
  add_nodes(mesh, order, {}, bends, summary, context);
  return summary;
}

double curved_volume(const TetMesh& mesh) {
  const std::vector<double> volumes = volumes_of_elements(mesh);
  return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

std::vector<double> curved_volumes(const TetMesh& mesh) {
  const std::vector<double> volumes = volumes_of_elements(mesh);
  std::vector<double> of_region;
  for (std::size_t t = 0; t < volumes.size(); ++t) {
    const std::uint32_t region = mesh.region.empty() ? 0 : mesh.region[t];
    if (region >= of_region.size()) of_region.resize(region + 1, 0);
    of_region[region] += volumes[t];
  }
  return of_region;
}

// An edge that bends by d moves each face beside it by 4 s t d at the weights s and t of its ends, by d / 3 on average.
std::vector<double> volumes_cut_off(const TetMesh& mesh, const TrueGeometry& geometry) {
  const std::vector<curved::EdgeBend> bends = curved::find_bends(mesh, geometry).edges;
  std::vector<double> of_region;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    const std::uint32_t region = mesh.region.empty() ? 0 : mesh.region[t];
    if (region >= of_region.size()) of_region.resize(region + 1, 0);
    const std::array<Vec3, 4> area = face_areas(mesh, t);
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      const auto [low, high] = std::minmax(mesh.tets[t][i], mesh.tets[t][j]);
      const Edge edge{low, high};
      const auto found = std::ranges::lower_bound(bends, edge, {}, &curved::EdgeBend::edge);
      if (found == bends.end() || found->edge != edge) continue;
      for (int face = 0; face < 4; ++face)
        if (face != i && face != j) of_region[region] += dot(area[face], found->by[0]) / 3;
    }
  }
  return of_region;
}

SecondOrderSummary add_straight_edges(TetMesh& mesh, int order, const RunContext& context) {
  refuse_mid_nodes(mesh);
  SecondOrderSummary summary;
  curved::Bends none;
  add_nodes(mesh, order, {}, none, summary, context);
  return summary;
}

SecondOrderSummary make_second_order(TetMesh& mesh, const SurfaceMesh* surface, double feature_angle,
                                     const RunContext& context) {
  return make_curved(mesh, 2, surface, feature_angle, context);
}

SecondOrderSummary make_curved(TetMesh& mesh, int order, const SurfaceMesh* surface, double feature_angle,
                               const RunContext& context) {
  if (order < 2 || order > kMostOrder) throw OptionError(fmt::format("`order`: {} is none of 2, 3 and 4", order));
  if (order > 2 && !mesh.periods.empty()) throw OptionError(kNoHighPeriods);
  const ThreadLimit limit(context.threads);
  if (!surface) return add_straight_edges(mesh, order, context);
  const KnownSurface known(*surface, feature_angle);
  return curve_to_surface(mesh, detect_features(boundary_of_mesh(mesh), feature_angle).edges, known, feature_angle, {},
                          {}, order, context);
}

void make_linear(TetMesh& mesh) {
  if (mesh.order() == 1) return;
  VertexIndex corners = 0;
  for (const Tet& t : mesh.tets) corners = std::max(corners, 1 + *std::max_element(t.begin(), t.end()));
  mesh.points.resize(corners);
  mesh.mid_nodes.clear(), mesh.high_nodes.clear();
  mesh.high_order = 0;
  std::erase_if(mesh.periodic_nodes, [&](const auto& pair) { return pair[1] >= corners || pair[2] >= corners; });
  for (NamedSet& set : mesh.sets)
    if (set.kind == NamedSet::Kind::kNodes) std::erase_if(set.members, [&](std::uint32_t v) { return v >= corners; });
}

JacobianSummary check_jacobians(const TetMesh& mesh, const RunContext& context) {
  JacobianSummary summary;
  if (mesh.order() == 1) return summary;
  const ThreadLimit limit(context.threads);
  std::vector<Judged> judged(mesh.tets.size());
  parallel_for(judged.size(), [&](std::size_t t) { judged[t] = judge(mesh, static_cast<TetIndex>(t)); });
  constexpr std::size_t kListed = 10;
  double sum = 0;
  for (TetIndex t = 0; t < judged.size(); ++t) {
    sum += judged[t].scaled;
    if (summary.least_tet == kNone || judged[t].scaled < summary.least_scaled_jacobian) {
      summary.least_scaled_jacobian = judged[t].scaled;
      summary.least_tet = t;
    }
    if (judged[t].validity == Validity::kValid) continue;
    ++summary.invalid;
    summary.undecided += judged[t].validity == Validity::kUndecided;
    const auto& [a, b, c, d] = mesh.tets[t];
    if (summary.first.size() < kListed)
      summary.first.push_back(
          {t, centroid(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]), judged[t].scaled});
  }
  if (!judged.empty()) summary.mean_scaled_jacobian = sum / static_cast<double>(judged.size());
  return summary;
}

}  // namespace octafront
