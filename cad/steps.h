#pragma once

#include "part.h"

namespace octafront::cad {

/// Shapes that are small against what the library tells apart are scaled, and part.per_millimetre with them.
void scale_up(Part& part);
/// Solids in which the library's check finds fault are healed; taken back where that changes volume or drops a face.
void heal(Part& part);
/// Faces that are more than half of a sphere, of solids that pass through themselves, become the other part of it where
/// that ends the crossing: where a border runs through a pole the library may take the wrong one.
void take_other_parts(Part& part);
/// Solids that are inside out are turned.
void turn_outward(Part& part);
/// Where there is no solid: faces are sewn along edges that nearly coincide, and what is closed becomes solids.
void sew(Part& part);
/// Solids that touch come to share faces, and space that several share goes where Arguments::overlap says, or, of a
/// layer as thin as a fit or Arguments::tolerance, to the later one. Throws Refusal where
/// that is nowhere, or where nothing is left of a solid; where it cannot be done well, they stay as they are, and
/// part.fused says so.
void fuse(Part& part, const Arguments& asked);

}  // namespace octafront::cad
