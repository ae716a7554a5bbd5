#include "base/geometry/tet_overlap.h"

#include <octafront/tet_mesh.h>

#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace octafront {
namespace {

/// Shewchuk's bound A of orient3d, whose expression height() is.
constexpr double kHeightBound = 7.7715611723761027e-16;

std::array<Vec3, 3> corners_of_face(const TetCorners& x, std::size_t face) {
  const auto corner = [&](std::size_t k) { return x[static_cast<std::size_t>(kTetFaces[face][k])]; };
  return {corner(0), corner(1), corner(2)};
}

Vec3 size_by_axis(Vec3 a) {
  return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}

/// Parts of a tetrahedron behind planes. A vertex is its heights over the planes of the faces, then, if N is not 4, its
/// place.
template <std::size_t N>
class TetClipper {
 public:
  using Vertex = std::array<double, N>;
  using Cell = std::array<Vertex, 4>;

  /// Behind all planes from `first` on; `share`: of the cell in the whole.
  void clip(const Cell& cell, double share, std::size_t first) {
    for (; first < 4; ++first) {
      bool is_before = false, is_behind = false;
      for (const Vertex& v : cell) is_before = is_before || v[first] > 0, is_behind = is_behind || v[first] < 0;
      if (!is_behind) return;
      if (is_before) return divide(cell, share, first);
    }
    add(cell, share);
  }

  TetOverlap sum;

 private:
  struct Cut {
    Vertex vertex;
    double part;  ///< of the edge that lies behind the plane
  };

  void add(const Cell& cell, double share) {
    sum.share += share;
    if constexpr (N > 4)
      for (const Vertex& v : cell) sum.moment += (0.25 * share) * Vec3{v[4], v[5], v[6]};
  }

  static Cut cut(const Vertex& in, const Vertex& out, std::size_t plane) {
    const double part = in[plane] / (in[plane] - out[plane]);
    Cut made{in, part};
    for (std::size_t i = 0; i < N; ++i) made.vertex[i] += part * (out[i] - in[i]);
    made.vertex[plane] = 0;
    return made;
  }

  void part(const Cell& cell, double share, std::size_t plane) {
    if (share > 0) clip(cell, share, plane + 1);
  }

  void divide(const Cell& cell, double share, std::size_t plane) {
    std::array<std::size_t, 4> in{}, out{};
    std::size_t ins = 0, outs = 0;
    for (std::size_t k = 0; k < 4; ++k) (cell[k][plane] <= 0 ? in[ins++] : out[outs++]) = k;
    const auto at = [&](std::size_t i, std::size_t o) { return cut(cell[in[i]], cell[out[o]], plane); };
    if (ins == 1) {
      const Cut a = at(0, 0), b = at(0, 1), c = at(0, 2);
      part({cell[in[0]], a.vertex, b.vertex, c.vertex}, share * (a.part * b.part * c.part), plane);
    } else if (ins == 2) {
      const Cut a = at(0, 0), b = at(0, 1), c = at(1, 0), d = at(1, 1);
      const Vertex &p = cell[in[0]], &q = cell[in[1]];
      part({p, a.vertex, b.vertex, q}, share * (a.part * b.part), plane);
      part({a.vertex, b.vertex, c.vertex, q}, share * (c.part * b.part * (1 - a.part)), plane);
      part({b.vertex, q, c.vertex, d.vertex}, share * (c.part * d.part * (1 - b.part)), plane);
    } else {
      const Cut a = at(0, 0), b = at(1, 0), c = at(2, 0);
      const Vertex &q = cell[in[1]], &r = cell[in[2]];
      part({cell[in[0]], q, r, a.vertex}, share * a.part, plane);
      part({q, r, a.vertex, b.vertex}, share * (b.part * (1 - a.part)), plane);
      part({r, a.vertex, b.vertex, c.vertex}, share * (c.part * (1 - a.part) * (1 - b.part)), plane);
    }
  }
};

/// How the corners of one lie to the planes of the other.
enum class Side { kInside, kDivided, kOutside };

template <std::size_t N>
Side heights_over(const TetPlanes& planes, const TetCorners& corners, std::array<std::array<double, N>, 4>& heights) {
  Side side = Side::kInside;
  for (std::size_t face = 0; face < 4; ++face) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (std::size_t k = 0; k < 4; ++k) {
      const double h = heights[k][face] = planes.height(face, corners[k]);
      lowest = std::min(lowest, h), highest = std::max(highest, h);
    }
    if (lowest >= 0) return Side::kOutside;
    if (highest > 0) side = Side::kDivided;
  }
  return side;
}

template <std::size_t N>
TetOverlap overlap_of(const TetPlanes& a, const TetCorners& corners_of_b) {
  const Vec3 origin = a.corners()[0];
  std::array<std::array<double, 4>, 4> of_b;
  const Side b_in_a = heights_over(a, corners_of_b, of_b);
  if (b_in_a == Side::kOutside) return {};
  const TetPlanes b(corners_of_b);
  typename TetClipper<N>::Cell cell{};
  const Side a_in_b = heights_over(b, a.corners(), cell);
  if (a_in_b == Side::kOutside) return {};
  if (a_in_b == Side::kInside) return {1, a.centre() - origin};
  if (b_in_a == Side::kInside) {
    const double share = std::min(1.0, b.volume() / a.volume());
    return {share, share * (b.centre() - origin)};
  }
  if constexpr (N > 4)
    for (std::size_t k = 0; k < 4; ++k)
      for (int axis = 0; axis < 3; ++axis)
        cell[k][static_cast<std::size_t>(4 + axis)] = a.corners()[k][axis] - origin[axis];
  TetClipper<N> clipper;
  clipper.clip(cell, 1, 0);
  return clipper.sum;
}

}  // namespace

TetPlanes::TetPlanes(const TetCorners& corners)
    : corners_(corners), volume_(signed_volume(corners[0], corners[1], corners[2], corners[3])) {
  for (std::size_t face = 0; face < 4; ++face) {
    const auto [a, b, c] = corners_of_face(corners, face);
    const Vec3 u = b - a, v = c - a, s = size_by_axis(u), t = size_by_axis(v);
    at_[face] = a;
    normal_[face] = cross(u, v);
    permanent_[face] = {s.y * t.z + s.z * t.y, s.z * t.x + s.x * t.z, s.x * t.y + s.y * t.x};
  }
}

double TetPlanes::height(std::size_t face, Vec3 p) const {
  const Vec3 w = p - at_[face];
  const double height = dot(normal_[face], w);
  if (std::abs(height) > kHeightBound * dot(permanent_[face], size_by_axis(w))) return height;
  return doubtful_height(face, p, height);
}

double TetPlanes::doubtful_height(std::size_t face, Vec3 p, double height) const {
  const auto [a, b, c] = corners_of_face(corners_, face);
  // What two meshes share is most of what is doubtful.
  if (p == a || p == b || p == c) return 0;
  const int sign = orient3d(a, b, c, p);
  return sign == 0 ? 0 : sign * std::max(std::abs(height), std::numeric_limits<double>::min());
}

bool TetPlanes::holds(Vec3 p) const {
  for (std::size_t face = 0; face < 4; ++face)
    if (height(face, p) > 0) return false;
  return true;
}

double shared_volume(const TetPlanes& a, const TetCorners& b) {
  return overlap_of<4>(a, b).share;
}

TetOverlap shared_moments(const TetPlanes& a, const TetCorners& b) {
  return overlap_of<8>(a, b);
}

}  // namespace octafront
