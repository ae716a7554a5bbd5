#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "surface/lines/curves.h"

#include <algorithm>
#include <map>
#include <utility>

namespace octafront::surface {

namespace {

/// Normals on both sides of a feature, averaged at these distances in element sizes, must still differ.
constexpr double kReaches[] = {0.3, 0.45, 0.6};
/// ... by 30 degrees.
constexpr double kScaleCosine = 0.866;
/// A chain that fails the test at scale is noise if it is shorter than this, in element sizes: longer ones are steps
/// and grooves of a machined part, which are straight and keep their lines however fine they are.
constexpr double kShortChain = 1.5, kShortDangling = 4;
/// A chain with two loose ends is noise below this length.
constexpr double kShortIsolated = 1;
/// A closed curve this short has no room for three segments worth the name.
constexpr double kShortClosed = 0.5;
/// Edges that are no features but turn by more than 12 degrees are rough. Where most edges beside a chain are, the
/// surface is a scan with angles of all kinds, of which some happen to be sharp, and a chain must be this long.
constexpr double kRoughCosine = 0.978;
constexpr double kRoughPart = 0.45, kShortRough = 3;
/// A chain this short between junctions, blunter than 65 degrees and somewhat rough is a rung between lines that are
/// one line at scale; one that hangs loose is a whisker.
constexpr double kShortRung = 0.7, kShortWhisker = 1;
constexpr double kBluntCosine = 0.423, kSomewhatRough = 0.15;
/// Of two chains between the same corners both shorter than this the blunter one is noise: a sharp line that runs
/// across triangles shows as edges on both sides of it.
constexpr double kShortDouble = 1;
/// Removing chains joins others; that settles within a few rounds.
constexpr int kNoiseRounds = 6;

Vec3 normal_aside(const InputSurface& input, HalfEdge h, double size) {
  const HalfEdgeMesh& mesh = input.mesh;
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

bool holds_at_scale(const InputSurface& input, HalfEdge h, double size) {
  return dot(normal_aside(input, h, size), normal_aside(input, input.mesh.twin[h], size)) < kScaleCosine;
}

/// How a chain is judged.
struct ChainFacts {
  double length = 0;  ///< in element sizes
  double sharp = 0;   ///< part of it that holds at scale
  double cosine = 0;  ///< mean, of the angle between its faces
  double rough = 0;   ///< part of the edges beside it that are rough
  bool border = false;
  int loose_ends = 0;
  bool is_closed = false;
  bool between_junctions = false;  ///< three chains or more meet at both ends
  Edge ends{};
};

bool is_noise(const ChainFacts& f) {
  if (f.border) return false;
  if (f.loose_ends == 2 && f.length < kShortIsolated) return true;
  if (f.is_closed && f.length < kShortClosed) return true;
  if (f.rough > kRoughPart && f.length < kShortRough) return true;
  if (f.cosine > kBluntCosine && f.rough > kSomewhatRough) {
    if (f.loose_ends == 1 && f.length < kShortWhisker) return true;
    if (f.between_junctions && f.length < kShortRung) return true;
  }
  if (f.sharp >= 0.5 * f.length) return false;
  return f.length < (f.loose_ends > 0 ? kShortDangling : kShortChain);
}

/// Regions of a complex keep their edges, but for those of scans.
bool is_rough_noise(const ChainFacts& f) {
  return !f.border && f.rough > kRoughPart && f.length < kShortRough;
}

class NoiseFilter {
 public:
  NoiseFilter(const InputSurface& input, const SizeField& sizes) : marked_(input), sizes_(sizes) {
    const HalfEdgeMesh& mesh = input.mesh;
    sharp_.assign(mesh.start.size(), kUnknown);
    size_.assign(mesh.start.size(), 1);  // seams that edges do not name stay whatever they are
  }

  std::vector<Edge> run(std::vector<Edge> edges) {
    judge_edges(edges);
    for (int round = 0; round < kNoiseRounds; ++round) {
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
    const HalfEdgeMesh& mesh = marked_.mesh;
    parallel_for(edges.size(), [&](std::size_t i) {
      const Edge& e = edges[i];
      const HalfEdge h = mesh.find(e[0], e[1]);
      const double size = sizes_.at((mesh.points[e[0]] + mesh.points[e[1]]) * 0.5);
      const std::uint8_t sharp = holds_at_scale(marked_, h, size);
      sharp_[h] = sharp_[mesh.twin[h]] = sharp;
      size_[h] = size_[mesh.twin[h]] = size;
    });
  }

  double cosine(HalfEdge h) const {
    return dot(marked_.face_normal[h / 3], marked_.face_normal[marked_.mesh.twin[h] / 3]);
  }

  void count_beside(VertexIndex v, double& rough, double& all) const {
    const HalfEdgeMesh& mesh = marked_.mesh;
    mesh.for_each_outgoing(v, [&](HalfEdge h) {
      if (mesh.is_feature[h] || marked_.is_back(h / 3)) return;
      ++all;
      rough += cosine(h) < kRoughCosine;
    });
  }

  ChainFacts facts_of(const Curve& c, const std::vector<std::uint32_t>& degree) const {
    const HalfEdgeMesh& mesh = marked_.mesh;
    ChainFacts f;
    const VertexIndex first = mesh.start[c.half_edges.front()], last = mesh.end(c.half_edges.back());
    double rough = 0, all = 0;
    count_beside(first, rough, all);
    for (const HalfEdge h : c.half_edges) {
      const double l = distance(mesh.points[mesh.start[h]], mesh.points[mesh.end(h)]) / size_[h];
      f.length += l;
      f.sharp += sharp_[h] ? l : 0;
      f.cosine += cosine(h) / static_cast<double>(c.half_edges.size());
      f.border |= marked_.patch[h / 3] != marked_.patch[mesh.twin[h] / 3];
      count_beside(mesh.end(h), rough, all);
    }
    f.rough = all > 0 ? rough / all : 0;
    f.loose_ends = (degree[first] == 1) + (degree[last] == 1);
    f.is_closed = c.closed;
    f.between_junctions = degree[first] > 2 && degree[last] > 2;
    f.ends = {std::min(first, last), std::max(first, last)};
    return f;
  }

  void drop(const Curve& c) {
    for (const HalfEdge h : c.half_edges) marked_.mesh.set_feature(h, false);
  }

  void drop_noise() {
    HalfEdgeMesh& mesh = marked_.mesh;
    std::vector<std::uint32_t> degree(mesh.points.size(), 0);
    for (HalfEdge h = 0; h < mesh.start.size(); ++h) degree[mesh.start[h]] += mesh.is_feature[h];
    const std::vector<Curve> curves = chain_curves(marked_, {}, {}, sizes_);
    std::vector<ChainFacts> facts;
    for (const Curve& c : curves) facts.push_back(facts_of(c, degree));
    std::map<Edge, std::size_t> sharpest;
    const bool is_complex = marked_.first_back != kNone;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      if (is_complex ? is_rough_noise(facts[i]) : is_noise(facts[i])) {
        drop(curves[i]);
      } else if (!is_complex && facts[i].length < kShortDouble && facts[i].ends[0] != facts[i].ends[1]) {
        const auto [it, is_first] = sharpest.try_emplace(facts[i].ends, i);
        if (is_first) continue;
        std::size_t blunter = i;
        if (facts[i].border || facts[i].cosine < facts[it->second].cosine) std::swap(blunter, it->second);
        if (!facts[blunter].border) drop(curves[blunter]);
      }
    }
  }

  InputSurface marked_;
  const SizeField& sizes_;
  std::vector<std::uint8_t> sharp_;
  std::vector<double> size_;
};

}  // namespace

std::vector<Edge> features_at_scale(const InputSurface& input, const Features& features, const SizeField& sizes) {
  const HalfEdgeMesh& mesh = input.mesh;
  std::vector<Edge> edges = features.edges;
  for (HalfEdge h = 0; h < mesh.start.size(); ++h) {
    if (h < mesh.twin[h] && input.patch[h / 3] != input.patch[mesh.twin[h] / 3]) {
      edges.push_back({std::min(mesh.start[h], mesh.end(h)), std::max(mesh.start[h], mesh.end(h))});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return NoiseFilter(input, sizes).run(std::move(edges));
}

}  // namespace octafront::surface
