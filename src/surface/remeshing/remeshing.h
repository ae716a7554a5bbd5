#pragma once

// surface/remeshing: a clean surface triangulated anew to the size field. Takes the repaired surface, its features and
// the sizes; leaves a surface whose vertices lie on the input, with the input's topology, features and patches. It is
// the order of the wing's steps: lines (curves, divided), front (places points, puts them into the input
// triangulation), edits (the input's own vertices collapse away), shaping, folds; and rounds of them with smaller sizes
// where the surface crosses itself or strays, until its own triangles stay (ground/kept_places).
