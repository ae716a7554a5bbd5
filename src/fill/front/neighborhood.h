#pragma once

#include "fill/front/front.h"

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
  /// Where a vertex lies about the tetrahedron on the base that is tried. Side i is opposite its corner i, side 3 the
  /// base itself. Bits: strictly outside side i (1 << i), outside side i < 3 by more than the margin (16 << i).
  using Code = std::uint8_t;
  static constexpr Code kOutside = 15, kClear = 240;

  /// Collects around `base`; faces that lie strictly behind its plane are left out, since no tetrahedron on it can
  /// reach them. `unit` is the wanted size. The corners of the base become vertices 0, 1, 2.
  /// Returns how many faces the region had.
  std::size_t gather(const Front& front, FaceIndex base, const SearchRegion& region, double unit);

  /// Codes of all vertices about the tetrahedron with its apex at a local place; `apex` is the vertex there, kNone if
  /// it is new. Its corners count as outside of the sides through them.
  void classify(Index apex, Vec3 apex_at, float margin);

  Index size() const { return size_; }
  VertexIndex vertex(Index i) const { return vertex_[i]; }
  Vec3 local(Index i) const { return {x_[i], y_[i], z_[i]}; }
  Vec3 to_local(Vec3 p) const { return (p - origin_) * per_unit_; }
  /// The corners of the base, local and in double precision.
  const std::array<Vec3, 3>& base() const { return base_; }
  const std::vector<LocalFace>& faces() const { return faces_; }
  Code code(Index i) const { return code_[i]; }

 private:
  class Listing;
  void drop_faces_behind_base();

  Vec3 origin_;
  double per_unit_ = 1;
  std::array<Vec3, 3> base_{};
  float error_ = 0;  ///< bound on that of a vertex's signed distance from a plane
  Index size_ = 0;   ///< of the arrays below, which may be longer
  std::vector<FrontIndex::Found> found_;
  std::vector<VertexIndex> vertex_;
  std::vector<float> x_, y_, z_;
  std::vector<Code> code_, base_code_;
  std::vector<LocalFace> faces_;
};

}  // namespace octafront
