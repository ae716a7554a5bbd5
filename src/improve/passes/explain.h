#pragma once

#include <octafront/run_context.h>

#include "improve/shape/edit_mesh.h"
#include "improve/shape/input_force.h"

#include <array>
#include <cstdint>

namespace octafront::improve {

/// Why elements stay poor. Where the boundary is the user's own, its triangles force them; where it is ours, only the
/// input does, see InputForce: our own triangles are ours to mend.
struct Shortfall {
  enum Cause { kWedge, kCorner, kThin, kKeptTriangle, kNotForced, kCauses };
  struct Class {
    std::uint64_t elements = 0;
    TetIndex worst = kNone;  ///< slot in the mesh
  };
  std::uint64_t elements = 0;                   ///< with a score below the threshold
  std::array<Class, kCauses> by_cause{};        ///< of these
  std::uint64_t poor = 0, poor_not_forced = 0;  ///< beta below .2, or a dihedral angle below 10 degrees
};

/// `force`: of what the boundary was made from; null if the boundary is as the user gave it. Throws Cancelled.
Shortfall explain_shortfall(EditMesh& mesh, float threshold, const InputForce* force, const RunContext& context);

}  // namespace octafront::improve
