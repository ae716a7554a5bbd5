#include "surface/curves.h"

#include <algorithm>

namespace octafront::remeshing {

namespace {

/// Normals on both sides of a feature, averaged at these distances in element sizes, must still differ.
constexpr double kReaches[] = {0.3, 0.45, 0.6};
/// ... by 30 degrees.
constexpr double kScaleCosine = 0.866;
/// A chain that fails the test at scale is noise if it is shorter than this, in element sizes: longer ones are steps
/// and grooves of a machined part, which are straight and keep their lines however fine they are.
constexpr double kShort = 1.5, kShortDangling = 4;
/// A chain with two loose ends is noise below this length.
constexpr double kShortIsolated = 1;
/// Removing chains joins others; that settles within a few rounds.
constexpr int kRounds = 4;

Vec3 normal_aside(const InputSurface& input, HalfedgeIndex h, double size) {
  const HalfedgeMesh& mesh = input.mesh;
  const std::uint32_t face = h / 3;
  const Vec3 a = mesh.points[mesh.start[h]], b = mesh.points[mesh.end(h)], n = input.face_normal[face];
  const Vec3 inward = normalized(cross(n, b - a));
  Vec3 sum;
  for (const double reach : kReaches) {
    SurfacePoint x{(a + b) * 0.5, face};
    const WalkEnd end = walk(input, x, inward, n, reach * size, x);
    sum += end == WalkEnd::kArrived ? input.face_normal[x.face] : n;
  }
  return normalized(sum);
}

bool holds_at_scale(const InputSurface& input, HalfedgeIndex h, double size) {
  return dot(normal_aside(input, h, size), normal_aside(input, input.mesh.twin[h], size)) < kScaleCosine;
}

/// How a chain is judged.
struct ChainFacts {
  double length = 0;  ///< in element sizes
  double sharp = 0;   ///< part of it that holds at scale
  bool border = false;
  int loose_ends = 0;
};

bool is_noise(const ChainFacts& f) {
  if (f.border) return false;
  if (f.loose_ends == 2 && f.length < kShortIsolated) return true;
  if (f.sharp >= 0.5 * f.length) return false;
  return f.length < (f.loose_ends > 0 ? kShortDangling : kShort);
}

class NoiseFilter {
 public:
  NoiseFilter(const InputSurface& input, const SizeField& sizes) : marked_(input), sizes_(sizes) {
    const HalfedgeMesh& mesh = input.mesh;
    sharp_.assign(mesh.start.size(), kUnknown);
    size_.assign(mesh.start.size(), 0);
  }

  std::vector<Edge> run(std::vector<Edge> edges) {
    judge_edges(edges);
    for (int round = 0; round < kRounds; ++round) {
      set_features(marked_, edges);
      const std::size_t before = edges.size();
      drop_noise();
      std::erase_if(edges, [&](const Edge& e) { return !marked_.mesh.is_feature[marked_.mesh.find(e[0], e[1])]; });
      if (edges.size() == before) break;
    }
    return edges;
  }

 private:
  static constexpr std::uint8_t kUnknown = 2;

  /// Needs the surface without marks: the walks must cross features.
  void judge_edges(const std::vector<Edge>& edges) {
    const HalfedgeMesh& mesh = marked_.mesh;
    for (const Edge& e : edges) {
      const HalfedgeIndex h = mesh.find(e[0], e[1]);
      const double size = sizes_.at((mesh.points[e[0]] + mesh.points[e[1]]) * 0.5);
      const std::uint8_t sharp = holds_at_scale(marked_, h, size);
      sharp_[h] = sharp_[mesh.twin[h]] = sharp;
      size_[h] = size_[mesh.twin[h]] = size;
    }
  }

  void drop_noise() {
    HalfedgeMesh& mesh = marked_.mesh;
    std::vector<std::uint32_t> degree(mesh.points.size(), 0);
    for (HalfedgeIndex h = 0; h < mesh.start.size(); ++h) degree[mesh.start[h]] += mesh.is_feature[h];
    for (const Curve& c : chain_curves(marked_, {}, sizes_)) {
      ChainFacts f;
      for (const HalfedgeIndex h : c.halfedges) {
        const double l = distance(mesh.points[mesh.start[h]], mesh.points[mesh.end(h)]) / size_[h];
        f.length += l;
        f.sharp += sharp_[h] ? l : 0;
        f.border |= marked_.patch[h / 3] != marked_.patch[mesh.twin[h] / 3];
      }
      f.loose_ends = (degree[mesh.start[c.halfedges.front()]] == 1) + (degree[mesh.end(c.halfedges.back())] == 1);
      if (!is_noise(f)) continue;
      for (const HalfedgeIndex h : c.halfedges) mesh.set_feature(h, false);
    }
  }

  InputSurface marked_;
  const SizeField& sizes_;
  std::vector<std::uint8_t> sharp_;
  std::vector<double> size_;
};

}  // namespace

std::vector<Edge> features_at_scale(const InputSurface& input, const Features& features, const SizeField& sizes) {
  const HalfedgeMesh& mesh = input.mesh;
  std::vector<Edge> edges = features.edges;
  for (HalfedgeIndex h = 0; h < mesh.start.size(); ++h) {
    if (h < mesh.twin[h] && input.patch[h / 3] != input.patch[mesh.twin[h] / 3]) {
      edges.push_back({std::min(mesh.start[h], mesh.end(h)), std::max(mesh.start[h], mesh.end(h))});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return NoiseFilter(input, sizes).run(std::move(edges));
}

}  // namespace octafront::remeshing
