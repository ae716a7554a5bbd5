#pragma once

#include "geometry/measures.h"
#include "geometry/predicates.h"
#include "geometry/triangle_box.h"
#include "geometry/triangle_tree.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace octafront {

/// A triangle that is to come, or one of a surface.
struct IdTriangle {
  Triangle ids;
  TriangleCorners corners;
};

/// Finds what a triangle crosses in a surface while that changes: a tree over the triangles as they were, made when it
/// is first needed, and a list of those that changed since. `Surface` numbers its triangles from 0 to triangle_count()
/// and says of each whether it is_removed(t), its vertices triangle(t), and where they are, corner(t, i).
template <class Surface>
class LiveTriangles {
 public:
  /// The surface must outlive this.
  explicit LiveTriangles(const Surface& surface) : surface_(surface), is_changed_(surface.triangle_count(), 0) {}

  TriangleCorners corners(std::uint32_t t) const {
    return {surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2)};
  }
  /// Without area: such a triangle meets all and none.
  static bool is_degenerate(const TriangleCorners& t) { return collinear(t[0], t[1], t[2]); }

  /// Whether p lies nearer than the distance to a triangle of the surface that is not one of `old`.
  bool is_within(Vec3 p, double distance, std::span<const std::uint32_t> old) {
    if (!tree_) plant_tree();
    const auto look = [&](std::uint32_t t) {  // false: found
      if (surface_.is_removed(t) || std::find(old.begin(), old.end(), t) != old.end()) return true;
      const TriangleCorners c = corners(t);
      return !(squared_distance(p, closest_point_on_triangle(p, c[0], c[1], c[2])) < distance * distance);
    };
    const Vec3 reach{distance, distance, distance};
    return !tree_->for_each_box_near({p - reach, p + reach}, [&](std::uint32_t item, const TriangleCorners&) {
      return is_changed_[in_tree_[item]] || look(in_tree_[item]);
    }) || !std::all_of(changed_.begin(), changed_.end(), look);
  }

  /// How many triangles of the surface, but those of `old`, meet this one where they should not, exactly; counts no
  /// further than to `enough`.
  int crossings(const IdTriangle& made, std::span<const std::uint32_t> old, int enough) {
    if (!tree_) plant_tree();
    const Box3 box = box_of(made.corners);
    int count = 0;
    const auto look = [&](std::uint32_t t) {
      if (surface_.is_removed(t) || std::find(old.begin(), old.end(), t) != old.end()) return true;
      const TriangleCorners there = corners(t);
      if (box_of(there).overlaps(box) && !is_degenerate(there))
        count += triangles_conflict(made.corners, made.ids, there, surface_.triangle(t));
      return count < enough;
    };
    const bool on = tree_->for_each_box_near(box, [&](std::uint32_t item, const TriangleCorners&) {
      return is_changed_[in_tree_[item]] || look(in_tree_[item]);
    });
    if (on) std::all_of(changed_.begin(), changed_.end(), look);
    return count;
  }

  /// Pairs of triangles that meet so, of which one at least is among these.
  int crossings_among(std::span<const std::uint32_t> triangles) {
    constexpr int kMany = 100;
    std::vector<IdTriangle> proper;
    for (const std::uint32_t t : triangles)
      if (!is_degenerate(corners(t))) proper.push_back({surface_.triangle(t), corners(t)});
    return crossings_among(proper, triangles, kMany);
  }
  /// The same for triangles that are to come in the place of `old`, about as far as to `enough`.
  int crossings_among(std::span<const IdTriangle> made, std::span<const std::uint32_t> old, int enough) {
    int count = 0;
    for (std::size_t i = 0; i < made.size() && count < enough; ++i) {
      for (std::size_t j = 0; j < i; ++j)
        count += triangles_conflict(made[i].corners, made[i].ids, made[j].corners, made[j].ids);
      count += crossings(made[i], old, enough - count);
    }
    return count;
  }

  /// To be called for what changed, appeared or vanished.
  void note_changed(std::span<const std::uint32_t> triangles) {
    is_changed_.resize(surface_.triangle_count(), 0);
    for (const std::uint32_t t : triangles) {
      if (!is_changed_[t]) changed_.push_back(t);
      is_changed_[t] = 1;
    }
    std::erase_if(changed_, [&](std::uint32_t t) { return surface_.is_removed(t); });
    if (changed_.size() > kMostChanged + in_tree_.size() / kPartChanged) plant_tree();
  }

 private:
  /// The list is searched one by one: when it is longer than this a new tree is due.
  static constexpr std::size_t kMostChanged = 1000, kPartChanged = 100;

  void plant_tree() {
    in_tree_.clear();
    changed_.clear();
    is_changed_.assign(surface_.triangle_count(), 0);
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    for (std::uint32_t t = 0; t < surface_.triangle_count(); ++t) {
      if (surface_.is_removed(t)) continue;
      in_tree_.push_back(t);
      const auto first = static_cast<VertexIndex>(points.size());
      triangles.push_back({first, first + 1, first + 2});
      for (const Vec3 p : corners(t)) points.push_back(p);
    }
    tree_.emplace(points, triangles);
  }

  const Surface& surface_;
  std::optional<TriangleTree> tree_;      ///< of the surface as it was
  std::vector<std::uint32_t> in_tree_;    ///< its triangles
  std::vector<std::uint8_t> is_changed_;  ///< per triangle: no longer the one in the tree
  std::vector<std::uint32_t> changed_;    ///< and not removed
};

}  // namespace octafront
