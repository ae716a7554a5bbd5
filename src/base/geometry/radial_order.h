#pragma once

#include <octafront/vec.h>

namespace octafront {

/// Sorts points by the turn around an edge, exactly: counter-clockwise as one sees it that looks along the edge from
/// its first point to its second, beginning with `first`. REQUIRES points that are not on the line of the edge.
class RadialOrder {
 public:
  RadialOrder(Vec3 from, Vec3 to, Vec3 first);

  /// Whether p comes before q.
  bool operator()(Vec3 p, Vec3 q) const;

 private:
  int half(Vec3 p) const;

  Vec3 a_, b_, first_, off_plane_;
  int up_ = 0;
};

}  // namespace octafront
