#pragma once

// sizing: which edge length is wanted where. Takes a clean surface, its features and the user's options; asks each
// source of size (curvature, gaps, feature curves, facets, regions, a callback), and leaves a SizeField on an octree:
// 2:1 balanced, continuous, graded by a law that holds between any two points, with a prediction of the number of
// elements.
//
//   sources (size_sources.h) -> samples of the surface -> octree, divided by them (background_grid.h)
//     -> corner values (gradation.h) -> OctreeField -> at(p), expected_tets()
