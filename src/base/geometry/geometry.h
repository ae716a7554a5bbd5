#pragma once

// base/geometry: what is true of points, segments, triangles and tetrahedra alone. Exact predicates and exact
// intersection tests, on which every decision about topology rests; measures in plain floating point, which only ever
// choose between alternatives; a tree over triangles for nearest points, boxes and rays. Takes coordinates and index
// triples, leaves signs, numbers and ids; knows nothing of meshes as a whole.
