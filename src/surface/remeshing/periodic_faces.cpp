#include "surface/remeshing/periodic_faces.h"

#include "base/core/renumber.h"
#include "base/geometry/measures.h"
#include "sizing/field/change_size_field.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace octafront::surface {

namespace {

/// Sizes at copies that differ by less than this part are the same.
constexpr double kSameAtCopies = 0.01;
/// What is made smaller at one pair of faces may change what another one has; and again at most so often.
constexpr int kSizeRounds = 3;
/// Triangles of the input are divided for samples until they are as small as the sizes, so often at most.
constexpr int kMostHalvings = 24;

/// Places on a triangle no farther from each other than the sizes there.
class Sampler {
 public:
  Sampler(const SizeField& sizes, std::vector<Vec3>& to) : sizes_(sizes), to_(to) {}

  void add(Vec3 a, Vec3 b, Vec3 c, int depth = 0) {
    // The longest edge is ab from here on.
    if (distance(b, c) > distance(a, b) && distance(b, c) >= distance(c, a)) return add(b, c, a, depth);
    if (distance(c, a) > distance(a, b)) return add(c, a, b, depth);
    const Vec3 middle = (a + b) * 0.5;
    if (distance(a, b) <= sizes_.at(middle) || depth == kMostHalvings) {
      to_.insert(to_.end(), {a, b, c, centroid(a, b, c)});
      return;
    }
    add(a, middle, c, depth + 1);
    add(middle, b, c, depth + 1);
  }

 private:
  const SizeField& sizes_;
  std::vector<Vec3>& to_;
};

std::vector<Vec3> samples_of_face(const SurfaceMesh& input, const PeriodicFaces& periods, CellFace face,
                                  const SizeField& sizes) {
  std::vector<Vec3> samples;
  Sampler sampler(sizes, samples);
  for (std::size_t t = 0; t < input.triangles.size(); ++t) {
    if (periods.face[t] != face) continue;
    const auto [a, b, c] = input.triangles[t];
    sampler.add(input.points[a], input.points[b], input.points[c]);
  }
  return samples;
}

/// Sizes wanted at places of both faces of a period, where the opposite ones are smaller.
std::vector<PointSize> wanted_by_copies(const SizeField& sizes, const SurfaceMesh& input, const PeriodicFaces& periods,
                                        int period) {
  std::vector<PointSize> wanted;
  for (CellFace end = 0; end < 2; ++end) {
    const PeriodicCell& cell = periods.cell;
    for (const Vec3 p : samples_of_face(input, periods, 2 * static_cast<CellFace>(period) + end, sizes)) {
      const Vec3 copy = end == 0 ? cell.to_high(p, period) : cell.to_low(p, period);
      const double h = sizes.at(p);
      if (h < (1 - kSameAtCopies) * sizes.at(copy)) wanted.push_back({copy, h});
    }
  }
  return wanted;
}

/// The triangles and vertices of an outcome while faces are exchanged.
class FaceCopier {
 public:
  FaceCopier(const SurfaceMesh& input, const PeriodicFaces& periods, Outcome& made)
      : input_(input), periods_(periods), made_(made), surface_(made.result.surface) {}

  void run() {
    drop_copies();
    settle();
    find_vertices();
    for (const std::uint32_t t : low_) copy(t);
    if (!periods_.cell.is_box()) copy_features();
    compact();
    made_.is_clear = false;
  }

 private:
  std::uint32_t copy_of(std::uint32_t patch) const {
    return patch < periods_.copy_of_patch.size() ? periods_.copy_of_patch[patch] : kNone;
  }

