#pragma once

#include <octafront/ids.h>

#include "soup/tidy/steps.h"

#include <cstdint>
#include <vector>

namespace octafront::mend {

/// A hole and the triangles over it.
struct Hole {
  std::vector<Triangle> cap;
  std::vector<Vec3> inner;             ///< points of the cap that are not on the rim, in the order of their vertices
  std::uint32_t rim_triangle = kNone;  ///< of the draft
  double area = 0;                     ///< of the cap before it was made smooth or set off
  bool has_base = false;               ///< the cap keeps off the surface, which a lid would graze
};

struct ClosedHoles {
  std::vector<Hole> holes;
  std::vector<char> is_sheet;  ///< per triangle of the draft
  bool is_one_sheet = false;   ///< all hangs together, and caps would be nearly as large as the rest
};

/// Caps for the holes of all parts that nearly enclose something, and none for sheets: parts whose caps would be too
/// large a share of themselves, or that would enclose a volume thinner than the tolerance. Where some parts are closed
/// already, open ones must be nearly so too, and fins (triangles_of_fins()) are sheets. Where the surface around a hole
/// bends, its cap goes on so; where a lid would graze the surface, walls and a flat base close the hole. The points
/// that this takes come behind those of the draft.
ClosedHoles close_holes(tidy::Draft& draft, double tolerance);

}  // namespace octafront::mend
