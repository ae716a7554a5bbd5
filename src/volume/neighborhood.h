#pragma once

#include "volume/front.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront {

/// What lies around one face of the front, copied together: the faces that a new tetrahedron on it might touch, and
/// their vertices. Coordinates are relative to the face's centroid, in units of the wanted size there, in single
/// precision and coordinate by coordinate: good for culling with a stated error and for measures of quality. Decisions
/// go back to the vertices' own coordinates.
class Neighborhood {
 public:
  using Index = std::uint32_t;
  struct LocalFace {
    std::array<Index, 3> corner;
    FaceIndex face;
  };
  /// A plane n . x = d with |n| = 1, outward; d is infinite where the plane is too ill-conditioned to prove anything.
  struct Plane {
    float nx = 0, ny = 0, nz = 0, d = 0;
  };
  /// Bits of a vertex's code: strictly outside plane i (1 << i), outside by more than the margin (16 << i). Bit 3 is
  /// the plane of the base face, the corners of which count as outside.
  using Code = std::uint8_t;
  static constexpr Code kOutside = 15, kClear = 240;

  /// Collects around `base`; faces that lie strictly behind its plane are left out, since no tetrahedron on it can
  /// reach them. `unit` is the wanted size. The corners of the base become vertices 0, 1, 2.
  void gather(const Front& front, FaceIndex base, const SearchRegion& region, double unit);

  /// Codes of all vertices against three planes.
  void classify(const std::array<Plane, 3>& planes, float margin);

  Index size() const { return size_; }
  VertexIndex vertex(Index i) const { return vertex_[i]; }
  Vec3 local(Index i) const { return {x_[i], y_[i], z_[i]}; }
  Vec3 to_local(Vec3 p) const { return (p - origin_) * per_unit_; }
  const std::vector<LocalFace>& faces() const { return faces_; }
  Code& code(Index i) { return code_[i]; }
  Code code(Index i) const { return code_[i]; }
  /// Bound on the error of a vertex's signed distance from a plane.
  float error() const { return error_; }
  Vec3 origin() const { return origin_; }
  double unit() const { return unit_; }

  std::uint64_t faces_found = 0;  ///< over all calls

 private:
  class Listing;
  void drop_faces_behind(const Plane& base);

  Vec3 origin_;
  double unit_ = 1, per_unit_ = 1;
  float error_ = 0;
  Index size_ = 0;  ///< of the arrays below, which may be longer
  std::vector<FrontIndex::Found> found_;
  std::vector<VertexIndex> vertex_;
  std::vector<float> x_, y_, z_;
  std::vector<Code> code_, base_code_;
  std::vector<LocalFace> faces_;
};

/// The plane through three local points, its normal by the right-hand rule.
Neighborhood::Plane plane_through(Vec3 a, Vec3 b, Vec3 c);

}  // namespace octafront
