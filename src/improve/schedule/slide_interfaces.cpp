#include "improve/schedule/slide_interfaces.h"

#include <octafront/quality.h>

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

namespace octafront {

namespace {

constexpr int kSweeps = 3;
/// Parts of the way to a wanted place that are tried.
constexpr double kPartsOfSlide[] = {1, 0.5, 0.25};
/// Elements count by the inverse of their quality; flatter ones than this alike, so that none decides alone.
constexpr double kLeastShape = 0.05;
/// Moves that gain less, in beta, are not worth it; above the second no element is in need.
constexpr double kGain = 0.01, kGoodBesideInterface = 0.5;
/// Cosine of the turn of a triangle of the interface that is allowed.
constexpr double kTurn = 0.9;

class InterfaceSlider {
 public:
  InterfaceSlider(TetMesh& mesh, const SurfaceMesh& filled, const Features& features, const SurfaceMesh& input)
      : mesh_(mesh), filled_(filled), input_(input) {
    find_vertices(features);
    triangles_ = rows_at_vertices(filled.points.size(), filled.triangles);
    std::uint32_t patches = 0;
    for (std::size_t t = 0; t < input.triangles.size(); ++t) patches = std::max(patches, input.patch_of(t) + 1);
    input_of_patch_ = group_by_owner(patches, static_cast<std::uint32_t>(input.triangles.size()),
                                     [&](std::uint32_t t) { return input.patch_of(t); });
  }

  std::uint64_t run(const Stage& stage) {
    std::uint64_t moves = 0;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      stage.check();
      const std::uint64_t before = moves;
      for (const VertexIndex v : find_needy()) moves += improve(v);
      if (moves == before) break;
    }
    return moves;
  }

 private:
  /// Vertices all of whose triangles lie between regions, or on sheets, in one patch, off all features.
  void find_vertices(const Features& features) {
    constexpr std::uint32_t kNever = kNone - 1;
    patch_.assign(filled_.points.size(), kNone);
    for (std::size_t t = 0; t < filled_.triangles.size(); ++t)
      for (const VertexIndex v : filled_.triangles[t]) {
        const bool fits = filled_.sides_of(t)[0] != kNone && (patch_[v] == kNone || patch_[v] == filled_.patch_of(t));
        patch_[v] = fits ? filled_.patch_of(t) : kNever;
      }
    for (const Edge& edge : features.edges)
      for (const VertexIndex v : edge) patch_[v] = kNever;
    for (std::uint32_t& patch : patch_)
      if (patch == kNever) patch = kNone;
  }

  bool slides(VertexIndex v) const { return v < patch_.size() && patch_[v] != kNone; }

  /// Those that may slide and have an element that wants it; leaves the elements around them.
  std::vector<VertexIndex> find_needy() {
    std::vector<std::uint8_t> is_poor(mesh_.tets.size(), 0), needs(patch_.size(), 0);
    parallel_for(mesh_.tets.size(), [&](std::size_t t) {
      const auto& [a, b, c, d] = mesh_.tets[t];
      if (!slides(a) && !slides(b) && !slides(c) && !slides(d)) return;
      is_poor[t] =
          radius_ratio(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]) <= kGoodBesideInterface;
    });
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
      if (is_poor[t] != 0)
        for (const VertexIndex v : mesh_.tets[t])
          if (slides(v)) needs[v] = 1;
    tets_ = Groups<>(patch_.size(), [&](const auto& add) {
      for (TetIndex t = 0; t < mesh_.tets.size(); ++t)
        for (const VertexIndex v : mesh_.tets[t])
          if (v < needs.size() && needs[v] != 0) add(v, t);
    });
    std::vector<VertexIndex> needy;
    for (VertexIndex v = 0; v < needs.size(); ++v)
      if (needs[v] != 0) needy.push_back(v);
    return needy;
  }

  /// Over the input's triangles of the patch.
  const TriangleTree& tree_of(std::uint32_t patch) {
    std::unique_ptr<TriangleTree>& tree = trees_[patch];
    if (tree) return *tree;
    std::vector<Triangle> own;
    for (const std::uint32_t t : input_of_patch_[patch]) own.push_back(input_.triangles[t]);
    tree = std::make_unique<TriangleTree>(input_.points, own);
    return *tree;
  }

  Vec3 at(VertexIndex v, VertexIndex moved, Vec3 place) const { return v == moved ? place : mesh_.points[v]; }

  /// Least beta of the elements around v at the place; negative if one is not positive there.
  double worst(VertexIndex v, Vec3 place) const {
    double least = 1;
    for (const TetIndex t : tets_[v]) {
      const auto& [i, j, k, l] = mesh_.tets[t];
      const Vec3 a = at(i, v, place), b = at(j, v, place), c = at(k, v, place), d = at(l, v, place);
      if (orient3d(a, b, c, d) <= 0) return -1;
      least = std::min(least, radius_ratio(a, b, c, d));
    }
    return least;
  }

  bool turns_little(VertexIndex v, Vec3 place) const {
    for (const std::uint32_t t : triangles_[v]) {
      const auto& [i, j, k] = filled_.triangles[t];
      const Vec3 was = unit_normal(mesh_.points[i], mesh_.points[j], mesh_.points[k]);
      if (!(dot(was, unit_normal(at(i, v, place), at(j, v, place), at(k, v, place))) > kTurn)) return false;
    }
    return true;
  }

  /// The middle of the vertices around it, those of the worst elements counting most.
  Vec3 wanted_place(VertexIndex v) const {
    Vec3 sum;
    double weights = 0;
    for (const TetIndex t : tets_[v]) {
      const auto& [a, b, c, d] = mesh_.tets[t];
      const double w =
          1 / (kLeastShape + radius_ratio(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]));
      for (const VertexIndex u : mesh_.tets[t])
        if (u != v) sum += mesh_.points[u] * w, weights += w;
    }
    return sum / weights;
  }

  bool improve(VertexIndex v) {
    const Vec3 here = mesh_.points[v];
    const double now = worst(v, here);
    if (now > kGoodBesideInterface) return false;
    const Vec3 way = wanted_place(v) - here;
    for (const double step : kPartsOfSlide) {
      const auto nearest = tree_of(patch_[v]).nearest(here + way * step);
      if (nearest.triangle == kNone || worst(v, nearest.point) < now + kGain || !turns_little(v, nearest.point))
        continue;
      mesh_.points[v] = nearest.point;
      return true;
    }
    return false;
  }

  TetMesh& mesh_;
  const SurfaceMesh &filled_, &input_;
  std::vector<std::uint32_t> patch_;  ///< per vertex of `filled` that may slide; kNone for the others
  Groups<> tets_, triangles_, input_of_patch_;
  std::map<std::uint32_t, std::unique_ptr<TriangleTree>> trees_;
};

}  // namespace

std::uint64_t slide_interfaces(TetMesh& mesh, const SurfaceMesh& filled, const Features& features,
                               const SurfaceMesh& input, const Stage& stage) {
  return InterfaceSlider(mesh, filled, features, input).run(stage);
}

}  // namespace octafront
