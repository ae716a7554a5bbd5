#pragma once

// What of the input itself keeps elements poor, at their own scale.

#include "improve/shape/boundary_input.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace octafront::improve {

class InputForce {
 public:
  /// The input must outlive this.
  explicit InputForce(const BoundaryInput& input);

  enum class Cause {
    kNone,    ///< nothing of the input: the mesh could be better there
    kWedge,   ///< two parts of the surface, each larger than the element, meet at less than 20 degrees inside
    kCorner,  ///< two feature curves leave a corner at less than 20 degrees, and are not far apart yet
    kThin,    ///< two sheets, or two curves of a complex, lie nearer to each other than a tenth of the element
  };
  /// Why elements of size h (input units) around `center` may have to be poor. Rays and directions are sampled.
  Cause cause_at(Vec3 center, double h) const;
  /// The same of one element, looked at more closely: sheets at its corners and edges, and lines side by side also
  /// where they could merge, as around a hole much narrower than it.
  Cause cause_of(const std::array<Vec3, 4>& element) const;

 private:
  struct Wall {
    double thickness = HUGE_VAL;
    double distance = 0;  ///< from the centre
  };
  Wall wall_at(Vec3 p, Vec3 center, double h) const;
  bool has_narrow_corner(Vec3 center, double h) const;
  Cause between_near_curves(Vec3 center, double h) const;
  bool share_an_end(std::uint32_t curve, std::uint32_t other) const;
  Vec3 direction_at_scale(VertexIndex from, VertexIndex to, double h) const;

  const BoundaryInput& input_;
  const bool is_complex_;
  std::vector<Edge> lines_;                              ///< both directions of every feature edge, sorted
  std::vector<std::pair<double, VertexIndex>> corners_;  ///< corners of the input by their x
  /// Its feature edges, and the curve that each belongs to. In a complex lines that are near cannot merge.
  std::optional<TriangleTree> segments_;
  std::vector<std::uint32_t> curve_;
  std::vector<std::array<VertexIndex, 2>> ends_;  ///< of each curve, by its number; kNone
};

}  // namespace octafront::improve