  void drop_copies() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const std::uint32_t patch = surface_.patch[t];
      if (periods_.is_copy(patch)) {
        sides_of_patch_.try_emplace(patch, surface_.sides[t]);
        continue;
      }
      surface_.triangles[kept] = surface_.triangles[t];
      surface_.patch[kept] = patch;
      surface_.sides[kept] = surface_.sides[t];
      if (copy_of(patch) != kNone) low_.push_back(static_cast<std::uint32_t>(kept));
      ++kept;
    }
    surface_.triangles.resize(kept), surface_.patch.resize(kept), surface_.sides.resize(kept);
  }

  /// Vertices of low faces come to where they have copies.
  void settle() {
    if (periods_.cell.is_box()) return;
    for (const std::uint32_t t : low_)
      for (const VertexIndex v : surface_.triangles[t]) surface_.points[v] = periods_.cell.on_grid(surface_.points[v]);
  }

  void find_vertices() {
    // Also those of dropped triangles alone: at lines between two faces that are copies they have features.
    for (VertexIndex v = 0; v < surface_.points.size(); ++v) at_.add(surface_.points[v], v);
  }

  int period_of(std::uint32_t patch) const { return static_cast<int>(periods_.face_of_patch[patch] / 2); }

  VertexIndex copy_of_vertex(VertexIndex v, int period) {
    const Vec3 p = periods_.cell.to_high(surface_.points[v], period);
    if (const VertexIndex known = at_.find(p); known != kNone) return known;
    const auto added = static_cast<VertexIndex>(surface_.points.size());
    surface_.points.push_back(p);
    const std::uint32_t face = made_.vertex_face[v];
    const std::uint32_t other = face < periods_.other.size() ? periods_.other[face] : kNone;
    made_.vertex_face.push_back(other == kNone ? face : other);
    made_.is_inner.push_back(made_.is_inner[v] && other != kNone);
    at_.add(p, added);
    return added;
  }

  void copy(std::uint32_t t) {
    const std::uint32_t patch = surface_.patch[t], to = copy_of(patch);
    const int period = period_of(patch);
    const Triangle own = surface_.triangles[t];
    Triangle copied{};
    for (int i = 0; i < 3; ++i) copied[i] = copy_of_vertex(own[i], period);
    const Sides sides = sides_of_patch_.at(to), low = surface_.sides[t];
    // Both face outward, or both inward, but for parts of which one has the outside in front and one behind.
    if ((sides[0] == kNone) == (low[0] == kNone)) std::swap(copied[1], copied[2]);
    surface_.triangles.push_back(copied);
    surface_.patch.push_back(to);
    surface_.sides.push_back(sides);
  }

  /// Features within faces, which those of boxes have not: as they are on low faces, and none of what was dropped.
  void copy_features() {
    std::vector<Edge>& features = made_.result.features.edges;
    std::vector<Edge> all, copies;
    const auto add = [](std::vector<Edge>& to, const Triangle& t) {
      for (int i = 0; i < 3; ++i) to.push_back(sorted_edge(t[i], t[(i + 1) % 3]));
    };
    for (const Triangle& t : surface_.triangles) add(all, t);
    std::sort(all.begin(), all.end());
    std::erase_if(features, [&](const Edge& e) { return !std::binary_search(all.begin(), all.end(), e); });
    std::sort(features.begin(), features.end());
    for (const std::uint32_t t : low_) {
      std::vector<Edge> of;
      add(of, surface_.triangles[t]);
      const int period = period_of(surface_.patch[t]);
      for (const Edge& e : of) {
        if (!std::binary_search(features.begin(), features.end(), e)) continue;
        const VertexIndex a = copy_of_vertex(e[0], period), b = copy_of_vertex(e[1], period);
        copies.push_back(sorted_edge(a, b));
      }
    }
    features.insert(features.end(), copies.begin(), copies.end());
    std::sort(features.begin(), features.end());
    features.erase(std::unique(features.begin(), features.end()), features.end());
  }

  /// Vertices without triangles go.
  void compact() {
    std::vector<VertexIndex> number(surface_.points.size(), kNone);
    mark_used(surface_.triangles, number);
    std::vector<VertexIndex> same = number;
    keep_numbered(made_.vertex_face, same);
    same = number, keep_numbered(made_.is_inner, same);
    keep_numbered(surface_.points, number);
    renumber(surface_.triangles, number);
    Features& features = made_.result.features;
    for (Edge& e : features.edges) e = {number[e[0]], number[e[1]]};
    std::erase_if(features.edges, [](const Edge& e) { return e[0] == kNone || e[1] == kNone; });
    std::sort(features.edges.begin(), features.edges.end());
    const auto keep = [&](std::vector<VertexIndex>& list) {
      for (VertexIndex& v : list) v = number[v];
      std::erase(list, kNone);
      std::sort(list.begin(), list.end());
    };
    keep(features.corners), keep(made_.result.near_limit);
  }

  const SurfaceMesh& input_;
  const PeriodicFaces& periods_;
  Outcome& made_;
  SurfaceMesh& surface_;
  std::vector<std::uint32_t> low_;  ///< triangles of faces at low ends
  std::map<std::uint32_t, Sides> sides_of_patch_;
  VerticesByPlace at_;
};

}  // namespace

SizeField periodic_sizes(const SizeField& sizes, const SurfaceMesh& input, const PeriodicFaces& periods,
                         const RunContext& context) {
  if (!periods.cell.is_periodic()) return sizes;
  SizeField now = sizes;
  for (int round = 0; round < kSizeRounds; ++round) {
    bool changed = false;
    for (int k = 0; k < periods.cell.periods(); ++k) {
      if (!periods.cell.has(k)) continue;
      const std::vector<PointSize> wanted = wanted_by_copies(now, input, periods, k);
      if (wanted.empty()) continue;
      now = capped_at(now, wanted, context, {.reach = 0.5});
      changed = true;
    }
    if (!changed) break;
  }
  return now;
}

void copy_periodic_faces(const SurfaceMesh& input, const PeriodicFaces& periods, Outcome& made) {
  if (periods.cell.is_periodic()) FaceCopier(input, periods, made).run();
}

}  // namespace octafront::surface
