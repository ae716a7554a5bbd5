#include "layers/bare_patches.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <vector>

namespace octafront::layers {

namespace {

/// Sweeps that spread what the rim does.
constexpr int kSpreads = 40;
/// Triangles keep this part of their area, be the rim where it is or at its tops; else their vertices go half as far.
constexpr double kLeastArea = 0.2;
constexpr int kMostHalvings = 6;

class Room {
 public:
  Room(const Walls& walls, const Columns& columns) : walls_(walls), by_(walls.surface.points.size()) {
    for (const VertexIndex v : walls.wall_vertices)
      if (columns.count[v] > 0) by_[v] = columns.top(walls.surface, v) - walls.surface.points[v];
    for (VertexIndex v = 0; v < by_.size(); ++v)
      if (is_free(v)) free_.push_back(v);
  }

  void spread() {
    std::vector<Vec3> next = by_;
    for (int sweep = 0; sweep < kSpreads; ++sweep) {
      parallel_for(free_.size(), [&](std::size_t i) { next[free_[i]] = mean_beside(free_[i]); });
      std::swap(by_, next);
      for (const VertexIndex v : free_) next[v] = by_[v];
    }
  }

  void hold_back() {
    for (int k = 0; k <= kMostHalvings; ++k) {
      std::vector<VertexIndex> back;
      for (const VertexIndex v : free_)
        if (std::ranges::any_of(walls_.faces[v], [&](std::uint32_t f) { return !has_room(f); })) back.push_back(v);
      for (const VertexIndex v : back) by_[v] = k < kMostHalvings ? 0.5 * by_[v] : Vec3{};
    }
  }

  void move(std::vector<Vec3>& points) const {
    for (const VertexIndex v : free_) points[v] += by_[v];
  }

 private:
  /// Inside a flat part of one patch without layers.
  bool is_free(VertexIndex v) const {
    const auto faces = walls_.faces[v];
    if (walls_.grows[v] || walls_.shared[v] || walls_.held[v] || faces.empty()) return false;
    return std::ranges::all_of(faces, [&](std::uint32_t f) {
      return walls_.surface.patch_of(f) == walls_.surface.patch_of(faces[0]) &&
             dot(walls_.inward[f], walls_.inward[faces[0]]) > kSamePlane;
    });
  }

  /// Each neighbour is in two triangles.
  Vec3 mean_beside(VertexIndex v) const {
    Vec3 sum;
    for (const std::uint32_t f : walls_.faces[v])
      for (const VertexIndex w : walls_.surface.triangles[f])
        if (w != v) sum += by_[w];
    return sum / (2.0 * static_cast<double>(walls_.faces[v].size()));
  }

  bool has_room(std::uint32_t f) const {
    const auto area = [&](const auto& place) {
      const auto [a, b, c] = walls_.surface.triangles[f];
      return -dot(walls_.inward[f], double_area_normal(place(a), place(b), place(c)));
    };
    const std::vector<Vec3>& points = walls_.surface.points;
    const double least = kLeastArea * area([&](VertexIndex v) { return points[v]; });
    return area([&](VertexIndex v) { return points[v] + by_[v]; }) > least &&
           area([&](VertexIndex v) { return walls_.grows[v] ? points[v] : points[v] + by_[v]; }) > least;
  }

  const Walls& walls_;
  std::vector<Vec3> by_;  ///< per vertex
  std::vector<VertexIndex> free_;
};

}  // namespace

void make_room_on_bare(const Walls& walls, const Columns& columns, RegionWall& wall) {
  if (walls.is_outside || walls.rims.empty()) return;
  Room room(walls, columns);
  room.spread();
  room.hold_back();
  room.move(wall.surface.points);
}

}  // namespace octafront::layers
