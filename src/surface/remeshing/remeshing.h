#pragma once

// surface/remeshing: a clean surface triangulated anew to the size field. Takes the repaired surface, its features and
// the sizes; leaves a surface whose vertices lie on the input, with the input's topology, features and patches. The
// steps, one file each: curves (chained, cleared of noise, divided), front (places points), insertion (puts them into
// the input triangulation), coarsen (collapses the input's own vertices away), improve, lengths and curve_points
// (flips, smoothing, mending, points that slide along curves), merge_lines and mend_folds (what is too narrow for an
// element, folded, or crosses), crossings and deviation (what makes remesh.cpp run another round with smaller sizes),
// restored (where the input's own triangles stay instead). Before all of it unfold takes folds off the input. A closed
// manifold exists at every moment, so no decision of the front can break the topology.

#include "surface/remeshing/remesh.h"
