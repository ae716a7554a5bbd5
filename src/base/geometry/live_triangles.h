#pragma once

#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/triangle_box.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace octafront {

/// A triangle that is to come, or one of a surface.
struct IdTriangle {
  Triangle ids;
  TriangleCorners corners;
};

/// Finds what a triangle crosses in a surface while that changes: a tree over the triangles as they were, made when it
/// is first needed, smaller and smaller trees over those that changed since, and a short list of the latest. `Surface`
/// numbers its triangles from 0 to triangle_count() and says of each whether it is_removed(t), its vertices
/// triangle(t), and where they are, corner(t, i).
template <class Surface>
class LiveTriangles {
 public:
  /// The surface must outlive this.
  explicit LiveTriangles(const Surface& surface) : surface_(surface) {}

  TriangleCorners corners(std::uint32_t t) const {
    return {surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2)};
  }
  /// Without area: such a triangle meets all and none.
  static bool is_degenerate(const TriangleCorners& t) { return collinear(t[0], t[1], t[2]); }

  /// Whether p lies nearer than the distance to a triangle of the surface that is not one of `old`.
  bool is_within(Vec3 p, double distance, std::span<const std::uint32_t> old) {
    const Vec3 reach{distance, distance, distance};
    return !for_each_near({p - reach, p + reach}, [&](std::uint32_t t) {  // false: found
      if (std::find(old.begin(), old.end(), t) != old.end()) return true;
      const TriangleCorners c = corners(t);
      return !(squared_distance(p, closest_point_on_triangle(p, c[0], c[1], c[2])) < distance * distance);
    });
  }

  /// How many triangles of the surface, but those of `old`, meet this one where they should not, exactly; counts no
  /// further than to `enough`.
  int crossings(const IdTriangle& made, std::span<const std::uint32_t> old, int enough) {
    const Box3 box = box_of(made.corners);
    int count = 0;
    for_each_near(box, [&](std::uint32_t t) {
      if (std::find(old.begin(), old.end(), t) != old.end()) return true;
      const TriangleCorners there = corners(t);
      if (box_of(there).overlaps(box) && !is_degenerate(there))
        count += triangles_conflict(made.corners, made.ids, there, surface_.triangle(t));
      return count < enough;
    });
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
    if (layers_.empty()) return;  // the first one takes them as they are
    layer_of_.resize(surface_.triangle_count(), kOutside);
    for (const std::uint32_t t : triangles) {
      if (layer_of_[t] != kLatest) latest_.push_back(t);
      layer_of_[t] = kLatest;
    }
    if (latest_.size() > kMostLatest) settle();
  }

 private:
  /// The list is searched one by one: when it is longer than this it becomes a tree.
  static constexpr std::size_t kMostLatest = 64;
  /// In no tree: of the list, or not known yet.
  static constexpr std::uint8_t kLatest = 255, kOutside = 254;

  /// Triangles as they were when it was made. One that changed later counts where layer_of_ says.
  struct Layer {
    std::vector<std::uint32_t> triangles;
    TriangleTree tree;
  };

  /// Calls visit(t) for all triangles that may meet the box until one says false; returns false if one did.
  template <class Visit>
  bool for_each_near(const Box3& box, const Visit& visit) {
    if (layers_.empty()) plant_first();
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      const bool on = layers_[l].tree.for_each_box_near(box, [&](std::uint32_t item, const TriangleCorners&) {
        const std::uint32_t t = layers_[l].triangles[item];
        return layer_of_[t] != l || surface_.is_removed(t) || visit(t);
      });
      if (!on) return false;
    }
    return std::all_of(latest_.begin(), latest_.end(),
                       [&](std::uint32_t t) { return surface_.is_removed(t) || visit(t); });
  }

  void plant_first() {
    layer_of_.assign(surface_.triangle_count(), kOutside);
    std::vector<std::uint32_t> all;
    for (std::uint32_t t = 0; t < surface_.triangle_count(); ++t)
      if (!surface_.is_removed(t)) all.push_back(t);
    add_layer(std::move(all));
  }

  /// Makes the list a tree, with those trees that are no larger: so each is at least twice the next, and there are few.
  void settle() {
    std::vector<std::uint32_t> all = std::move(latest_);
    latest_.clear();
    while (!layers_.empty() && layers_.back().triangles.size() <= 2 * all.size()) {
      const std::size_t last = layers_.size() - 1;
      for (const std::uint32_t t : layers_[last].triangles)
        if (layer_of_[t] == last) all.push_back(t);
      layers_.pop_back();
    }
    std::erase_if(all, [&](std::uint32_t t) {
      if (surface_.is_removed(t)) layer_of_[t] = kOutside;
      return surface_.is_removed(t);
    });
    add_layer(std::move(all));
  }

  void add_layer(std::vector<std::uint32_t> all) {
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    for (const std::uint32_t t : all) {
      layer_of_[t] = static_cast<std::uint8_t>(layers_.size());
      const auto first = static_cast<VertexIndex>(points.size());
      triangles.push_back({first, first + 1, first + 2});
      for (const Vec3 p : corners(t)) points.push_back(p);
    }
    layers_.push_back({std::move(all), TriangleTree(points, triangles)});
  }

  const Surface& surface_;
  std::vector<Layer> layers_;           ///< the first one is of the whole surface
  std::vector<std::uint8_t> layer_of_;  ///< per triangle: where it is as it is now
  std::vector<std::uint32_t> latest_;   ///< what is in no layer
};

}  // namespace octafront
