#pragma once

// The best tetrahedra that fill a small polyhedron without a new vertex, by search.

#include "improve/shape/shape.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace octafront::improve {

/// Tetrahedra from the corners of a polyhedron that fill it and whose worst score is as large as a bounded search
/// finds. Each step covers the face of what is still open that has the fewest ways to be covered, best way first.
/// Positive tetrahedra whose faces cancel but for those of the polyhedron fill it exactly once, so no test of
/// intersection is needed. (The problem is that of J. Liu, S. Sun and D. Wang, "Optimal tetrahedralization for small
/// polyhedron", 2006.)
class PolyhedronSearch {
 public:
  using Corner = std::uint8_t;
  using Face = std::array<Corner, 3>;
  static constexpr int kMostCorners = 12, kMostFaces = 40;

  explicit PolyhedronSearch(ImproveOptions::Objective objective) : batch_(objective) {}

  /// `faces` as seen from outside, counter-clockwise, by their corners. True if tetrahedra were found that all score
  /// above `bound` and lie above the floor. REQUIRES: at most kMostCorners, kMostFaces.
  bool fill(std::span<const Vec3> corners, std::span<const Face> faces, const Floor& floor, float bound);

  struct Tet {
    std::array<Corner, 4> corners;  ///< positive
    Shape shape;
  };
  /// What fill() found.
  const std::vector<Tet>& tets() const { return best_; }
  float worst() const { return bound_; }

 private:
  static constexpr int kSteps = 100;  ///< 1,000 find no more on armadillo, femur and anchor, 30 a few less
  static constexpr int kFours = 495;  ///< sets of four out of twelve

  /// The faces still open. A face is three numbers of four bits, the least one first.
  struct Front {
    std::array<std::uint16_t, kMostFaces + 8> faces;
    int size = 0;

    bool erase(std::uint16_t face);
    bool has(std::uint16_t face) const;
  };

  void value_fours(std::span<const Vec3> corners, const Floor& floor);
  /// The score of (apex, face) if it is positive and usable, else 0; `four` is its place in shape_.
  float value(Corner apex, std::uint16_t face, int& four) const;
  bool cover(Front& front, std::uint16_t face, Corner apex) const;
  void search(const Front& front, float worst);

  int corner_count_ = 0, steps_ = 0;
  float bound_ = 0;
  bool found_ = false;
  ShapeBatch batch_;
  std::array<Shape, kFours> shape_;
  std::array<std::int8_t, kFours> sign_;  ///< of the four in ascending order; 0: not usable
  std::vector<Tet> stack_, best_;
};

}  // namespace octafront::improve
