#include "base/geometry/hausdorff.h"

#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <vector>

namespace octafront {

namespace {

struct Sample {
  Vec3 at;
  double distance;
  std::uint32_t triangle;  // the nearest one
};

using Piece = std::array<Sample, 3>;

double longest_edge(const Piece& p) {
  return std::sqrt(longest_squared_edge(p[0].at, p[1].at, p[2].at));
}

double distance_to(const TriangleCorners& t, Vec3 p) {
  return distance(p, closest_point_on_triangle(p, t[0], t[1], t[2]));
}

// `near`: a triangle that may be near, which makes the search short and changes no result; kNone: none is known.
Sample vertex_sample(const TriangleTree& to, Vec3 p, std::uint32_t near) {
  double limit = TriangleTree::kFar;
  if (near != kNone) {
    const auto& [a, b, c] = to.corners(near);
    limit = std::nextafter(squared_distance(p, closest_point_on_triangle(p, a, b, c)), limit);
  }
  auto nearest = to.nearest(p, limit);
  // Boxes may be farther by rounding than what is in them.
  if (nearest.triangle == kNone) nearest = to.nearest(p);
  return {p, std::sqrt(nearest.squared_distance), nearest.triangle};
}

// Divides one input triangle after the other. Knows the greatest distance met so far, so that pieces which cannot
// exceed it by more than the tolerance are left whole.
class Division {
 public:
  Division(const TriangleTree& to, double tolerance, const HausdorffBounds& start)
      : bounds(start), to_(to), tolerance_(tolerance) {
    bounds.samples = 0;
  }

  HausdorffBounds bounds;

  // The upper bound of a piece that has to be divided; 0 of others.
  double look_at(const Piece& piece) {
    double upper = upper_bound(piece);
    // Corners may have chosen triangles around the one that runs along with this piece.
    if (upper > bounds.lower + tolerance_) upper = std::min(upper, farthest_corner(piece, middle_sample(piece)));
    if (upper > bounds.lower + tolerance_ && longest_edge(piece) > tolerance_) return upper;
    bounds.upper = std::max(bounds.upper, upper);
    return 0;
  }

  // `upper`: of look_at().
  void add(const Piece& whole, double upper) {
    if (upper <= bounds.lower + tolerance_) {
      bounds.upper = std::max(bounds.upper, upper);
      return;
    }
    divide(whole);
    while (!stack_.empty()) {
      const Piece piece = stack_.back();
      stack_.pop_back();
      if (look_at(piece) > 0) divide(piece);
    }
  }

 private:
  // The nearest triangle of a point near by bounds the search.
  Sample sample(Vec3 p, const Sample& near) {
    ++bounds.samples;
    const double known = distance_to(to_.corners(near.triangle), p);
    const auto nearest = to_.nearest(p, known * known);
    const bool nearer = nearest.triangle != kNone;
    const Sample s{p, nearer ? std::sqrt(nearest.squared_distance) : known, nearer ? nearest.triangle : near.triangle};
    if (s.distance > bounds.lower) {
      bounds.lower = s.distance;
      bounds.place = p;
    }
    return s;
  }

  Sample middle_sample(const Piece& piece) { return sample(centroid(piece[0].at, piece[1].at, piece[2].at), piece[0]); }

  // The distance to the nearest triangle of one sample is convex: on the piece it is greatest at a corner.
  double farthest_corner(const Piece& piece, const Sample& s) const {
    double farthest = 0;
    for (const Sample& corner : piece) farthest = std::max(farthest, distance_to(to_.corners(s.triangle), corner.at));
    return farthest;
  }

  // Or something above it that changes nothing any more.
  double upper_bound(const Piece& piece) const {
    const double enough = std::min(bounds.upper, bounds.lower + tolerance_);
    double upper = TriangleTree::kFar;
    for (const Sample& s : piece) {
      double reach = 0;
      for (const Sample& other : piece) reach = std::max(reach, distance(s.at, other.at));
      // The distance to all triangles grows by at most 1 per unit of length.
      upper = std::min(upper, s.distance + reach);
    }
    for (std::size_t i = 0; i < 3 && upper > enough; ++i) upper = std::min(upper, farthest_corner(piece, piece[i]));
    return upper;
  }

  void divide(const Piece& piece) {
    const auto& [a, b, c] = piece;
    const Sample ab = sample((a.at + b.at) * 0.5, a), bc = sample((b.at + c.at) * 0.5, b);
    const Sample ca = sample((c.at + a.at) * 0.5, c);
    for (const Piece& part : {Piece{a, ab, ca}, Piece{ab, b, bc}, Piece{ca, bc, c}, Piece{ab, bc, ca}})
      stack_.push_back(part);
  }

  const TriangleTree& to_;
  double tolerance_;
  std::vector<Piece> stack_;
};

// Fixed blocks, so that the result does not depend on the number of threads.
constexpr std::size_t kBlock = 512;

template <class Work>
void for_each_block(std::size_t n, Work&& work) {
  parallel_for((n + kBlock - 1) / kBlock,
               [&](std::size_t block) { work(block, block * kBlock, std::min(n, (block + 1) * kBlock)); });
}

}  // namespace

HausdorffBounds one_sided_hausdorff(const SurfaceMesh& from, const TriangleTree& to, double tolerance) {
  HausdorffBounds result;
  if (from.triangles.empty() || to.empty()) {
    result.upper = from.triangles.empty() ? 0 : TriangleTree::kFar;
    result.lower = result.upper;
    return result;
  }
  std::vector<Sample> vertices(from.points.size());
  for_each_block(vertices.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      vertices[v] = vertex_sample(to, from.points[v], v == begin ? kNone : vertices[v - 1].triangle);
  });
  for (const Triangle& t : from.triangles)
    for (const VertexIndex v : t)
      if (vertices[v].distance > result.lower) result.lower = vertices[v].distance, result.place = vertices[v].at;
  const auto piece = [&](std::size_t t) {
    const auto& [a, b, c] = from.triangles[t];
    return Piece{vertices[a], vertices[b], vertices[c]};
  };
  result.samples = vertices.size();
  // All are looked at before any is divided: the greatest distance met in their middles spares most of that.
  std::vector<double> upper(from.triangles.size());
  for (const bool divides : {false, true}) {
    std::vector<HausdorffBounds> parts((from.triangles.size() + kBlock - 1) / kBlock);
    for_each_block(from.triangles.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      Division division(to, tolerance, result);
      for (std::size_t t = begin; t < end; ++t) {
        if (!divides)
          upper[t] = division.look_at(piece(t));
        else if (upper[t] > 0)
          division.add(piece(t), upper[t]);
      }
      parts[block] = division.bounds;
    });
    for (const HausdorffBounds& part : parts) {
      result.samples += part.samples;
      result.upper = std::max(result.upper, part.upper);
      if (part.lower > result.lower) result.lower = part.lower, result.place = part.place;
    }
  }
  return result;
}

HausdorffBounds hausdorff_distance(const SurfaceMesh& a, const SurfaceMesh& b, double tolerance) {
  const HausdorffBounds there = one_sided_hausdorff(a, TriangleTree(b), tolerance);
  const HausdorffBounds back = one_sided_hausdorff(b, TriangleTree(a), tolerance);
  HausdorffBounds both = there.lower >= back.lower ? there : back;
  both.upper = std::max(there.upper, back.upper);
  both.samples = there.samples + back.samples;
  return both;
}

}  // namespace octafront
