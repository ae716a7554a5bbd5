#pragma once

#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <span>

namespace octafront {

/// Triangles so many times as long as high are needles: halving the longest edges of their parts leaves needles side by
/// side, whose number grows with the length to the power of 1.6. They are cut across.
inline constexpr double kNeedle = 16;

/// A triangle in slices across its longest edge, by parts of that edge's length.
class Needle {
 public:
  explicit Needle(const std::array<Vec3, 3>& t) : Needle(t, longest_edge(t)) {}

  bool is_one() const { return 2 * kNeedle * area_ < length_ * length_; }
  double length() const { return length_; }
  double height() const { return 2 * area_ / length_; }

  /// The middle of the cut at t.
  Vec3 middle(double t) const { return 0.5 * (on_edge(t) + beside(t)); }
  double area(double t0, double t1) const { return area_ * (part_below(t1) - part_below(t0)); }

  /// The convex hull of these is the slice from t0 to t1.
  struct Corners {
    std::array<Vec3, 5> all;
    std::size_t count = 4;
    std::span<const Vec3> span() const { return {all.data(), count}; }
  };
  Corners corners(double t0, double t1) const {
    Corners c{{on_edge(t0), on_edge(t1), beside(t0), beside(t1)}};
    if (t0 < widest_ && widest_ < t1) c.all[c.count++] = apex_;
    return c;
  }

 private:
  Needle(const std::array<Vec3, 3>& t, int i)
      : from_(t[i]),
        to_(t[(i + 1) % 3]),
        apex_(t[(i + 2) % 3]),
        length_(distance(from_, to_)),
        area_(triangle_area(from_, to_, apex_)),
        widest_(length_ > 0 ? std::clamp(dot(apex_ - from_, to_ - from_) / (length_ * length_), 0.0, 1.0) : 0) {}

  static int longest_edge(const std::array<Vec3, 3>& t) {
    int longest = 0;
    for (int i = 1; i < 3; ++i)
      if (squared_distance(t[i], t[(i + 1) % 3]) > squared_distance(t[longest], t[(longest + 1) % 3])) longest = i;
    return longest;
  }

  Vec3 on_edge(double t) const { return from_ + t * (to_ - from_); }
  /// Across from there, on the other two edges.
  Vec3 beside(double t) const {
    if (t < widest_) return from_ + (t / widest_) * (apex_ - from_);
    return widest_ < 1 ? to_ + ((1 - t) / (1 - widest_)) * (apex_ - to_) : apex_;
  }
  double part_below(double t) const {
    if (t < widest_) return t * t / widest_;
    return widest_ < 1 ? 1 - (1 - t) * (1 - t) / (1 - widest_) : 1;
  }

  Vec3 from_, to_, apex_;
  double length_, area_, widest_;  ///< widest_: where its height is
};

}  // namespace octafront
