#pragma once

#include "fill/front/excavation.h"

namespace octafront {

struct StarResult {
  bool closed = false;
  int growth_steps = 0;
  int points = 0;
};

/// Closes a cavity by one point that sees all its walls, found by linear programming. While the kernel is empty, the
/// cavity grows through the wall that the best point violates most, as long as that is not part of the surface. A
/// kernel that gives poor elements grows on for some steps; the best is kept. Without success nothing changes.
StarResult close_by_star(const OpenCavity& cavity);

}  // namespace octafront
