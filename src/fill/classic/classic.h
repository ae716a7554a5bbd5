#pragma once

// fill/classic: the advancing front as it was before the octree, for comparison and as a method of its own. Takes a
// clean surface; sizes come from the surface's own edges, searches from alternating digital trees, and a new
// tetrahedron must pass all tests of the classical method. Leaves a mesh on exactly that surface, closed by the same
// steps as the other front.
//
//   surface_sizes, classic_front (alternating_tree) -> classic_attempt, smallest face first -> front/ladder
