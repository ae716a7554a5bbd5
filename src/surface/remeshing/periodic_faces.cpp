#include "surface/remeshing/periodic_faces.h"

#include "base/geometry/measures.h"
#include "sizing/field/change_size_field.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace octafront::remeshing {

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

/// Sizes wanted at places of both faces of an axis, where the opposite ones are smaller.
std::vector<PointSize> wanted_by_copies(const SizeField& sizes, const SurfaceMesh& input, const PeriodicFaces& periods,
                                        int axis) {
  std::vector<PointSize> wanted;
  for (CellFace end = 0; end < 2; ++end) {
    const Box3& box = periods.cell.box;
    for (const Vec3 p : samples_of_face(input, periods, 2 * static_cast<CellFace>(axis) + end, sizes)) {
      Vec3 copy = p;
      copy[axis] = (end == 0 ? box.hi : box.lo)[axis];
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
    find_vertices();
    for (const std::uint32_t t : low_) copy(t);
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

  void find_vertices() {
    // Also those of dropped triangles alone: at lines between two faces that are copies they have features.
    for (VertexIndex v = 0; v < surface_.points.size(); ++v) at_.add(surface_.points[v], v);
  }

  int axis_of(std::uint32_t patch) {
    const auto [at, is_new] = axis_of_patch_.try_emplace(patch, -1);
    if (is_new)
      for (std::size_t t = 0; t < input_.triangles.size() && at->second < 0; ++t)
        if (input_.patch_of(t) == patch) at->second = static_cast<int>(periods_.face[t] / 2);
    return at->second;
  }

  VertexIndex copy_of_vertex(VertexIndex v, int axis) {
    Vec3 p = surface_.points[v];
    p[axis] = periods_.cell.box.hi[axis];
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
    const int axis = axis_of(patch);
    const Triangle own = surface_.triangles[t];
    Triangle copied{};
    for (int i = 0; i < 3; ++i) copied[i] = copy_of_vertex(own[i], axis);
    const Sides sides = sides_of_patch_.at(to), low = surface_.sides[t];
    // Both face outward, or both inward, but for parts of which one has the outside in front and one behind.
    if ((sides[0] == kNone) == (low[0] == kNone)) std::swap(copied[1], copied[2]);
    surface_.triangles.push_back(copied);
    surface_.patch.push_back(to);
    surface_.sides.push_back(sides);
  }

  /// Vertices without triangles go.
  void compact() {
    std::vector<VertexIndex> number(surface_.points.size(), kNone);
    for (const Triangle& t : surface_.triangles)
      for (const VertexIndex v : t) number[v] = 0;
    VertexIndex used = 0;
    for (VertexIndex v = 0; v < number.size(); ++v) {
      if (number[v] == kNone) continue;
      surface_.points[used] = surface_.points[v];
      made_.vertex_face[used] = made_.vertex_face[v];
      made_.is_inner[used] = made_.is_inner[v];
      number[v] = used++;
    }
    surface_.points.resize(used), made_.vertex_face.resize(used), made_.is_inner.resize(used);
    for (Triangle& t : surface_.triangles)
      for (VertexIndex& v : t) v = number[v];
    Features& features = made_.result.features;
    for (Edge& e : features.edges) e = {number[e[0]], number[e[1]]};
    std::erase_if(features.edges, [](const Edge& e) { return e[0] == kNone || e[1] == kNone; });
    std::sort(features.edges.begin(), features.edges.end());
    const auto renumber = [&](std::vector<VertexIndex>& list) {
      for (VertexIndex& v : list) v = number[v];
      std::erase(list, kNone);
      std::sort(list.begin(), list.end());
    };
    renumber(features.corners), renumber(made_.result.near_limit);
  }

  const SurfaceMesh& input_;
  const PeriodicFaces& periods_;
  Outcome& made_;
  SurfaceMesh& surface_;
  std::vector<std::uint32_t> low_;  ///< triangles of faces at low ends
  std::map<std::uint32_t, Sides> sides_of_patch_;
  std::map<std::uint32_t, int> axis_of_patch_;
  VerticesByPlace at_;
};

}  // namespace

SizeField periodic_sizes(const SizeField& sizes, const SurfaceMesh& input, const PeriodicFaces& periods,
                         const RunContext& context) {
  if (!periods.cell.is_periodic()) return sizes;
  SizeField now = sizes;
  for (int round = 0; round < kSizeRounds; ++round) {
    bool changed = false;
    for (int axis = 0; axis < 3; ++axis) {
      if (!periods.cell.along[axis]) continue;
      const std::vector<PointSize> wanted = wanted_by_copies(now, input, periods, axis);
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

}  // namespace octafront::remeshing
