#include "adapt/carry/carry.h"
#include "base/core/parallel.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/edge_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octafront::adapt {
namespace {

/// How far out a tet speaks, in parts of its height.
constexpr double kFarthestOut = 1;

/// How far out of the straight tet a place may be whose parts are found in the curved one.
constexpr double kOutOfStraight = 0.25;
/// Each brings the parts nearer by how much elements bend.
constexpr int kBendings = 12;
/// What lies out of a curved tet by no more lies on it: two meshes of one curved body meet its walls in other places.
constexpr double kOutOfCurved = 0.02;

Mixture mixture_in(const TetMesh& mesh, TetIndex t, Vec3 p) {
  const TetCorners x = corners_in(mesh, t);
  const double whole = six_volumes(x[0], x[1], x[2], x[3]);
  return {mesh.tets[t],
          {six_volumes(p, x[1], x[2], x[3]) / whole, six_volumes(x[0], p, x[2], x[3]) / whole,
           six_volumes(x[0], x[1], p, x[3]) / whole, six_volumes(x[0], x[1], x[2], p) / whole}};
}

/// Of a place that is in it: no part is negative, they add up to 1.
Mixture from_inside(Mixture mixture) {
  double sum = 0;
  for (double& part : mixture.parts) sum += part = std::max(part, 0.0);
  // Flat as far as floating point can tell: its corners are all there is.
  if (!(sum > 0)) sum = 1, mixture.parts = {1, 0, 0, 0};
  for (double& part : mixture.parts) part /= sum;
  return mixture;
}

Mixture mixture_on(const TetMesh& mesh, const Triangle& triangle, Vec3 p) {
  const auto& [a, b, c] = triangle;
  const Vec3 x = mesh.points[a], y = mesh.points[b], z = mesh.points[c], n = double_area_normal(x, y, z);
  const auto area = [&](Vec3 q, Vec3 r) { return dot(n, double_area_normal(p, q, r)); };
  return from_inside({{a, b, c, a}, {area(y, z), area(z, x), area(x, y), 0}});
}

/// In the tet as its mid-side nodes bend it: p less what they add where the parts are. Where that leads far out, the
/// straight tet's.
Mixture mixture_in_curved(const TetMesh& mesh, TetIndex t, Vec3 p) {
  const Mixture straight = mixture_in(mesh, t, p);
  std::array<Vec3, 6> bends;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [i, j] = kTetEdges[e];
    bends[e] = mesh.points[mesh.mid_nodes[t][e]] - (mesh.points[mesh.tets[t][i]] + mesh.points[mesh.tets[t][j]]) * 0.5;
  }
  Mixture found = straight;
  for (int round = 0; round < kBendings; ++round) {
    Vec3 at = p;
    for (std::size_t e = 0; e < 6; ++e)
      at -= 4 * found.parts[kTetEdges[e][0]] * found.parts[kTetEdges[e][1]] * bends[e];
    found = mixture_in(mesh, t, at);
    if (!(*std::min_element(found.parts.begin(), found.parts.end()) > -kOutOfStraight)) return straight;
  }
  return found;
}

/// Who speaks for each node of the new mesh.
class NodeSources {
 public:
  NodeSources(const MeshPair& meshes, const GoneTets& gone, OutsideNodes outside, bool is_quadratic,
              const RunContext& context)
      : meshes_(meshes),
        gone_(gone),
        is_curved_(is_quadratic && meshes.before.is_second_order()),
        mixtures_(meshes.now.points.size()),
        distance_(mixtures_.size(), -1) {
    constexpr std::size_t kBlock = 1 << 14;
    std::vector<std::vector<VertexIndex>> outside_of((mixtures_.size() + kBlock - 1) / kBlock);
    parallel_for(
        outside_of.size(),
        [&](std::size_t block) {
          context.check();
          for (std::size_t v = block * kBlock; v < std::min(mixtures_.size(), (block + 1) * kBlock); ++v)
            if (!find_inside(static_cast<VertexIndex>(v))) outside_of[block].push_back(static_cast<VertexIndex>(v));
        },
        Split::kSingly);
    for (const auto& some : outside_of) outside_.insert(outside_.end(), some.begin(), some.end());
    if (!outside_.empty()) find_outside(outside);
  }

  void enter_into(CarryReport& report) const {
    report.outside_nodes = outside_.size();
    for (const VertexIndex v : outside_)
      if (distance_[v] > report.farthest) report.farthest = distance_[v], report.farthest_at = meshes_.now.points[v];
  }

  /// `bends`: null: of a linear field.
  std::vector<double> values(const OldValues& old, const EdgeBends* bends) const {
    const std::size_t n = old.components;
    std::vector<double> made(mixtures_.size() * n);
    parallel_for(mixtures_.size(), [&](std::size_t v) {
      for (std::size_t k = 0; k < n; ++k) made[v * n + k] = mixed(mixtures_[v], old, k, bends);
    });
    return made;
  }

