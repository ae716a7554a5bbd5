#pragma once

#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"

namespace octafront {

/// Adds points inside a valid mesh until its elements are as small as wanted; the boundary stays as it is. An element
/// whose circumscribed sphere is too large for the size there gets the centre of that sphere, with the Delaunay cavity
/// around it as far as the boundary and the orientation of new elements allow; new elements are worked off too. A
/// centre that the boundary hides, or that comes too near to a vertex or to a boundary face, is moved towards its
/// element, and given up after some moves. Delaunay refinement (J. Ruppert 1995; J. R. Shewchuk 1998) with the spacing
/// taken from the size field and a boundary that is never divided.
///
/// It ends: no point comes nearer to another than a part of the size there, so there is room for finitely many. Points
/// are appended to mesh.points, `region` is dropped. Counters of `report`: points added, elements left too large. About
/// 10 us per element made.
void refine_interior(TetMesh& mesh, const SizeField& sizes, const Stage& stage);

}  // namespace octafront
