
#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/spatial_order.h"
#include "surface/lines/line_sizes.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace octafront::surface {

namespace {

/// How far from its middle an equilateral triangle reaches, in edges.
constexpr double kReachOfTriangle = 0.577;
/// Corners of new triangles lie anywhere between the two planes, so what is between them is off by less: measured on
/// images of labels.
constexpr double kPlanesApart = 1.3;
/// How far the curve may be from a chord of it, in tolerances.
constexpr double kOffChord = 1;
/// The disc grows by this from look to look.
constexpr double kGrowth = 1.25;
/// Where normals cancel out to less than this part of the area the surface has turned.
constexpr double kFacing = 0.5;
/// What is flat so far needs no look at all of it: larger sizes are found by how far the surface deviates.
constexpr std::size_t kMostFaces = 600;
/// Sizes above this part of the wanted one are not worth a place.
constexpr double kWorthwhilePlace = 0.85;
/// A disc speaks for the faces within this part of its radius: theirs would be as large, but for that part.
constexpr double kSpeaksFor = 0.25;
/// Faces are looked at by blocks of so many, in spatial order; discs speak for faces of their own block.
constexpr std::size_t kBlock = 4096;

/// The faces of the input, as discs look at them again and again.
struct Faces {
  std::vector<Vec3> center, area;  ///< area: twice the area along the normal
  std::vector<double> twice_area;

  explicit Faces(const HalfEdgeMesh& m) : center(m.triangle_count()), area(center.size()), twice_area(center.size()) {
    parallel_for(center.size(), [&](std::size_t i) {
      const auto t = static_cast<std::uint32_t>(i);
      center[i] = (m.corner(t, 0) + m.corner(t, 1) + m.corner(t, 2)) / 3;
      area[i] = cross(m.corner(t, 1) - m.corner(t, 0), m.corner(t, 2) - m.corner(t, 0));
      twice_area[i] = length(area[i]);
    });
  }
};

/// Grows discs on the input.
class Disc {
 public:
  Disc(const InputSurface& input, const Faces& of)
      : input_(input), of_(of), seen_(input.mesh.triangle_count(), 0), seen_vertex_(input.mesh.points.size(), 0) {}

  /// The radius up to which the patch around the face stays between two planes so far apart, at most `most`.
  double flat_radius(std::uint32_t face, double most, double apart) {
    const double least = kReachOfTriangle * mean_edge(face);
    start(face);
    if (least >= most) return most;
    const Vec3 p = of_.center[face];
    double before = least, height_before = 0;
    Vec3 normal, middle;
    double weight = 0;
    std::size_t next = 0;
    for (double r = least;; r = std::min(r * kGrowth, most)) {
      grow(r);
      if (faces_.size() > kMostFaces) return most;
      for (; next < faces_.size(); ++next) {
        const std::uint32_t f = faces_[next];
        normal += of_.area[f];
        middle += (of_.center[f] - p) * of_.twice_area[f];
        weight += of_.twice_area[f];
      }
      if (length(normal) < kFacing * weight) return before;
      const double height = height_of(p + middle / weight, normal / length(normal), r);
      if (height > apart) return before + (r - before) * (apart - height_before) / (height - height_before);
      if (r >= most) return most;
      before = r;
      height_before = height;
    }
  }

  /// Calls visit(face) for the faces of the last disc within this radius, and within a part of the disc itself.
  template <class Visit>
  void for_each_within(double radius, double part, const Visit& visit) const {
    if (faces_.empty()) return;
    radius = std::min(radius, part * distance(of_.center[faces_.back()], middle_));
    for (const std::uint32_t f : faces_) {
      if (distance(of_.center[f], middle_) > radius) return;
      visit(f);
    }
  }

 private:
  double mean_edge(std::uint32_t t) const {
    const Vec3 a = input_.mesh.corner(t, 0), b = input_.mesh.corner(t, 1), c = input_.mesh.corner(t, 2);
    return (distance(a, b) + distance(b, c) + distance(c, a)) / 3;
  }

  void start(std::uint32_t face) {
    faces_.clear();
    points_.clear();
    rim_.assign(1, {0.0, face});
    middle_ = of_.center[face];
    seen_[face] = ++round_;
  }

  /// Takes in the faces of the patch within the radius, by their middles, nearest first.
  void grow(double radius) {
    const HalfEdgeMesh& m = input_.mesh;
    while (!rim_.empty() && rim_.front().first <= radius && faces_.size() <= kMostFaces) {
      std::pop_heap(rim_.begin(), rim_.end(), std::greater<>());
      const std::uint32_t face = rim_.back().second;
      rim_.pop_back();
      faces_.push_back(face);
      for (HalfEdge h = 3 * face; h < 3 * face + 3; ++h) {
        if (const VertexIndex v = m.start[h]; seen_vertex_[v] != round_) {
          seen_vertex_[v] = round_;
          points_.push_back(m.points[v]);
        }
        if (m.is_feature[h]) continue;
        const std::uint32_t across = m.twin[h] / 3;
        if (input_.is_back(across) || input_.patch[across] != input_.patch[face] || seen_[across] == round_) continue;
        seen_[across] = round_;
        rim_.push_back({distance(of_.center[across], middle_), across});
        std::push_heap(rim_.begin(), rim_.end(), std::greater<>());
      }
    }
  }