 private:
  /// Rounding adds no extremes either.
  static double mixed(const Mixture& mixture, const OldValues& old, std::size_t k, const EdgeBends* bends) {
    double sum = 0, least = HUGE_VAL, greatest = -HUGE_VAL;
    bool is_mean = true;
    for (std::size_t i = 0; i < 4; ++i) {
      const double part = mixture.parts[i], value = old.values[mixture.nodes[i] * old.components + k];
      if (part == 0) continue;
      sum += part * value, is_mean = is_mean && part > 0;
      least = std::min(least, value), greatest = std::max(greatest, value);
    }
    if (const double bend = bends == nullptr ? 0 : bends->bend(mixture, k); bend != 0)
      return is_mean ? bends->in_range(sum + bend, k) : sum + bend;
    return is_mean ? std::clamp(sum, least, greatest) : sum;
  }

  bool find_inside(VertexIndex v) {
    const VertexIndex old = meshes_.same.old_of_new[v];
    const Vec3 p = meshes_.now.points[v];
    if (old != kNone && meshes_.before.points[old] == p) {
      mixtures_[v] = {{old, old, old, old}, {1, 0, 0, 0}};
      return true;
    }
    const TetIndex holder = holder_of(meshes_.before, gone_, p, [](TetIndex) { return true; });
    if (holder != kNone) mixtures_[v] = in_tet(holder, p);
    return holder != kNone || is_in_bend(v);
  }

  Mixture in_tet(TetIndex t, Vec3 p) const {
    if (!is_curved_) return from_inside(mixture_in(meshes_.before, t, p));
    Mixture mixture = mixture_in_curved(meshes_.before, t, p);
    mixture.mids = meshes_.before.mid_nodes[t];
    return mixture;
  }

  /// Outside of all straight tets, and in one that bulges.
  bool is_in_bend(VertexIndex v) {
    if (!is_curved_) return false;
    const Vec3 p = meshes_.now.points[v];
    const TetIndex t = gone_.nearest(p, [](TetIndex) { return true; });
    if (t == kNone) return false;
    const Mixture mixture = in_tet(t, p);
    if (*std::min_element(mixture.parts.begin(), mixture.parts.end()) < -kOutOfCurved) return false;
    mixtures_[v] = mixture;
    return true;
  }

  void find_outside(OutsideNodes how) {
    const TriangleTree boundary(meshes_.before.points, meshes_.before.boundary);
    const EdgeNodes mids(meshes_.before);
    parallel_for(outside_.size(), [&](std::size_t i) {
      const VertexIndex v = outside_[i];
      const Vec3 p = meshes_.now.points[v];
      const TriangleTree::Nearest nearest = boundary.nearest(p);
      distance_[v] = std::sqrt(nearest.squared_distance);
      mixtures_[v] = mixture_on(meshes_.before, meshes_.before.boundary[nearest.triangle], nearest.point);
      if (is_curved_) {
        const auto& [a, b, c, again] = mixtures_[v].nodes;
        mixtures_[v].mids[0] = mids(a, b), mixtures_[v].mids[1] = mids(a, c), mixtures_[v].mids[3] = mids(b, c);
      }
      if (how == OutsideNodes::kOnwards) go_onwards(v);
    });
  }

  /// By the nearest tet of what changed, which is the one that the new element there was made of.
  void go_onwards(VertexIndex v) {
    const Vec3 p = meshes_.now.points[v];
    const TetIndex t = gone_.nearest(p, [](TetIndex) { return true; });
    if (t == kNone) return;
    mixtures_[v] = mixture_in(meshes_.before, t, p);
    const auto& parts = mixtures_[v].parts;
    if (*std::min_element(parts.begin(), parts.end()) < -kFarthestOut)
      mixtures_[v] = from_inside(mixture_in(meshes_.before, t, nearest_on(corners_in(meshes_.before, t), p)));
  }

  const MeshPair& meshes_;
  const GoneTets& gone_;
  bool is_curved_;  ///< fields and elements are quadratic
  std::vector<Mixture> mixtures_;
  std::vector<VertexIndex> outside_;
  std::vector<double> distance_;
};

}  // namespace

std::vector<double> carried_at_nodes(const MeshPair& meshes, const GoneTets& gone, const OldValues& old,
                                     OutsideNodes outside, const CarryOptions& options, const RunContext& context,
                                     CarryReport& report) {
  const NodeSources sources(meshes, gone, outside, options.quadratic_nodes, context);
  sources.enter_into(report);
  if (!options.quadratic_nodes) return sources.values(old, nullptr);
  const EdgeBends bends(meshes.before, old, context);
  return sources.values(old, &bends);
}

}  // namespace octafront::adapt
