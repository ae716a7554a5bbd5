#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "sizing/field/change_size_field.h"
#include "surface/lines/line_sizes.h"

#include <algorithm>
#include <map>

namespace octafront::surface {

namespace {

/// How fast sizes rise around a corner: by more than elsewhere, for a tiny edge shall not cost thousands of elements.
constexpr double kSteepAroundCorners = 0.7;
/// No size falls below this part of what it was.
constexpr double kFloor = 1e-3;
/// Edges three times as long as the shortest one make fair triangles still (2r/R of .56): so much of the distance. (4
/// gives a foam of 200 cells a sixth fewer elements, and half as many more below .4; there are .1 % of these.)
constexpr double kSizePerRoom = 3;
/// Elements along a loop: so that patches on it, of which two may have nothing else around them, have a vertex inside,
/// and do not fall upon each other.
constexpr double kPerLoop = 6;
/// Where sizes would stay above this part nothing is gained.
constexpr double kWorthwhileAtCorner = 0.85;
/// Where curves part at less than 30 degrees they force poor elements; sizes do not follow them into their wedge, but
/// stop at this part of the edge that leads to it.
constexpr double kWedge = 0.5;

/// A corner: where curves end.
struct Corner {
  Vec3 p;
  std::vector<std::uint32_t> curves;  ///< that end here
  std::vector<VertexIndex> next;      ///< at whose other ends these places lie, curve by curve
};

class CornerFitter {
 public:
  CornerFitter(const InputSurface& input, const SeamedSurface& seamed, const SeamedCurves& chained,
               const SizeField& sizes, const LeastSizes& least)
      : mesh_(input.mesh), place_(seamed.place), curves_(chained.curves), sizes_(sizes), least_(least) {
    for (std::uint32_t c = 0; c < curves_.size(); ++c)
      if (chained.group[c] == c) add(c);
    tree_.emplace(mesh_.points, segments_);
  }

  std::vector<PointSize> run(const RunContext& context) {
    std::vector<Corner> corners;
    std::vector<VertexIndex> numbers;
    for (const auto& [number, corner] : corners_) {
      corners.push_back(corner);
      numbers.push_back(number);
    }
    std::vector<double> near(corners.size());
    parallel_for(corners.size(), [&](std::size_t i) {
      context.check();
      near[i] = room_at(numbers[i], corners[i]);
    });
    std::vector<PointSize> places = loops_;
    for (std::size_t i = 0; i < corners.size(); ++i) add_place(corners[i].p, near[i], places);
    return places;
  }

 private:
  VertexIndex first_place(const Curve& c) const { return place_[mesh_.start[c.half_edges.front()]]; }
  VertexIndex last_place(const Curve& c) const { return place_[mesh_.end(c.half_edges.back())]; }

  void add(std::uint32_t c) {
    const Curve& curve = curves_[c];
    for (const HalfEdge h : curve.half_edges) {
      segments_.push_back({mesh_.start[h], mesh_.end(h), mesh_.end(h)});
      curve_of_.push_back(c);
    }
    if (curve.closed || first_place(curve) == last_place(curve)) {
      const double third = curve.reach.back() / 3, size = curve.reach.back() / kPerLoop;
      for (const double part : {0.0, 1.0, 2.0}) {
        const auto at = std::lower_bound(curve.reach.begin(), curve.reach.end(), part * third) - curve.reach.begin();
        add_place(mesh_.points[mesh_.start[curve.half_edges[at]]], size / kSizePerRoom, loops_);
      }
    }
    if (curve.closed) return;
    const VertexIndex a = first_place(curve), b = last_place(curve);
    join(a, mesh_.points[mesh_.start[curve.half_edges.front()]], c, b);
    join(b, mesh_.points[mesh_.end(curve.half_edges.back())], c, a);
  }

  void join(VertexIndex at, Vec3 p, std::uint32_t curve, VertexIndex other) {
    Corner& corner = corners_[at];
    corner.p = p;
    corner.curves.push_back(curve);
    corner.next.push_back(other);
  }

  /// How far it is from the corner to what does not hang together with it, if that matters.
  double room_at(VertexIndex number, const Corner& corner) const {
    double room = sizes_.at(corner.p);
    for (std::size_t i = 0; i < corner.curves.size(); ++i)
      if (corner.next[i] != number) room = std::min(room, curves_[corner.curves[i]].reach.back());
    const Vec3 reach{room, room, room};
    tree_->for_each_box_near({corner.p - reach, corner.p + reach},
                             [&](std::uint32_t s, const TriangleCorners& segment) {
                               room = std::min(room, distance_to(curve_of_[s], segment, corner));
                               return true;
                             });
    return room;
  }

  double distance_to(std::uint32_t curve, const TriangleCorners& segment, const Corner& corner) const {
    if (std::find(corner.curves.begin(), corner.curves.end(), curve) != corner.curves.end()) return HUGE_VAL;
    const double d = distance(corner.p, closest_point_on_segment(corner.p, segment[0], segment[1]));
    double least = 0;
    for (const VertexIndex end : {first_place(curves_[curve]), last_place(curves_[curve])})
      if (std::find(corner.next.begin(), corner.next.end(), end) != corner.next.end())
        least = std::max(least, kWedge * distance(corner.p, corners_.at(end).p));
    return std::max(d, least);
  }

  void add_place(Vec3 p, double room, std::vector<PointSize>& places) const {
    const double size = sizes_.at(p), wanted = std::max({kSizePerRoom * room, kFloor * size, least_.at(p)});
    if (wanted < kWorthwhileAtCorner * size) places.push_back({p, wanted});
  }

  const HalfEdgeMesh& mesh_;
  const std::vector<VertexIndex>& place_;
  const std::vector<Curve>& curves_;
  const SizeField& sizes_;
  const LeastSizes& least_;
  std::map<VertexIndex, Corner> corners_;  ///< by their place in the complex
  std::vector<Triangle> segments_;         ///< of all curves, flat triangles for the tree
  std::vector<std::uint32_t> curve_of_;    ///< per segment
  std::optional<TriangleTree> tree_;
  std::vector<PointSize> loops_;
};

}  // namespace

SizeField fitted_to_corners(const InputSurface& input, const SeamedSurface& seamed, std::vector<std::uint8_t> is_fixed,
                            const SizeField& sizes, const LeastSizes& least, const RunContext& context) {
  const SeamedCurves chained = chained_curves(input, seamed, sizes, is_fixed);
  return capped_at(sizes, CornerFitter(input, seamed, chained, sizes, least).run(context), context,
                   {.gradation = kSteepAroundCorners});
}

}  // namespace octafront::surface
