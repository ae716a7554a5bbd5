#include "surface/remeshing/live_triangles.h"

#include "geometry/predicates.h"
#include "geometry/triangle_box.h"

#include <algorithm>

namespace octafront::remeshing {

namespace {
/// So many crossings are many.
constexpr int kMany = 100;
}  // namespace

bool LiveTriangles::is_degenerate(const TriangleCorners& t) {
  return collinear(t[0], t[1], t[2]);
}

int LiveTriangles::crossings(const IdTriangle& made, std::span<const std::uint32_t> old, int enough) {
  if (!tree_) plant_tree();
  const Box3 box = box_of(made.corners);
  int count = 0;
  const auto look = [&](std::uint32_t t) {
    if (mesh_.is_removed(t) || std::find(old.begin(), old.end(), t) != old.end()) return true;
    const TriangleCorners there = corners(t);
    if (box_of(there).overlaps(box) && !is_degenerate(there))
      count += triangles_conflict(made.corners, made.ids, there, mesh_.triangle(t));
    return count < enough;
  };
  const bool on = tree_->for_each_box_near(box, [&](std::uint32_t item, const TriangleCorners&) {
    return is_changed_[in_tree_[item]] || look(in_tree_[item]);
  });
  if (on) std::all_of(changed_.begin(), changed_.end(), look);
  return count;
}

int LiveTriangles::crossings_among(std::span<const std::uint32_t> triangles) {
  std::vector<IdTriangle> proper;
  for (const std::uint32_t t : triangles)
    if (!is_degenerate(corners(t))) proper.push_back({mesh_.triangle(t), corners(t)});
  return crossings_among(proper, triangles, kMany);
}

int LiveTriangles::crossings_among(std::span<const IdTriangle> made, std::span<const std::uint32_t> old, int enough) {
  int count = 0;
  for (std::size_t i = 0; i < made.size() && count < enough; ++i) {
    for (std::size_t j = 0; j < i; ++j)
      count += triangles_conflict(made[i].corners, made[i].ids, made[j].corners, made[j].ids);
    count += crossings(made[i], old, enough - count);
  }
  return count;
}

void LiveTriangles::note_changed(std::span<const std::uint32_t> triangles) {
  is_changed_.resize(mesh_.triangle_count(), 0);
  for (const std::uint32_t t : triangles) {
    if (!is_changed_[t]) changed_.push_back(t);
    is_changed_[t] = 1;
  }
  std::erase_if(changed_, [&](std::uint32_t t) { return mesh_.is_removed(t); });
}

void LiveTriangles::plant_tree() {
  in_tree_ = mesh_.alive_triangles();
  std::vector<Triangle> triangles;
  for (const std::uint32_t t : in_tree_) triangles.push_back(mesh_.triangle(t));
  tree_.emplace(mesh_.points, triangles);
}

}  // namespace octafront::remeshing
