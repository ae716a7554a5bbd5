#pragma once

// fill/stuffing: the octree method. Takes a triangle surface, clean or not, and sizes; leaves a mesh whose inside is
// the graded body-centred cubic lattice and whose boundary is near the surface, not on its triangles (F. Labelle and
// J. R. Shewchuk, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral Angles", 2007).
//
//   stuffing_octree -> lattice_graph (sides, cut edges; implicit_domain says what is inside) -> cut_lattice (warp, cut)
//     -> manifold (no parts that touch in an edge or a point) -> snap_features (corners and curves) -> patches, regions