  /// How far the faces spread along the normal: their corners, those of large faces only as far as the disc reaches.
  double height_of(Vec3 origin, Vec3 normal, double radius) const {
    double low = 0, high = 0;
    for (const Vec3& p : points_) {
      const double away = distance(p, middle_);
      const Vec3 within = away > radius ? middle_ + (p - middle_) * (radius / away) : p;
      const double height = dot(within - origin, normal);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return high - low;
  }

  const InputSurface& input_;
  const Faces& of_;
  std::vector<std::uint32_t> seen_, seen_vertex_;  ///< per face and vertex: the round in which it was
  std::uint32_t round_ = 0;
  Vec3 middle_;
  std::vector<std::uint32_t> faces_;
  std::vector<Vec3> points_;                           ///< corners of the faces, each once
  std::vector<std::pair<double, std::uint32_t>> rim_;  ///< a heap: what is next to be taken in, by distance
};

/// Sizes for the edges along a curve.
class Chords {
 public:
  Chords(const HalfEdgeMesh& mesh, const Curve& curve) : closed_(curve.closed) {
    for (const HalfEdge h : curve.half_edges) points_.push_back(mesh.points[mesh.start[h]]);
    if (!closed_) points_.push_back(mesh.points[mesh.end(curve.half_edges.back())]);
  }

  std::size_t count() const { return points_.size(); }
  Vec3 point(std::size_t i) const { return points_[i]; }

  /// The length of the longest chord around the point, the same number of points to either side, from which what it
  /// cuts off is no farther than that; at most `most`, and no less than the edges beside the point.
  double straight_length(std::size_t i, double most, double apart) const {
    double before = 0;
    for (std::size_t k = 1; 2 * k < points_.size(); ++k) {
      if (!closed_ && (k > i || i + k >= points_.size())) break;
      const Vec3 a = at(i, -k), b = at(i, k);
      const double l = distance(a, b);
      if (k > 1 && (l < before || farthest(i, k, a, b) > apart)) return before;
      if (l >= most) return most;
      before = l;
    }
    return most;
  }

 private:
  Vec3 at(std::size_t i, std::ptrdiff_t by) const {
    const auto n = static_cast<std::ptrdiff_t>(points_.size());
    return points_[static_cast<std::size_t>((static_cast<std::ptrdiff_t>(i) + by + n) % n)];
  }
  double farthest(std::size_t i, std::size_t k, Vec3 a, Vec3 b) const {
    double most = 0;
    for (std::ptrdiff_t j = 1 - static_cast<std::ptrdiff_t>(k); j < static_cast<std::ptrdiff_t>(k); ++j)
      most = std::max(most, squared_distance(at(i, j), closest_point_on_segment(at(i, j), a, b)));
    return std::sqrt(most);
  }

  bool closed_;
  std::vector<Vec3> points_;
};

/// Discs that speak for all faces but those of backs.
std::vector<PointSize> sizes_of_faces(const InputSurface& input, const SizeField& sizes, double tolerance) {
  const Faces faces(input.mesh);
  const std::vector<std::uint32_t> order = spatial_order(faces.center);
  std::vector<std::uint32_t> block_of(order.size());
  parallel_for(order.size(), [&](std::size_t k) { block_of[order[k]] = static_cast<std::uint32_t>(k / kBlock); });
  std::vector<std::uint8_t> is_done(order.size(), 0);
  PerThread<Disc> discs;
  return parallel_collect<PointSize>(
      order.size(), kBlock, [&](std::size_t begin, std::size_t end, std::vector<PointSize>& places) {
        Disc& disc = discs.local([&] { return Disc(input, faces); });
        for (std::size_t k = begin; k < end; ++k) {
          const std::uint32_t face = order[k];
          if (is_done[face] || input.is_back(face)) continue;
          const Vec3 p = faces.center[face];
          const double wanted = sizes.at(p);
          const double radius = disc.flat_radius(face, kReachOfTriangle * wanted, kPlanesApart * tolerance);
          if (radius < kWorthwhilePlace * kReachOfTriangle * wanted) places.push_back({p, radius / kReachOfTriangle});
          disc.for_each_within(kSpeaksFor * radius, kSpeaksFor, [&](std::uint32_t f) {
            if (block_of[f] == k / kBlock) is_done[f] = 1;
          });
        }
      });
}

}  // namespace

std::vector<PointSize> sizes_by_flatness(const InputSurface& input, const std::vector<Curve>& curves,
                                         const SizeField& sizes, double tolerance, const RunContext& context) {
  std::vector<PointSize> places = sizes_of_faces(input, sizes, tolerance);
  context.check();
  for (const Curve& curve : curves) {
    const Chords chords(input.mesh, curve);
    for (std::size_t i = 0; i < chords.count(); ++i) {
      const double wanted = sizes.at(chords.point(i));
      const double size = chords.straight_length(i, wanted, kOffChord * tolerance);
      if (size < kWorthwhilePlace * wanted) places.push_back({chords.point(i), size});
    }
  }
  return smallest_ones(std::move(places));
}

}  // namespace octafront::surface
